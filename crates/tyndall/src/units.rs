//! Units of results, written into every file.

use tyndall_io::Units;

/// The label of results in pbrt's normalisation, which have no absolute unit.
pub const NORMALISED: &str = "pbrt-normalised";
/// The unit of spectral radiance.
pub const ABSOLUTE: &str = "W m^-2 sr^-1 nm^-1";
/// The unit of R, G and B: spectral radiance integrated with response curves over nm.
pub const INTEGRATED: &str = "W m^-2 sr^-1";

/// The unit of a scene's results.
pub fn of(units: &Units) -> &'static str {
    if units.absolute && !units.normalised { ABSOLUTE } else { NORMALISED }
}

/// The unit of the film's channels.
pub fn channel_unit(units: &Units) -> &'static str {
    of(units)
}
