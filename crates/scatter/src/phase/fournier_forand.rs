//! Fournier & Forand 1994 in the form of Fournier & Jonasz 1999: particles of index `n` with a power-law (Junge) size
//! distribution of slope `mu`, the phase function of sea water.
//!
//! With `s = sin^2(theta / 2)`, `delta = 4 s / (3 (n - 1)^2)`, `nu = (3 - mu) / 2`:
//! `p = (nu (1 - delta) - (1 - delta^nu) + (delta (1 - delta^nu) - nu (1 - delta)) / s) / (4 pi (1 - delta)^2 delta^nu)
//!  + (1 - delta_pi^nu) (3 cos^2 theta - 1) / (16 pi (delta_pi - 1) delta_pi^nu)` \[1/sr\].
//! `p` grows without bound towards `theta = 0`; inside a cone of 1 mrad its mean over the cone stands instead, so that
//! the norm stays 1. The size parameter has dropped out of the model, and with it the wavelength: for a phase function
//! that depends on wavelength use [`Tabulated`](super::Tabulated) or a mixture.

use super::deflection::Deflection;
use super::invert::invert_increasing;
use crate::error::{ScatterError, require};
use std::f64::consts::PI;
use std::sync::Arc;
use tyndall_base::math::f64::{exp, exp_m1, ln};

/// `1 - cos` of 1 mrad.
const CORE: f64 = 5e-7;
/// Points of the table that brackets the inversion, logarithmic in `1 - cos theta`.
const BRACKETS: usize = 128;

/// The phase function of sea water.
#[derive(Clone, Debug, PartialEq)]
pub struct FournierForand {
    n: f64,
    mu: f64,
    /// `(1 - cos theta, fraction of light within theta)`
    brackets: Arc<[(f64, f64)]>,
    /// `(1 - delta_pi^nu) / ((delta_pi - 1) delta_pi^nu)`
    backward: f64,
    mean_cosine: f32,
}

impl FournierForand {
    /// Index `n` of the particles relative to the water (1 < n <= 1.5) and Junge slope `mu` (3 < mu < 5).
    pub fn new(n: f32, mu: f32) -> Result<Self, ScatterError> {
        let (n, mu) = (f64::from(n), f64::from(mu));
        require(n > 1.0 && n <= 1.5, "relative index n of Fournier-Forand", "1 < n <= 1.5", n)?;
        require(mu > 3.0 && mu < 5.0, "Junge slope mu of Fournier-Forand", "3 < mu < 5", mu)?;
        let step = ln(2.0 / CORE) / (BRACKETS - 1) as f64;
        let knot = |i: usize| if i + 1 == BRACKETS { 2.0 } else { CORE * exp(step * i as f64) };
        let mut model = Self { n, mu, brackets: Arc::from([]), backward: 0.0, mean_cosine: 0.0 };
        let (d_nu, a, _) = model.quotients(model.delta(2.0));
        model.backward = -a / d_nu;
        model.brackets = (0..BRACKETS).map(knot).map(|v| (v, model.cdf_and_density(v).0)).collect();
        model.mean_cosine = model.integrate_cosine() as f32;
        Ok(model)
    }

    /// `[n, mu]`.
    pub fn parameters(&self) -> [f64; 2] {
        [self.n, self.mu]
    }

    fn delta(&self, versine: f64) -> f64 {
        2.0 * versine / (3.0 * (self.n - 1.0) * (self.n - 1.0))
    }

    fn nu(&self) -> f64 {
        0.5 * (3.0 - self.mu)
    }

    /// `delta^nu` and the quotients `a = (1 - delta^nu) / (1 - delta)`, `b = (nu - a) / (1 - delta)`, 0/0 at `delta = 1`.
    fn quotients(&self, delta: f64) -> (f64, f64, f64) {
        let (nu, e) = (self.nu(), delta - 1.0);
        if e.abs() < 1e-3 {
            // binomial series of (1 + e)^nu
            let c2 = 0.5 * (nu - 1.0);
            let c3 = c2 * (nu - 2.0) / 3.0;
            let c4 = c3 * (nu - 3.0) / 4.0;
            let b = nu * (c2 + e * (c3 + e * c4));
            let a = nu + e * b;
            return (1.0 + e * a, a, b);
        }
        let d_nu_m1 = exp_m1(nu * ln(delta));
        let a = d_nu_m1 / e;
        (1.0 + d_nu_m1, a, (a - nu) / e)
    }

    /// Fraction of the light within the angle (Fournier & Jonasz 1999, eq. 9, with the symmetric term integrated), and the
    /// density of the formula \[1/sr\].
    fn cdf_and_density(&self, versine: f64) -> (f64, f64) {
        let (delta, s, c) = (self.delta(versine), 0.5 * versine, 1.0 - versine);
        let (d_nu, a, b) = self.quotients(delta);
        // (1 - d^(nu + 1)) / (1 - d) = 1 + d a
        let cdf = (1.0 + delta * a - a * s) / d_nu + 0.125 * self.backward * c * (1.0 - c * c);
        // nu (1 - d) - (1 - d^nu) = (1 - d)(nu - a) = (1 - d)^2 b, and
        // d (1 - d^nu) - nu (1 - d) = (1 - d)(d a - nu) = -(1 - d)^2 (a + b)
        let p = (b - (a + b) / s) / (4.0 * PI * d_nu) + self.backward * (3.0 * c * c - 1.0) / (16.0 * PI);
        (cdf, p)
    }

    /// `p` \[1/sr\] at `v = 1 - cos theta`.
    #[inline]
    pub fn eval(&self, versine: f32) -> f32 {
        let v = f64::from(versine);
        let p = if v < CORE { self.brackets[0].1 / (2.0 * PI * CORE) } else { self.cdf_and_density(v).1 };
        p as f32
    }

    /// Draws the angle.
    #[inline]
    pub fn sample(&self, u: f32) -> Deflection {
        let u = f64::from(u);
        let above = self.brackets.partition_point(|&(_, f)| f <= u);
        let versine = match above {
            0 => CORE * u / self.brackets[0].1,
            BRACKETS => 2.0,
            i => {
                let ((v0, f0), (v1, f1)) = (self.brackets[i - 1], self.brackets[i]);
                let guess = v0 + (v1 - v0) * (u - f0) / (f1 - f0);
                let cdf_and_slope = |v: f64| {
                    let (cdf, p) = self.cdf_and_density(v);
                    (cdf, 2.0 * PI * p)
                };
                invert_increasing(cdf_and_slope, u, guess, [v0, v1])
            }
        };
        Deflection::from_versine(versine as f32)
    }

    /// `<cos theta>`.
    pub fn mean_cosine(&self) -> f32 {
        self.mean_cosine
    }

    /// `<cos> = 1 - <v> = 1 - int_0^2 (1 - F(v)) dv`, Simpson's rule between the brackets.
    fn integrate_cosine(&self) -> f64 {
        let core = CORE * (1.0 - 0.5 * self.brackets[0].1);
        let tail: f64 = self.brackets.windows(2).map(|w| self.above_simpson(w[0].0, w[1].0)).sum();
        1.0 - core - tail
    }

    fn above_simpson(&self, a: f64, b: f64) -> f64 {
        let above = |v: f64| 1.0 - self.cdf_and_density(v).0;
        (b - a) / 6.0 * (above(a) + 4.0 * above(0.5 * (a + b)) + above(b))
    }
}
