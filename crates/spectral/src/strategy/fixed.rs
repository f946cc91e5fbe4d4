//! Fixed sets of wavelengths, used as quadrature rules: equidistant, or Meyer's four.

use super::Meyer;
use crate::curve::Curve;
use crate::error::{SpectralError, require};
use crate::range::{LambdaRange, Outside};
use crate::wavelengths::Wavelengths;

/// Where the wavelengths of a fixed set of M stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// `min + (i + 1/2) (max - min) / M`: converges fast for smooth spectra that vanish at the ends.
    Midpoint,
    /// `min + i (max - min) / (M - 1)`, both ends included, all with the weight `(max - min) / M`: its error falls only as
    /// 1/M, as in figure 6 of Wang and Chern 2001.
    Endpoints,
    /// Meyer's four wavelengths: [`super::Meyer`]. The film's responses are then those of [`FixedSet::responses`].
    Meyer,
}

/// Half the width \[nm\] of the plateau that a response has around one of Meyer's wavelengths.
const PLATEAU: f32 = 3.0;

/// M wavelengths with equal weights.
#[derive(Clone, Debug, PartialEq)]
pub struct FixedSet {
    range: LambdaRange,
    lambda: Vec<f32>,
    pdf: f32,
}

impl FixedSet {
    /// `count` >= 1 wavelengths on `range` (>= 2 for [`Rule::Endpoints`], 4 for [`Rule::Meyer`]).
    pub fn new(range: LambdaRange, count: usize, rule: Rule) -> Result<Self, SpectralError> {
        if rule == Rule::Meyer {
            return Self::meyer(range, count);
        }
        let needed = if rule == Rule::Endpoints { 2 } else { 1 };
        if count < needed {
            return Err(SpectralError::TooFew { what: "wavelengths of a fixed set", needed, got: count });
        }
        let (min, width) = (f64::from(range.min), f64::from(range.max) - f64::from(range.min));
        let position = |i: usize| match rule {
            Rule::Midpoint => (i as f64 + 0.5) / count as f64,
            Rule::Endpoints | Rule::Meyer => i as f64 / (count - 1) as f64,
        };
        let lambda = (0..count).map(|i| (min + width * position(i)) as f32).collect();
        Ok(Self { range, lambda, pdf: (1.0 / width) as f32 })
    }

    fn meyer(range: LambdaRange, count: usize) -> Result<Self, SpectralError> {
        require(count == 4, "number of Meyer's wavelengths", "4", count as f64)?;
        let lambda = Meyer::derive().lambda.map(|l| l as f32).to_vec();
        for l in [lambda[0], lambda[3]] {
            require(range.contains(l), "Meyer's wavelength [nm]", "within the spectral range", f64::from(l))?;
        }
        Ok(Self { range, lambda, pdf: 1.0 / range.width() })
    }

    /// The responses of X, Y and Z for which the quadrature sum of Meyer's set is his rule: constant around each
    /// wavelength, zero elsewhere.
    pub fn responses(&self) -> Result<[Curve; 3], SpectralError> {
        let rule = Meyer::derive();
        let scale = 1.0 / f64::from(self.weight());
        let curve = |c: usize| {
            let (mut at, mut value) = (Vec::new(), Vec::new());
            for (lambda, xyz) in rule.lambda.iter().zip(&rule.xyz) {
                let (l, v) = (*lambda as f32, (xyz[c] * scale) as f32);
                at.extend([l - PLATEAU - 1.0, l - PLATEAU, l + PLATEAU, l + PLATEAU + 1.0]);
                value.extend([0.0, v, v, 0.0]);
            }
            Curve::linear(&at, &value, Outside::Zero)
        };
        Ok([curve(0)?, curve(1)?, curve(2)?])
    }

    /// The wavelengths \[nm\], ascending.
    pub fn lambda(&self) -> &[f32] {
        &self.lambda
    }

    /// Weight of each wavelength in the quadrature sum \[nm\].
    pub fn weight(&self) -> f32 {
        1.0 / (self.pdf * self.lambda.len() as f32)
    }

    /// The number to divide a slot's value by \[1/nm\]: `1 / (M weight)`.
    #[inline(always)]
    pub fn pdf(&self) -> f32 {
        self.pdf
    }

    /// The range the set was spread over.
    pub fn range(&self) -> LambdaRange {
        self.range
    }

    /// Number of groups of `N` that hold the whole set.
    pub fn groups<const N: usize>(&self) -> usize {
        self.lambda.len().div_ceil(N)
    }

    /// Wavelengths `g N .. (g + 1) N` of the set, for strategies that carry the whole set. Slots past the end repeat the
    /// last wavelength with an infinite density, so that they count nothing. The sum over groups of `value / pdf`, divided
    /// by M, is the quadrature sum.
    pub fn group<const N: usize>(&self, g: usize) -> Wavelengths<N> {
        let last = self.lambda.len() - 1;
        let (mut lambda, mut pdf) = ([0.0; N], [f32::INFINITY; N]);
        for k in 0..N {
            let i = g * N + k;
            lambda[k] = self.lambda[i.min(last)];
            if i <= last {
                pdf[k] = self.pdf;
            }
        }
        Wavelengths::continuum(lambda, pdf)
    }

    /// One of the set, for `u` uniform in \[0, 1).
    #[inline(always)]
    pub(super) fn pick(&self, u: f32) -> f32 {
        let count = self.lambda.len();
        self.lambda[((u * count as f32) as usize).min(count - 1)]
    }
}
