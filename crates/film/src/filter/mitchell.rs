//! Mitchell & Netravali, *Reconstruction filters in computer graphics*, 1988: piecewise cubic with negative lobes.

use std::sync::Arc;

use super::axis::Table;
use super::{Axis, PixelFilter, finite, radii};
use crate::FilmError;

impl PixelFilter {
    /// The cubic of parameters `b` and `c`, stretched to the radius \[pixels\]; pbrt's defaults are radius 2 and b = c =
    /// 1/3.
    pub fn mitchell(radius: [f32; 2], b: f32, c: f32) -> Result<Self, FilmError> {
        radii("mitchell", radius)?;
        finite("mitchell", "B", b)?;
        finite("mitchell", "C", c)?;
        let cubic = |r: f32| move |x: f64| mitchell(2.0 * x / f64::from(r), f64::from(b), f64::from(c));
        let axis = |r: f32| Axis::Table(Arc::new(Table::new(r, cubic(r))));
        Ok(Self { name: "mitchell", x: axis(radius[0]), y: axis(radius[1]) })
    }
}

/// The paper's eq. 8 for 0 <= x <= 2.
fn mitchell(x: f64, b: f64, c: f64) -> f64 {
    let cubic = |k: [f64; 4]| (((k[0] * x + k[1]) * x + k[2]) * x + k[3]) / 6.0;
    if x <= 1.0 {
        cubic([12.0 - 9.0 * b - 6.0 * c, -18.0 + 12.0 * b + 6.0 * c, 0.0, 6.0 - 2.0 * b])
    } else if x <= 2.0 {
        cubic([-b - 6.0 * c, 6.0 * b + 30.0 * c, -12.0 * b - 48.0 * c, 8.0 * b + 24.0 * c])
    } else {
        0.0
    }
}
