//! Scattering models: phase functions of media and BSDFs of surfaces.
//!
//! All directions are unit vectors that point away from the point of scattering. Whatever depends on the wavelength has
//! one value per lane of [`Spectrum`](tyndall_spectral::Spectrum), and every density has one value per lane too: what it
//! would have been if that lane were the hero. Spectral multiple importance sampling needs exactly that.

pub mod bsdf;
pub mod error;
pub mod phase;

pub use bsdf::{Bsdf, BsdfFlags, BsdfSample, TransportMode};
pub use error::ScatterError;
pub use phase::{Mixture, PhaseFunction, PhaseSample};

#[cfg(test)]
mod robust_tests;
#[cfg(test)]
mod sphere_tests;
