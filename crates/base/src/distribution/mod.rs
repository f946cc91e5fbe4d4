//! Discrete and piecewise constant distributions whose reported probabilities are exact.
//!
//! A renderer's uniform numbers are multiples of 2^-24, so a table that compares them with real thresholds draws its
//! entries with probabilities that differ from the ones it reports, by percents in tables of a million entries. Here
//! the weights are first rounded to whole numbers of the 2^24 possible values (at least one for each positive weight), and both
//! drawing and reporting use those: `sum over u of f(sample(u)) / pmf` is exactly `2^24 sum of f`.

mod alias;
mod piecewise;
#[cfg(test)]
mod tests;
mod windowed;

pub use alias::Alias;
pub use piecewise::{Piecewise1d, Piecewise2d};
pub use windowed::{Window, Windowed2d};

/// Number of values a uniform `f32` takes.
const STEPS: u32 = 1 << 24;
/// One of [`STEPS`] as a number.
const STEP: f32 = 1.0 / STEPS as f32;
/// The most entries a table may have: a quarter of the values, so that rounding keeps the shape of the weights.
const MAX_ENTRIES: usize = 1 << 22;

/// Why a distribution cannot be built.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DistributionError {
    /// No entries.
    #[error("expected at least one weight, got none")]
    Empty,
    /// A weight is negative, infinite or not a number.
    #[error("weight {index}: expected a finite number >= 0, got {value}")]
    Weight {
        /// Position in the table.
        index: usize,
        /// The offending weight.
        value: f64,
    },
    /// Nothing to draw.
    #[error("expected at least one positive weight, all {count} are zero")]
    AllZero {
        /// Number of weights.
        count: usize,
    },
    /// More entries than uniform numbers of 24 bits can tell apart.
    #[error("expected at most {MAX_ENTRIES} weights, got {count}")]
    TooMany {
        /// Number of weights.
        count: usize,
    },
    /// The size of the table is not what its sides say.
    #[error("expected {width} x {height} weights, got {count}")]
    Shape {
        /// Entries a row.
        width: usize,
        /// Rows.
        height: usize,
        /// Number of weights.
        count: usize,
    },
    /// The ends of an interval are not ordered.
    #[error("expected an interval with a < b, got [{a}, {b}]")]
    Interval {
        /// Left end.
        a: f32,
        /// Right end.
        b: f32,
    },
}

/// The step number of a uniform number.
#[inline(always)]
fn step_of(u: f32) -> u32 {
    // the cast saturates: negative numbers give 0
    ((u * STEPS as f32) as u32).min(STEPS - 1)
}

/// Checks weights and returns their sum.
fn total(weights: impl ExactSizeIterator<Item = f64>) -> Result<f64, DistributionError> {
    let count = weights.len();
    match count {
        0 => return Err(DistributionError::Empty),
        _ if count > MAX_ENTRIES => return Err(DistributionError::TooMany { count }),
        _ => {}
    }
    let mut sum = 0.0;
    for (index, value) in weights.enumerate() {
        if !(value >= 0.0 && value.is_finite()) {
            return Err(DistributionError::Weight { index, value });
        }
        sum += value;
    }
    if sum > 0.0 { Ok(sum) } else { Err(DistributionError::AllZero { count }) }
}

/// Shares [`STEPS`] out in proportion to the weights, by largest remainders; each positive weight gets at least one.
fn share_steps(weights: &[f64]) -> Result<Vec<u32>, DistributionError> {
    // scaled by the greatest, so that the sum cannot overflow
    let greatest = weights.iter().copied().fold(0.0, f64::max);
    total(weights.iter().copied())?;
    let sum: f64 = weights.iter().map(|w| w / greatest).sum();
    let ideal = |i: usize| weights[i] / greatest / sum * f64::from(STEPS);
    let mut steps: Vec<u32> =
        (0..weights.len()).map(|i| (ideal(i) as u32).max(u32::from(weights[i] > 0.0))).collect();
    let used: i64 = steps.iter().map(|&s| i64::from(s)).sum();
    balance(&mut steps, i64::from(STEPS) - used, ideal);
    Ok(steps)
}

/// Brings the sum of `steps` up or down by `missing`: gifts by largest remainder, cuts from the largest shares.
fn balance(steps: &mut [u32], missing: i64, ideal: impl Fn(usize) -> f64) {
    let mut order: Vec<usize> = (0..steps.len()).filter(|&i| steps[i] > 0).collect();
    let rest = |i: usize, s: &[u32]| ideal(i) - f64::from(s[i]);
    let mut left = missing;
    if missing > 0 {
        order.sort_by(|&a, &b| rest(b, steps).total_cmp(&rest(a, steps)));
    } else {
        order.sort_by_key(|&i| std::cmp::Reverse(steps[i]));
    }
    while left != 0 {
        for &i in &order {
            if left > 0 {
                steps[i] += 1;
                left -= 1;
            } else if left < 0 && steps[i] > 1 {
                steps[i] -= 1;
                left += 1;
            } else {
                break;
            }
        }
    }
}
