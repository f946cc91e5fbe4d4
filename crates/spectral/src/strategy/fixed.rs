//! Fixed sets of equidistant wavelengths, used as quadrature rules.

use crate::error::SpectralError;
use crate::range::LambdaRange;
use crate::wavelengths::Wavelengths;

/// Where the wavelengths of a fixed set of M stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// `min + (i + 1/2) (max - min) / M`: converges fast for smooth spectra that vanish at the ends.
    Midpoint,
    /// `min + i (max - min) / (M - 1)`, both ends included, all with the weight `(max - min) / M`: its error falls only as
    /// 1/M, as in figure 6 of Wang and Chern 2001.
    Endpoints,
}

/// M wavelengths with equal weights.
#[derive(Clone, Debug, PartialEq)]
pub struct FixedSet {
    range: LambdaRange,
    lambda: Vec<f32>,
    pdf: f32,
}

impl FixedSet {
    /// `count` >= 1 wavelengths on `range` (>= 2 for [`Rule::Endpoints`]).
    pub fn new(range: LambdaRange, count: usize, rule: Rule) -> Result<Self, SpectralError> {
        let needed = if rule == Rule::Endpoints { 2 } else { 1 };
        if count < needed {
            return Err(SpectralError::TooFew { what: "wavelengths of a fixed set", needed, got: count });
        }
        let (min, width) = (f64::from(range.min), f64::from(range.max) - f64::from(range.min));
        let position = |i: usize| match rule {
            Rule::Midpoint => (i as f64 + 0.5) / count as f64,
            Rule::Endpoints => i as f64 / (count - 1) as f64,
        };
        let lambda = (0..count).map(|i| (min + width * position(i)) as f32).collect();
        Ok(Self { range, lambda, pdf: (1.0 / width) as f32 })
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
        let lambda = std::array::from_fn(|k| self.lambda[(g * N + k).min(last)]);
        let pdf = std::array::from_fn(|k| if g * N + k <= last { self.pdf } else { f32::INFINITY });
        Wavelengths::continuum(lambda, pdf)
    }

    /// One of the set, for `u` uniform in \[0, 1).
    #[inline(always)]
    pub(super) fn pick(&self, u: f32) -> f32 {
        let count = self.lambda.len();
        self.lambda[((u * count as f32) as usize).min(count - 1)]
    }
}
