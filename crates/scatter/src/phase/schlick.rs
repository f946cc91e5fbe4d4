//! Schlick's approximation of Henyey-Greenstein (Blasi, Le Saec & Schlick 1993, eq. 8):
//! `p = (1 - k^2) / (4 pi (1 - k cos theta)^2)` \[1/sr\]; `k = 1.55 g - 0.55 g^3` imitates `g`.
//!
//! Mean cosine `(k - (1 - k^2) atanh k) / k^2`.

use super::deflection::Deflection;
use crate::error::{ScatterError, require_curve};
use std::f32::consts::FRAC_1_PI;
use tyndall_base::math::f64::atanh;
use tyndall_spectral::curve::Curve;
use tyndall_spectral::{Spectrum, Wavelengths};

/// One lobe with `k(lambda)`.
#[derive(Clone, Debug, PartialEq)]
pub struct Schlick {
    k: Curve,
}

impl Schlick {
    /// `k` in (-1, 1), without unit.
    pub fn new(k: Curve) -> Result<Self, ScatterError> {
        let ok = |k: f32| k > -1.0 && k < 1.0;
        require_curve(&k, "parameter k of Schlick's phase function", "-1 < k < 1", ok)?;
        Ok(Self { k })
    }

    /// The parameter as a function of wavelength.
    pub fn k(&self) -> &Curve {
        &self.k
    }

    /// `p` \[1/sr\] per lane at `v = 1 - cos theta`.
    #[inline(always)]
    pub fn eval<const N: usize>(&self, versine: f32, lambda: &Wavelengths<N>) -> Spectrum<N> {
        self.k.sample(lambda).map(|k| {
            let from_peak = if k < 0.0 { 2.0 - versine } else { versine };
            let d = (1.0 - k.abs()) + k.abs() * from_peak;
            0.25 * FRAC_1_PI * (1.0 - k * k) / (d * d)
        })
    }

    /// Draws the angle at `lambda` \[nm\].
    #[inline(always)]
    pub fn sample(&self, u: f32, lambda: f32) -> Deflection {
        let k = self.k.eval(lambda);
        Deflection::from_versine(2.0 * (1.0 - k) * (1.0 - u) / (1.0 - k + 2.0 * k * u))
    }

    /// `<cos theta>` at `lambda` \[nm\].
    pub fn mean_cosine(&self, lambda: f32) -> f32 {
        let k = f64::from(self.k.eval(lambda));
        if k.abs() < 0.01 {
            // series of the closed form, which cancels here: next term 2 k^5 / 35
            return (2.0 * k / 3.0 + 2.0 * k * k * k / 15.0) as f32;
        }
        ((k - (1.0 - k * k) * atanh(k)) / (k * k)) as f32
    }
}
