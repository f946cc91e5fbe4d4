//! What may be written beside the colour of a pixel.

use clap::ValueEnum;

/// A quantity that may be written beside the colour of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, ValueEnum)]
#[non_exhaustive]
pub enum Aov {
    /// Distance to the first surface in m
    Depth,
    /// Shading normal of the first surface
    Normal,
    /// Albedo of the first surface
    Albedo,
    /// Transmittance of the media up to the first surface
    Transmittance,
    /// Distance to the first scattering in m
    FirstScatter,
}
