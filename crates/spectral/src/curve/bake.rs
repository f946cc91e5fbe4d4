//! 1 nm tables made from other forms.

use super::Curve;
use crate::error::SpectralError;
use crate::range::{LambdaRange, Outside};

/// A 1 nm table and how far it is from the curve it came from.
#[derive(Clone, Debug, PartialEq)]
pub struct Baked {
    /// The table.
    pub curve: Curve,
    /// The greatest difference seen at 16 points per nm, in the curve's unit; 0 when the table has the curve's own
    /// points.
    pub max_error: f32,
}

impl Curve {
    /// A 1 nm table over `range` (widened to whole nm) that equals this curve there up to rounding, or `None` when no such
    /// table exists: only constants, 1 nm tables, and points on whole nm that cover the range, and their multiples.
    pub fn bake(&self, range: LambdaRange) -> Option<Self> {
        let whole = widened(range);
        let exact = match self {
            Self::Constant(_) => true,
            Self::Dense(table) => table.range().covers(&whole) && whole_knots(table.lambda(), whole),
            Self::Linear(table) => {
                table.range().covers(&whole) && whole_knots(table.lambda().iter().copied(), whole)
            }
            Self::Scaled(factor, curve) => return Some(curve.bake(range)?.scaled(*factor)),
            _ => false,
        };
        exact.then(|| self.tabulate(whole))?.ok()
    }

    /// A 1 nm table over `range` (widened to whole nm, an error asked for outside) with its measured error.
    pub fn bake_approximate(&self, range: LambdaRange) -> Result<Baked, SpectralError> {
        if let Some(curve) = self.bake(range) {
            return Ok(Baked { curve, max_error: 0.0 });
        }
        let curve = self.tabulate(widened(range))?;
        let steps = (range.width() * 16.0) as usize;
        let max_error = (0..=steps)
            .map(|i| range.min + i as f32 / 16.0)
            .map(|l| (curve.eval(l) - self.eval(l)).abs())
            .fold(0.0, f32::max);
        Ok(Baked { curve, max_error })
    }

    fn tabulate(&self, whole: LambdaRange) -> Result<Self, SpectralError> {
        let count = whole.width() as usize + 1;
        let values: Vec<f32> = (0..count).map(|i| self.eval(whole.min + i as f32)).collect();
        Self::dense(whole.min as u32, &values, Outside::Error)
    }
}

/// True when every point inside `range` is at a whole nanometre.
fn whole_knots(mut lambda: impl Iterator<Item = f32>, range: LambdaRange) -> bool {
    lambda.all(|l| l.fract() == 0.0 || !range.contains(l))
}

/// The least range with whole ends that covers `range`.
fn widened(range: LambdaRange) -> LambdaRange {
    let (min, max) = (range.min.floor(), range.max.ceil());
    LambdaRange { min, max: if max > min { max } else { min + 1.0 } }
}
