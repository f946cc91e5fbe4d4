//! Two Henyey-Greenstein lobes (Kattawar 1975): `p = w p_HG(g_1) + (1 - w) p_HG(g_2)` \[1/sr\], usually one forward and one
//! backward; mean cosine `w g_1 + (1 - w) g_2`.

use super::deflection::Deflection;
use super::henyey_greenstein::{self, require_asymmetry};
use crate::error::{ScatterError, require_curve};
use tyndall_spectral::curve::Curve;
use tyndall_spectral::{Spectrum, Wavelengths};

/// Two lobes with `g_1(lambda)`, `g_2(lambda)` and the weight `w(lambda)` of the first.
#[derive(Clone, Debug, PartialEq)]
pub struct TwoLobe {
    g: [Curve; 2],
    weight: Curve,
}

impl TwoLobe {
    /// `g` in (-1, 1), `weight` of the first lobe in \[0, 1\], without unit.
    pub fn new(g: [Curve; 2], weight: Curve) -> Result<Self, ScatterError> {
        require_asymmetry(&g[0], "asymmetry g of the first lobe")?;
        require_asymmetry(&g[1], "asymmetry g of the second lobe")?;
        require_curve(&weight, "weight of the first lobe", "0 <= weight <= 1", |w| (0.0..=1.0).contains(&w))?;
        Ok(Self { g, weight })
    }

    /// The curves it is made of: `[g_1, g_2, w]`.
    pub fn curves(&self) -> [&Curve; 3] {
        [&self.g[0], &self.g[1], &self.weight]
    }

    /// `p` \[1/sr\] per lane at `v = 1 - cos theta`.
    #[inline(always)]
    pub fn eval<const N: usize>(&self, versine: f32, lambda: &Wavelengths<N>) -> Spectrum<N> {
        let w = self.weight.sample(lambda);
        let [a, b] =
            [&self.g[0], &self.g[1]].map(|g| g.sample(lambda).map(|g| henyey_greenstein::p(g, versine)));
        w * a + (Spectrum::ONE - w) * b
    }

    /// Draws the angle at `lambda` \[nm\]: the lobe by its weight, then the angle with what is left of `u`.
    #[inline(always)]
    pub fn sample(&self, u: f32, lambda: f32) -> Deflection {
        let w = self.weight.eval(lambda);
        let (g, u) = if u < w { (&self.g[0], u / w) } else { (&self.g[1], (u - w) / (1.0 - w)) };
        henyey_greenstein::sample(g.eval(lambda), u.min(1.0))
    }

    /// `<cos theta>` at `lambda` \[nm\].
    pub fn mean_cosine(&self, lambda: f32) -> f32 {
        let w = self.weight.eval(lambda);
        w * self.g[0].eval(lambda) + (1.0 - w) * self.g[1].eval(lambda)
    }
}
