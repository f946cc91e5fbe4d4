//! Piecewise linear tables on any wavelengths.

use super::knots::Knots;
use crate::error::SpectralError;
use crate::range::{LambdaRange, Outside};

/// Straight lines between given points; the rule [`Outside`] holds beyond the first and the last.
#[derive(Clone, Debug, PartialEq)]
pub struct PiecewiseLinear {
    knots: Knots,
    values: Vec<f32>,
    /// First wavelength, its value and the slope, per interval.
    segments: Vec<[f32; 3]>,
    below: f32,
    above: f32,
    outside: Outside,
}

impl PiecewiseLinear {
    pub(super) fn new(lambda: &[f32], values: &[f32], outside: Outside) -> Result<Self, SpectralError> {
        let knots = Knots::new(lambda)?;
        if values.len() != lambda.len() {
            return Err(SpectralError::Length { expected: lambda.len(), got: values.len() });
        }
        super::check_finite(values)?;
        let slope = |i: usize| (values[i + 1] - values[i]) / (lambda[i + 1] - lambda[i]);
        let segments = (0..lambda.len() - 1).map(|i| [lambda[i], values[i], slope(i)]).collect();
        let (below, above) = (outside.beyond(values[0]), outside.beyond(values[values.len() - 1]));
        Ok(Self { knots, values: values.to_vec(), segments, below, above, outside })
    }

    /// Value at `l` \[nm\].
    #[inline(always)]
    pub(super) fn eval(&self, l: f32) -> f32 {
        if l < self.knots.first() {
            self.below
        } else if l > self.knots.last() {
            self.above
        } else {
            let [start, value, slope] = self.segments[self.knots.interval(l)];
            value + (l - start) * slope
        }
    }

    /// Wavelengths of the points \[nm\].
    pub fn lambda(&self) -> &[f32] {
        self.knots.lambda()
    }

    /// Values at the points.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// First to last wavelength.
    pub fn range(&self) -> LambdaRange {
        LambdaRange { min: self.knots.first(), max: self.knots.last() }
    }

    /// The rule beyond the ends.
    pub fn outside(&self) -> Outside {
        self.outside
    }
}
