//! Spectra, wavelengths, strategies that sample them, colour.
#![forbid(unsafe_code)]

pub mod cie;
pub mod colour;
pub mod curve;
pub mod emission;
pub mod error;
pub mod illuminant;
pub mod media_presets;
pub mod named;
pub mod range;
pub mod spectrum;
pub mod strategy;
mod table;
pub mod upsample;
pub mod wavelengths;

pub use colour::{ColourSpace, SpaceName};
pub use curve::Curve;
pub use emission::{Emission, Line};
pub use error::SpectralError;
pub use range::{LambdaRange, Outside, RangeGap};
pub use spectrum::Spectrum;
pub use strategy::WavelengthSampler;
pub use wavelengths::Wavelengths;
