//! How the wavelengths of a path are chosen.
//!
//! *Hero* (Wilkie, Nawaz, Droske, Weidlich, Hanika, "Hero wavelength spectral sampling", Computer Graphics Forum 33(4),
//! 2014): one number `u` gives all slots, `u_j = frac(u + j / N)`, each through the inverse of the distribution function.
//! Every slot then has the same marginal density, and the hero (slot 0) is uniform within the set, so all slots are
//! exchangeable. *OPOW*, one path one wavelength (Wang, Chern 2001), is the same with `N = 1`.
//!
//! A *fixed set* of M wavelengths is a quadrature rule: each slot picks one of the M uniformly, and the mean of
//! `value / pdf` has the quadrature sum as its expectation.

mod density;
mod fixed;
mod importance;
mod meyer;

use std::sync::Arc;

pub use density::Density;
pub use fixed::{FixedSet, Rule};
pub use meyer::Meyer;

use crate::range::LambdaRange;
use crate::wavelengths::{CONTINUUM, Wavelengths};

/// Draws the wavelengths of a path; cheap to clone.
#[derive(Clone, Debug)]
pub enum WavelengthSampler {
    /// From a density over a range, and lines with probabilities.
    Density(Arc<Density>),
    /// From a fixed set, uniformly.
    Fixed(Arc<FixedSet>),
}

impl WavelengthSampler {
    /// Uniform over `range`.
    pub fn uniform(range: LambdaRange) -> Self {
        Density::uniform(range).into()
    }

    /// The wavelengths of the path with the number `u` in \[0, 1).
    #[inline(always)]
    pub fn sample<const N: usize>(&self, u: f32) -> Wavelengths<N> {
        match self {
            Self::Density(density) => {
                let mut w = Wavelengths { lambda: [0.0; N], pdf: [0.0; N], line: [CONTINUUM; N] };
                for k in 0..N {
                    (w.lambda[k], w.pdf[k], w.line[k]) = density.sample(rotate::<N>(u, k));
                }
                w
            }
            Self::Fixed(set) => {
                let mut lambda = [0.0; N];
                for k in 0..N {
                    lambda[k] = set.pick(rotate::<N>(u, k));
                }
                Wavelengths::continuum(lambda, [set.pdf(); N])
            }
        }
    }

    /// Density of the continuum at `lambda` \[1/nm\]; 0 for a fixed set, which has no density.
    pub fn pdf(&self, lambda: f32) -> f32 {
        match self {
            Self::Density(density) => density.pdf(lambda),
            Self::Fixed(_) => 0.0,
        }
    }

    /// The range that wavelengths are drawn from.
    pub fn range(&self) -> LambdaRange {
        match self {
            Self::Density(density) => density.range(),
            Self::Fixed(set) => set.range(),
        }
    }
}

impl From<Density> for WavelengthSampler {
    fn from(density: Density) -> Self {
        Self::Density(Arc::new(density))
    }
}

impl From<FixedSet> for WavelengthSampler {
    fn from(set: FixedSet) -> Self {
        Self::Fixed(Arc::new(set))
    }
}

/// `frac(u + k / N)` in \[0, 1), without rounding for `u` on the grid of 2^-24: no sum leaves \[0, 1\].
#[inline(always)]
fn rotate<const N: usize>(u: f32, k: usize) -> f32 {
    let shift = k as f32 / N as f32;
    let turn = 1.0 - shift;
    if u >= turn { u - turn } else { u + shift }
}

#[cfg(test)]
mod tests;
