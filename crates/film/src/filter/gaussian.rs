//! Gaussian filter, lowered to reach zero at its radius.

use std::sync::Arc;

use tyndall_base::math::f64 as math;

use super::axis::Table;
use super::{Axis, PixelFilter, positive, radii};
use crate::FilmError;

impl PixelFilter {
    /// `f(x) = exp(-x^2 / (2 sigma^2)) - exp(-radius^2 / (2 sigma^2))` \[pixels\]; pbrt's defaults are radius 1.5 and
    /// sigma 0.5.
    pub fn gaussian(radius: [f32; 2], sigma: f32) -> Result<Self, FilmError> {
        radii("gaussian", radius)?;
        positive("gaussian", "sigma", sigma)?;
        let axis = |r: f32| Axis::Table(Arc::new(Table::new(r, lowered(f64::from(r), f64::from(sigma)))));
        Ok(Self { name: "gaussian", x: axis(radius[0]), y: axis(radius[1]) })
    }
}

fn lowered(radius: f64, sigma: f64) -> impl Fn(f64) -> f64 {
    let bell = move |x: f64| math::exp(-x * x / (2.0 * sigma * sigma));
    move |x| (bell(x) - bell(radius)).max(0.0)
}
