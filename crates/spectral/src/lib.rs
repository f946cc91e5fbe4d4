//! Spectra, wavelengths, strategies that sample them, colour.
#![forbid(unsafe_code)]

pub mod spectrum;
pub mod wavelengths;

pub use spectrum::Spectrum;
pub use wavelengths::Wavelengths;
