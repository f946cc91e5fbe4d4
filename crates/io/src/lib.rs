//! Readers: pbrt-v4 scenes into a renderable scene.
#![forbid(unsafe_code)]

pub mod scene;

pub use scene::{
    FilmDescription, IntegratorDescription, LoadOptions, LoadedScene, Units, load_file, load_text,
};
