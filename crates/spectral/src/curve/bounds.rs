//! Extremes and wavelengths where a curve may bend.

use super::Curve;
use crate::range::LambdaRange;

impl Curve {
    /// An upper bound on `range`; exact for every form but products, where it is the product of the bounds (of values
    /// that are not negative).
    pub fn max_value(&self, range: LambdaRange) -> f32 {
        self.bounds(range)[1]
    }

    /// A lower bound on `range`, exact in the same cases.
    pub fn min_value(&self, range: LambdaRange) -> f32 {
        self.bounds(range)[0]
    }

    /// `[lower, upper]` bounds on `range`; NaN where a table is not defined.
    pub fn bounds(&self, range: LambdaRange) -> [f32; 2] {
        match self {
            Self::Constant(v) => [*v, *v],
            Self::Sigmoid(s) => s.bounds(range),
            Self::ScaledSigmoid(factor, s) => times(s.bounds(range), [*factor, *factor]),
            Self::Scaled(factor, curve) => times(curve.bounds(range), [*factor, *factor]),
            Self::Product(pair) => times(pair.0.bounds(range), pair.1.bounds(range)),
            Self::Blackbody(body) => {
                let peak = (body.peak_nm() as f32).clamp(range.min, range.max);
                self.extremes([range.min, range.max, peak].into_iter())
            }
            Self::Linear(table) => self.extremes(corners(table.lambda(), range)),
            Self::Step(table) => self.extremes(corners(table.edges(), range)),
            Self::Dense(table) => {
                let inside = table.lambda().filter(|&l| range.contains(l));
                self.extremes(inside.chain(outer(table.range(), range)))
            }
        }
    }

    fn extremes(&self, at: impl Iterator<Item = f32>) -> [f32; 2] {
        at.map(|l| self.eval(l)).fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], v| {
            if v.is_nan() { [v, v] } else { [if v < low { v } else { low }, if v > high { v } else { high }] }
        })
    }
}

/// Ends of `range` and the points just outside a table's ends, when they lie inside `range`.
fn outer(table: LambdaRange, range: LambdaRange) -> impl Iterator<Item = f32> {
    let ends = [range.min, range.max, table.min.next_down(), table.max.next_up()];
    ends.into_iter().filter(move |&l| range.contains(l))
}

/// All wavelengths in `range` where a table with these knots can have an extreme.
fn corners(knots: &[f32], range: LambdaRange) -> impl Iterator<Item = f32> + '_ {
    let table = LambdaRange { min: knots[0], max: knots[knots.len() - 1] };
    let inside = knots.iter().copied().filter(move |&l| range.contains(l));
    inside.chain(outer(table, range))
}

/// The products of two intervals lie between the products of their ends.
fn times(a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
    let products = [a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1]];
    products.iter().fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], &v| {
        if v.is_nan() { [v, v] } else { [if v < low { v } else { low }, if v > high { v } else { high }] }
    })
}
