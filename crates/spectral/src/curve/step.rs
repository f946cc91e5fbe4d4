//! Piecewise constant tables: one value per band.

use super::knots::Knots;
use crate::error::SpectralError;
use crate::range::{LambdaRange, Outside};

/// `values[i]` on `edges[i] <= lambda < edges[i + 1]`, the last band closed.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    edges: Knots,
    values: Vec<f32>,
    outside: Outside,
}

impl Step {
    pub(super) fn new(edges: &[f32], values: &[f32], outside: Outside) -> Result<Self, SpectralError> {
        let edges = Knots::new(edges)?;
        if values.len() + 1 != edges.lambda().len() {
            return Err(SpectralError::Length { expected: edges.lambda().len() - 1, got: values.len() });
        }
        super::check_finite(values)?;
        Ok(Self { edges, values: values.to_vec(), outside })
    }

    /// Value at `l` \[nm\].
    #[inline(always)]
    pub(super) fn eval(&self, l: f32) -> f32 {
        if l < self.edges.first() {
            self.outside.beyond(self.values[0])
        } else if l > self.edges.last() {
            self.outside.beyond(self.values[self.values.len() - 1])
        } else {
            self.values[self.edges.interval(l)]
        }
    }

    /// Edges of the bands \[nm\], one more than values.
    pub fn edges(&self) -> &[f32] {
        self.edges.lambda()
    }

    /// One value per band.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// First to last edge.
    pub fn range(&self) -> LambdaRange {
        LambdaRange { min: self.edges.first(), max: self.edges.last() }
    }

    /// The rule beyond the ends.
    pub fn outside(&self) -> Outside {
        self.outside
    }
}
