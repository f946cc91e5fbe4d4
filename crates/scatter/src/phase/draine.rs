//! Draine 2003, eq. 4: Henyey-Greenstein times `1 + alpha cos^2 theta`, for interstellar and other small particles:
//! `p = (1 - g^2) (1 + alpha cos^2) / (4 pi (1 + alpha (1 + 2 g^2) / 3) (1 + g^2 - 2 g cos)^(3/2))` \[1/sr\].
//!
//! `alpha = 0` is Henyey-Greenstein, `alpha = 1` Cornette & Shanks 1992, `g = 0, alpha = 1` Rayleigh. The parameter `g` is
//! not the mean cosine, which is `g (1 + alpha (3 + 2 g^2) / 5) / (1 + alpha (1 + 2 g^2) / 3)`.

use super::deflection::Deflection;
use super::henyey_greenstein::{self, require_asymmetry};
use super::invert::invert_increasing;
use crate::error::{ScatterError, require_curve};
use tyndall_spectral::curve::Curve;
use tyndall_spectral::{Spectrum, Wavelengths};

/// Draine's phase function with `g(lambda)` and `alpha(lambda)`.
#[derive(Clone, Debug, PartialEq)]
pub struct Draine {
    g: Curve,
    alpha: Curve,
}

/// Asymmetries this small count as zero, in value and sampling alike: the inversion divides by g.
const SMALL_G: f32 = 1e-5;

/// `<cos^2>` of Henyey-Greenstein.
#[inline(always)]
fn second_moment(g: f32) -> f32 {
    (1.0 + 2.0 * g * g) * (1.0 / 3.0)
}

#[inline(always)]
fn flush(g: f32) -> f32 {
    if g.abs() < SMALL_G { 0.0 } else { g }
}

impl Draine {
    /// `g` in (-1, 1), `alpha >= 0`, both without unit.
    pub fn new(g: Curve, alpha: Curve) -> Result<Self, ScatterError> {
        require_asymmetry(&g, "asymmetry parameter g of Draine's phase function")?;
        let ok = |a: f32| a >= 0.0 && a.is_finite();
        require_curve(&alpha, "parameter alpha of Draine's phase function", "a finite alpha >= 0", ok)?;
        Ok(Self { g, alpha })
    }

    /// Cornette & Shanks 1992, eq. 8: `alpha = 1`.
    pub fn cornette_shanks(g: Curve) -> Result<Self, ScatterError> {
        Self::new(g, Curve::ONE)
    }

    /// The curves it is made of: `[g, alpha]`.
    pub fn curves(&self) -> [&Curve; 2] {
        [&self.g, &self.alpha]
    }

    /// `p` \[1/sr\] per lane at `v = 1 - cos theta`.
    #[inline(always)]
    pub fn eval<const N: usize>(&self, versine: f32, lambda: &Wavelengths<N>) -> Spectrum<N> {
        let (g, alpha) = (self.g.sample(lambda).map(flush), self.alpha.sample(lambda));
        let cos2 = (1.0 - versine) * (1.0 - versine);
        Spectrum::from_fn(|k| {
            let lobe = (1.0 + alpha[k] * cos2) / (1.0 + alpha[k] * second_moment(g[k]));
            lobe * henyey_greenstein::p(g[k], versine)
        })
    }

    /// Draws the angle at `lambda` \[nm\]: Henyey-Greenstein's uniform variable, with its distribution inverted.
    #[inline]
    pub fn sample(&self, u: f32, lambda: f32) -> Deflection {
        let (g, alpha) = (flush(self.g.eval(lambda)), self.alpha.eval(lambda));
        let warp = Warp::new(f64::from(g), f64::from(alpha));
        let u = f64::from(u);
        let x = invert_increasing(|x| warp.cdf_and_slope(x), u, u, [0.0, 1.0]);
        henyey_greenstein::sample(g, x as f32)
    }

    /// `<cos theta>` at `lambda` \[nm\].
    pub fn mean_cosine(&self, lambda: f32) -> f32 {
        let (g, alpha) = (flush(self.g.eval(lambda)), self.alpha.eval(lambda));
        g * (1.0 + alpha * (3.0 + 2.0 * g * g) / 5.0) / (1.0 + alpha * second_moment(g))
    }
}

/// The distribution of Draine's angles over the uniform variable `x` of Henyey-Greenstein:
/// `F(x) = (x + alpha int_0^x cos^2) / (1 + alpha <cos^2>)`, where `cos = a - b / (1 + g s)^2` and `s = 2 x - 1`.
struct Warp {
    g: f64,
    alpha: f64,
    a: f64,
    b: f64,
    norm: f64,
}

impl Warp {
    fn new(g: f64, alpha: f64) -> Self {
        let q = 1.0 - g * g;
        let norm = 1.0 / (1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0);
        Self { g, alpha, a: (1.0 + g * g) / (2.0 * g), b: q * q / (2.0 * g), norm }
    }

    fn cdf_and_slope(&self, x: f64) -> (f64, f64) {
        let s = 2.0 * x - 1.0;
        let (cos, integral) = if self.g == 0.0 {
            (s, (s * s * s + 1.0) / 6.0)
        } else {
            let (from, to) = (1.0 / (1.0 - self.g), 1.0 / (1.0 + self.g * s));
            let second = from * to;
            let fourth = second * (from * from + from * to + to * to) / 3.0;
            let (a, b) = (self.a, self.b);
            (a - b * to * to, x * (a * a - 2.0 * a * b * second + b * b * fourth))
        };
        (self.norm * (x + self.alpha * integral), self.norm * (1.0 + self.alpha * cos * cos))
    }
}
