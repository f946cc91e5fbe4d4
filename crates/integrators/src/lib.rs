//! Integrators: from a camera ray to radiance at the path's wavelengths.
//!
//! `volpath` is the path tracer; `analog` the independent judge. Both serve [`pixel::PixelPass`], which turns units of
//! work into patches of the film.

pub mod analog;
pub mod direct;
pub mod equiangular;
pub mod glow;
pub mod isa;
pub mod layers;
pub mod medium;
pub mod observer;
pub mod pixel;
pub mod settings;
pub mod shadow;
pub mod tracking;
pub mod volpath;
pub mod weight;

pub use settings::{Equiangular, Settings};
pub use weight::PathWeight;
