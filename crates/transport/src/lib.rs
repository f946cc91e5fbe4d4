//! The scene as light sees it: media, lights, cameras, textures, materials, and the sampler that a path draws from.
//!
//! All directions point away from the point they belong to; all lengths are metres, all wavelengths nm.
#![forbid(unsafe_code)]

pub mod camera;
pub mod error;
pub mod guiding;
pub mod ids;
pub mod light;
pub mod material;
pub mod media;
pub mod noise;
pub mod sampler;
pub mod scene;
pub mod texture;
pub mod touching;

pub use error::TransportError;
pub use ids::{LightId, MaterialId, MediumId};
pub use scene::{Interaction, Scene, ShapeBinding};
