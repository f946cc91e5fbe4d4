//! Pixel filters, sampled: a camera sample's offset from the pixel's centre is drawn in proportion to |f|.
//!
//! Every sample then belongs to one pixel only (Ernst, Stamminger, Greiner, *Filter importance sampling*, 2006), and its
//! weight is the sign of f: 1, or -1 on a negative lobe. All filters are separable; names, parameters and defaults are
//! pbrt-v4's.

mod axis;
mod boxes;
mod gaussian;
mod mitchell;
mod sinc;
mod triangle;

use axis::Axis;

use crate::{FilmError, Weights};

/// An offset from the centre of a pixel and the weight of the sample there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilterSample {
    /// Offset \[pixels\].
    pub offset: [f32; 2],
    /// 1 or -1.
    pub weight: f32,
}

/// A separable pixel filter.
#[derive(Clone, Debug)]
pub struct PixelFilter {
    name: &'static str,
    x: Axis,
    y: Axis,
}

impl PixelFilter {
    /// Draws an offset from a point of the unit square.
    #[inline]
    pub fn sample(&self, u: [f32; 2]) -> FilterSample {
        let (dx, wx) = self.x.sample(u[0]);
        let (dy, wy) = self.y.sample(u[1]);
        FilterSample { offset: [dx, dy], weight: wx * wy }
    }

    /// The filter at an offset, normalised to integrate to 1 over the plane.
    pub fn eval(&self, offset: [f32; 2]) -> f32 {
        self.x.eval(offset[0]) * self.y.eval(offset[1])
    }

    /// pbrt's name of the filter.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// Half the extent along x and y \[pixels\].
    pub fn radius(&self) -> [f32; 2] {
        [self.x.radius(), self.y.radius()]
    }

    /// The weights that samples carry.
    pub fn weights(&self) -> Weights {
        if self.x.is_signed() || self.y.is_signed() { Weights::Signed } else { Weights::Unit }
    }
}

/// pbrt's default filter: the Gaussian.
impl Default for PixelFilter {
    fn default() -> Self {
        Self::gaussian([1.5, 1.5], 0.5).expect("the default parameters are valid")
    }
}

fn positive(filter: &'static str, parameter: &'static str, got: f32) -> Result<(), FilmError> {
    if got > 0.0 && got <= 64.0 {
        return Ok(());
    }
    Err(FilmError::Filter { filter, parameter, expected: "a number > 0 and <= 64", got })
}

fn finite(filter: &'static str, parameter: &'static str, got: f32) -> Result<(), FilmError> {
    if got.abs() <= 10.0 {
        return Ok(());
    }
    Err(FilmError::Filter { filter, parameter, expected: "a number between -10 and 10", got })
}

fn radii(filter: &'static str, radius: [f32; 2]) -> Result<(), FilmError> {
    positive(filter, "xradius", radius[0])?;
    positive(filter, "yradius", radius[1])
}

#[cfg(test)]
mod tests;
