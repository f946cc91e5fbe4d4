//! Tyndall as a library: load a scene, render it, write the result.
//!
//! ```
//! use tyndall::{Image, Options, Provenance, RunOptions, Source, engine::Silent, plan, render};
//!
//! # fn main() -> Result<(), tyndall::Error> {
//! let options = Options { resolution: Some([4, 4]), spp: Some(1), ..Options::default() };
//! let plan = plan(Source::BuiltIn, &options)?;
//! let outcome = render(&plan, &RunOptions::default(), &mut Silent)?;
//! let image = Image::of_film(&outcome.state.film, &Provenance::of(&plan)?)?;
//! assert!(image.values.rgb().is_some());
//! # Ok(())
//! # }
//! ```
#![forbid(unsafe_code)]

pub mod camera_matrices;
pub mod cube;
pub mod denoise;
pub mod diff;
pub mod error;
pub mod existing;
pub mod false_colour;
pub mod image;
pub mod info;
pub mod memory;
pub mod options;
pub mod page;
pub mod paper;
pub mod picture;
pub mod plan;
pub mod plot;
pub mod provenance;
pub mod record;
pub mod render;
pub mod statistics;
mod strategy;
pub mod table;
pub mod trace;
pub mod units;
pub mod validate;

pub use error::Error;
pub use image::Image;
pub use options::{Options, Spectral, WavelengthPdf};
pub use picture::{Look, Picture, picture};
pub use plan::{Plan, Source, load, plan};
pub use provenance::Provenance;
pub use record::Record;
pub use render::{RunOptions, render};
pub use trace::{Trace, trace};

pub use tyndall_base as base;
pub use tyndall_engine as engine;
pub use tyndall_files as files;
pub use tyndall_film as film;
pub use tyndall_geometry as geometry;
pub use tyndall_integrators as integrators;
pub use tyndall_io as io;
pub use tyndall_pbrt as pbrt;
pub use tyndall_scatter as scatter;
pub use tyndall_spectral as spectral;
pub use tyndall_transport as transport;
