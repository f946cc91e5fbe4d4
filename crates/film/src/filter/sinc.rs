//! Sinc filter under Lanczos' window.

use std::f64::consts::PI;
use std::sync::Arc;

use tyndall_base::math::f64 as math;

use super::axis::Table;
use super::{Axis, PixelFilter, positive, radii};
use crate::FilmError;

impl PixelFilter {
    /// `f(x) = sinc(x) sinc(x / tau)` for |x| <= radius \[pixels\], `sinc(x) = sin(pi x) / (pi x)`; pbrt's defaults are
    /// radius 4 and tau 3.
    pub fn sinc(radius: [f32; 2], tau: f32) -> Result<Self, FilmError> {
        radii("sinc", radius)?;
        positive("sinc", "tau", tau)?;
        let tau = f64::from(tau);
        let axis = |r: f32| Axis::Table(Arc::new(Table::new(r, |x| sinc(x) * sinc(x / tau))));
        Ok(Self { name: "sinc", x: axis(radius[0]), y: axis(radius[1]) })
    }
}

fn sinc(x: f64) -> f64 {
    let t = PI * x;
    if t.abs() < 1e-8 { 1.0 } else { math::sin(t) / t }
}
