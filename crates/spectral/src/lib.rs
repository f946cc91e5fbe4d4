//! Spectra, wavelengths, strategies that sample them, colour.
//!
//! A quantity that depends on wavelength is a [`Curve`]; what a light emits is an [`Emission`], a curve and lines. A path
//! carries [`Wavelengths`] drawn by a [`WavelengthSampler`], and a curve's values there are a [`Spectrum`].
//!
//! # What a reader of pbrt-v4 scenes needs to know
//!
//! - Inline spectra and those from files are straight lines between points and zero outside them ([`Outside::Zero`]);
//!   named spectra ([`named::named_spectrum`]) are held at their ends.
//! - Standard illuminants are scaled to Y = 1: their integral with ybar is [`cie::CIE_Y_INTEGRAL`].
//! - A blackbody is scaled to 1 at its maximum by Wien's law ([`Curve::blackbody`]).
//! - RGB becomes an albedo, an unbounded or an illuminant spectrum ([`upsample`]); an RGB illuminant is a scaled sigmoid
//!   times the colour space's white (Y = 1).
//! - Every light's spectrum is divided by its integral with ybar ([`cie::y_integral`]); for an RGB illuminant, by that of the
//!   white alone.
//! - The film's Y (and X, Z) is the plain integral of radiance with ybar, without 683 or `CIE_Y_INTEGRAL`: a normalised
//!   light of scale 1 seen directly has Y = 1. The spectral film multiplies its bands by `CIE_Y_INTEGRAL` to undo the
//!   normalisation.
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
