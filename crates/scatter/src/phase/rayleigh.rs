//! Rayleigh scattering by molecules, with depolarisation:
//! `p = 3 ((1 + 3 gamma) + (1 - gamma) cos^2 theta) / (16 pi (1 + 2 gamma))` \[1/sr\], `gamma = rho / (2 - rho)`,
//! `rho(lambda)` the depolarisation ratio of natural light (about 0.028 for air). `rho = 0` is `3 (1 + cos^2) / 16 pi`.
//! Sources: Chandrasekhar 1950, chapter I eq. 255 ff.; Bucholtz 1995, eq. 12.

use super::deflection::Deflection;
use crate::error::{ScatterError, require_curve};
use std::f32::consts::FRAC_1_PI;
use tyndall_base::math::pow;
use tyndall_spectral::curve::Curve;
use tyndall_spectral::{Spectrum, Wavelengths};

/// The greatest depolarisation ratio of natural light that a polarisability tensor allows.
const MAX_DEPOLARISATION: f32 = 6.0 / 7.0;

/// Rayleigh's phase function with a depolarisation ratio as a function of wavelength.
#[derive(Clone, Debug, PartialEq)]
pub struct Rayleigh {
    depolarisation: Curve,
}

/// The cube root of `y > 0`: single precision, then one step of Newton's method.
#[inline(always)]
fn cube_root(y: f64) -> f64 {
    let t = f64::from(pow(y as f32, 1.0 / 3.0));
    (2.0 * t + y / (t * t)) * (1.0 / 3.0)
}

impl Rayleigh {
    /// Without depolarisation.
    pub const IDEAL: Self = Self { depolarisation: Curve::ZERO };

    /// `rho` in \[0, 6/7\], without unit.
    pub fn new(depolarisation: Curve) -> Result<Self, ScatterError> {
        let ok = |rho: f32| (0.0..=MAX_DEPOLARISATION).contains(&rho);
        require_curve(&depolarisation, "depolarisation ratio of Rayleigh scattering", "0 <= rho <= 6/7", ok)?;
        Ok(Self { depolarisation })
    }

    /// The depolarisation ratio as a function of wavelength.
    pub fn depolarisation(&self) -> &Curve {
        &self.depolarisation
    }

    /// `p` \[1/sr\] per lane at `v = 1 - cos theta`.
    #[inline(always)]
    pub fn eval<const N: usize>(&self, versine: f32, lambda: &Wavelengths<N>) -> Spectrum<N> {
        let cos2 = (1.0 - versine) * (1.0 - versine);
        self.depolarisation.sample(lambda).map(|rho| {
            let gamma = rho / (2.0 - rho);
            let lobe = (1.0 + 3.0 * gamma) + (1.0 - gamma) * cos2;
            3.0 / 16.0 * FRAC_1_PI * lobe / (1.0 + 2.0 * gamma)
        })
    }

    /// Draws the angle at `lambda` \[nm\]: the root of the cubic `cos^3 + 3 a cos = (1 + 3 a)(2 u - 1)` with
    /// `a = (1 + 3 gamma) / (1 - gamma)`, by Cardano's formula; `a > 0` leaves one real root.
    #[inline]
    pub fn sample(&self, u: f32, lambda: f32) -> Deflection {
        let rho = f64::from(self.depolarisation.eval(lambda));
        let gamma = rho / (2.0 - rho);
        let a = (1.0 + 3.0 * gamma) / (1.0 - gamma);
        let q = (1.0 + 3.0 * a) * (f64::from(u) - 0.5);
        // of the two cube roots, whose product is -a, take the one without cancellation
        let t = cube_root(q.abs() + (q * q + a * a * a).sqrt());
        let cos = (t - a / t).copysign(q);
        Deflection::from_versine((1.0 - cos) as f32)
    }

    /// Zero: as much goes back as forward.
    pub fn mean_cosine(&self) -> f32 {
        0.0
    }
}
