//! Box filter: every sample within the radius counts the same.

use super::{Axis, PixelFilter, radii};
use crate::FilmError;

impl PixelFilter {
    /// `f(x) = 1` for |x| <= radius \[pixels\]; pbrt's default radius is 0.5.
    pub fn boxed(radius: [f32; 2]) -> Result<Self, FilmError> {
        radii("box", radius)?;
        Ok(Self { name: "box", x: Axis::Box(radius[0]), y: Axis::Box(radius[1]) })
    }
}
