//! Henyey & Greenstein 1941: `p = (1 - g^2) / (4 pi (1 + g^2 - 2 g cos theta)^(3/2))` \[1/sr\], mean cosine `g(lambda)`.
//!
//! With `v = 1 - cos theta` the bracket is `(1 - g)^2 + 2 g v = (1 + g)^2 - 2 g (2 - v)`; the textbook's inversion
//! `cos theta = (1 + g^2 - ((1 - g^2) / (1 - g + 2 g u))^2) / 2 g` factors into
//! `v = 2 (1 - g)^2 (1 - u) (1 + g u) / (1 - g + 2 g u)^2`, which holds at `g = 0` and loses nothing near forward.

use super::deflection::Deflection;
use crate::error::{ScatterError, require_curve};
use std::f32::consts::FRAC_1_PI;
use tyndall_spectral::curve::Curve;
use tyndall_spectral::{Spectrum, Wavelengths};

/// One lobe with `g` as a function of wavelength.
#[derive(Clone, Debug, PartialEq)]
pub struct HenyeyGreenstein {
    g: Curve,
}

/// `p` \[1/sr\] at `v = 1 - cos theta`.
#[inline(always)]
pub(crate) fn p(g: f32, versine: f32) -> f32 {
    // measured from the peak, both terms are positive: nothing cancels
    let from_peak = if g < 0.0 { 2.0 - versine } else { versine };
    let width = 1.0 - g.abs();
    let d = width * width + 2.0 * g.abs() * from_peak;
    0.25 * FRAC_1_PI * (1.0 - g * g) / (d * d.sqrt())
}

/// The deflection below which a fraction `1 - u` of the light goes (`u = 1` is forward).
#[inline(always)]
pub(crate) fn sample(g: f32, u: f32) -> Deflection {
    let d = 1.0 - g + 2.0 * g * u;
    let (front, back) = ((1.0 - u) * (1.0 + g * u), u * (1.0 - g * (1.0 - u)));
    let r = (1.0 - g) / d;
    let sine = 2.0 * (1.0 + g) * r / d * (front * back).max(0.0).sqrt();
    Deflection { versine: (2.0 * r * r * front).min(2.0), sine }
}

/// Refuses anything but -1 < g < 1.
pub(super) fn require_asymmetry(g: &Curve, what: &'static str) -> Result<(), ScatterError> {
    require_curve(g, what, "-1 < g < 1", |g| g > -1.0 && g < 1.0)
}

impl HenyeyGreenstein {
    /// `g` in (-1, 1), without unit.
    pub fn new(g: Curve) -> Result<Self, ScatterError> {
        require_asymmetry(&g, "asymmetry g of the Henyey-Greenstein phase function")?;
        Ok(Self { g })
    }

    /// The asymmetry as a function of wavelength.
    pub fn g(&self) -> &Curve {
        &self.g
    }

    /// `p` \[1/sr\] per lane at `v = 1 - cos theta`.
    #[inline(always)]
    pub fn eval<const N: usize>(&self, versine: f32, lambda: &Wavelengths<N>) -> Spectrum<N> {
        self.g.sample(lambda).map(|g| p(g, versine))
    }

    /// Draws the angle at `lambda` \[nm\].
    #[inline(always)]
    pub fn sample(&self, u: f32, lambda: f32) -> Deflection {
        sample(self.g.eval(lambda), u)
    }

    /// `<cos theta> = g`.
    pub fn mean_cosine(&self, lambda: f32) -> f32 {
        self.g.eval(lambda)
    }
}
