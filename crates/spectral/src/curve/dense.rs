//! Tables at equal distances, first of all at every nanometre.

use crate::error::SpectralError;
use crate::range::{LambdaRange, Outside};
use crate::spectrum::Spectrum;
use crate::wavelengths::Wavelengths;

/// Values at `first`, `first + step`, ... nm, straight lines between them: the fastest form.
#[derive(Clone, Debug, PartialEq)]
pub struct Dense {
    first: f32,
    last: f32,
    step: f32,
    per_nm: f32,
    values: Vec<f32>,
    /// Per point its value and the rise to the next one, 0 for the last; in front of them one for ties rounded down.
    segments: Vec<[f32; 2]>,
    /// `last` in steps from `first`.
    end: f32,
    outside: Outside,
}

/// A number from 0 to 2^22 plus this is rounded to an integer, which is then in the low bits: cheaper than a conversion.
const ROUND: f32 = 8_388_608.0;

impl Dense {
    pub(super) fn new(
        first: f32,
        step: f32,
        values: &[f32],
        outside: Outside,
    ) -> Result<Self, SpectralError> {
        if values.len() < 2 {
            return Err(SpectralError::TooFew { what: "values of a table", needed: 2, got: values.len() });
        }
        super::check_finite(values)?;
        let last = first + (values.len() - 1) as f32 * step;
        let next = |i: usize| values[(i + 1).min(values.len() - 1)];
        let inside = values.iter().enumerate().map(|(i, &v)| [v, next(i) - v]);
        let segments = std::iter::once([values[0], 0.0]).chain(inside).collect();
        let (per_nm, end) = (1.0 / step, (values.len() - 1) as f32);
        let values = values.to_vec();
        Ok(Self { first, last, step, per_nm, values, segments, end, outside })
    }

    /// The table with these points, when they are equally far apart.
    pub(super) fn from_even_points(lambda: &[f32], values: &[f32], outside: Outside) -> Option<Self> {
        let (first, step) = (*lambda.first()?, lambda.get(1)? - lambda[0]);
        let even = step > 0.0 && lambda.iter().enumerate().all(|(i, &l)| l == first + i as f32 * step);
        let fits = lambda.len() == values.len() && lambda.len() < 1 << 20;
        (even && fits).then(|| Self::new(first, step, values, outside).ok())?
    }

    /// Values at the wavelengths of a path.
    ///
    /// A point itself may be taken as the end of the interval before it: the value is the same.
    #[inline(always)]
    pub fn sample<const N: usize>(&self, w: &Wavelengths<N>) -> Spectrum<N> {
        let x = (Spectrum(w.lambda) - Spectrum::splat(self.first)) * self.per_nm;
        let x = x.map(|x| x.max(0.0).min(self.end));
        let rounded = x.map(|x| x + 0.5 + ROUND);
        let mut out = Spectrum::ZERO;
        for k in 0..N {
            let [value, rise] = self.segments[(rounded[k].to_bits() & 0x007f_ffff) as usize];
            out[k] = value + (x[k] - (rounded[k] - (ROUND + 1.0))) * rise;
        }
        if self.outside != Outside::Hold {
            let rest = self.outside.beyond(0.0);
            for k in 0..N {
                out[k] = if w.lambda[k] < self.first || w.lambda[k] > self.last { rest } else { out[k] };
            }
        }
        out
    }

    /// Value at `l` \[nm\].
    #[inline(always)]
    pub(super) fn eval(&self, l: f32) -> f32 {
        self.sample(&Wavelengths::continuum([l], [1.0]))[0]
    }

    /// The table times `factor`; `None` where that is not finite.
    pub(super) fn scaled(&self, factor: f32) -> Option<Self> {
        let values: Vec<f32> = self.values.iter().map(|v| v * factor).collect();
        Self::new(self.first, self.step, &values, self.outside).ok()
    }

    /// First wavelength \[nm\].
    pub fn first(&self) -> f32 {
        self.first
    }

    /// Distance of the points \[nm\].
    pub fn step(&self) -> f32 {
        self.step
    }

    /// Wavelengths of the points \[nm\].
    pub fn lambda(&self) -> impl Iterator<Item = f32> + '_ {
        (0..self.values.len()).map(|i| self.first + i as f32 * self.step)
    }

    /// Values at the points.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// First to last wavelength.
    pub fn range(&self) -> LambdaRange {
        LambdaRange { min: self.first, max: self.last }
    }

    /// The rule beyond the ends.
    pub fn outside(&self) -> Outside {
        self.outside
    }
}
