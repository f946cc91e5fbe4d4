//! Triangle (tent) filter.

use super::{Axis, PixelFilter, radii};
use crate::FilmError;

impl PixelFilter {
    /// `f(x) = 1 - |x| / radius` \[pixels\]; pbrt's default radius is 2.
    pub fn triangle(radius: [f32; 2]) -> Result<Self, FilmError> {
        radii("triangle", radius)?;
        Ok(Self { name: "triangle", x: Axis::Triangle(radius[0]), y: Axis::Triangle(radius[1]) })
    }
}
