//! Tables at every integer nanometre.

use crate::error::SpectralError;
use crate::range::{LambdaRange, Outside};
use crate::spectrum::Spectrum;
use crate::wavelengths::Wavelengths;

/// Values at `first`, `first + 1`, ... nm, straight lines between them: the fastest form.
#[derive(Clone, Debug, PartialEq)]
pub struct Dense {
    first: f32,
    last: f32,
    values: Vec<f32>,
    below: f32,
    above: f32,
    outside: Outside,
}

impl Dense {
    pub(super) fn new(first_nm: u32, values: &[f32], outside: Outside) -> Result<Self, SpectralError> {
        if values.len() < 2 {
            return Err(SpectralError::TooFew {
                what: "values of a 1 nm table",
                needed: 2,
                got: values.len(),
            });
        }
        super::check_finite(values)?;
        let (below, above) = (outside.beyond(values[0]), outside.beyond(values[values.len() - 1]));
        let first = first_nm as f32;
        let last = first + (values.len() - 1) as f32;
        Ok(Self { first, last, values: values.to_vec(), below, above, outside })
    }

    /// Value at `l` \[nm\].
    #[inline(always)]
    pub(super) fn eval(&self, l: f32) -> f32 {
        let x = l - self.first;
        let i = (x as usize).min(self.values.len() - 2);
        let pair = &self.values[i..i + 2];
        let inside = pair[0] + (x - i as f32) * (pair[1] - pair[0]);
        let at_least_first = if l < self.first { self.below } else { inside };
        if l > self.last { self.above } else { at_least_first }
    }

    /// Values at the wavelengths of a path.
    #[inline(always)]
    pub fn sample<const N: usize>(&self, w: &Wavelengths<N>) -> Spectrum<N> {
        Spectrum::from_fn(|k| self.eval(w.lambda[k]))
    }

    /// First wavelength \[nm\], an integer.
    pub fn first(&self) -> f32 {
        self.first
    }

    /// Values, 1 nm apart.
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
