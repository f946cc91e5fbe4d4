//! Integrators: from a camera ray to radiance at the path's wavelengths.
//!
//! `volpath` is the path tracer; `analog` the independent judge; `wang_chern` the algorithm of the paper that this
//! program grows out of. All serve [`pixel::PixelPass`], which turns units of
//! work into patches of the film.

pub mod analog;
pub mod connect;
pub mod direct;
pub mod ember;
pub mod equiangular;
pub mod glow;
pub mod isa;
pub mod layers;
pub mod learn;
pub mod medium;
pub mod observer;
pub mod opaw;
mod pilot;
pub mod pixel;
pub mod refine;
pub mod reuse;
pub mod settings;
pub mod shadow;
pub mod steer;
pub mod swc;
mod sweep;
pub mod tracking;
pub mod volpath;
pub mod wang_chern;
pub mod weight;

pub use settings::{Equiangular, Guiding, Settings};
pub use weight::PathWeight;
