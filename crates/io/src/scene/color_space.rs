//! Names of colour spaces.

use std::sync::Arc;
use tyndall_pbrt::{Error, ErrorKind, Place, Text};
use tyndall_spectral::colour::{ColourSpace, SpaceName};

/// The name of a space that [`canonical`] gave; sRGB is pbrt's default.
pub fn name(name: &str) -> SpaceName {
    name.parse().unwrap_or(SpaceName::Srgb)
}

/// The space of a name that [`canonical`] gave.
pub fn find(space: &str) -> &'static ColourSpace {
    ColourSpace::get(name(space))
}

/// pbrt's name of the colour space, or an error that lists them.
pub fn canonical(name: &Text, place: &Place) -> Result<Arc<str>, Error> {
    if let Ok(space) = name.as_str().parse::<SpaceName>() {
        return Ok(space.name().into());
    }
    let all = SpaceName::ALL.map(SpaceName::name).join(", ");
    let message = format!("ColorSpace: expected one of {all}, got \"{}\"", name.as_str());
    Err(Error::new(ErrorKind::Other(message), place.clone()))
}
