//! Variances that can be trusted.
//!
//! The variance of few samples is itself noise, and too small wherever no bright path was met, so it is pooled over
//! a neighbourhood: `V_p = mean_q v_q min(1, (m_p / m_q)^2)`, `m` the local median. Noise grows with the light (it is
//! that of the same paths), so a brighter neighbour's counts in proportion; else the rim of a lamp would blur the dark
//! beside it.

use super::noisy::Channel;
use super::window::{around, median};
use rayon::prelude::*;

/// Reach of the pool.
const RADIUS: usize = 2;

/// The pooled variances of a channel.
pub(super) fn pool(channel: &Channel, width: usize) -> Vec<f32> {
    let level = levels(channel, width);
    let pixels = 0..channel.mean.len();
    pixels.into_par_iter().map(|p| pooled(&channel.variance, &level, width, p)).collect()
}

/// Squared brightness of the surroundings: medians do not see single bright pixels.
fn levels(channel: &Channel, width: usize) -> Vec<f32> {
    let square = |p: usize| {
        let m = median(&mut around(&channel.mean, width, [p % width, p / width], 1).collect());
        m * m
    };
    (0..channel.mean.len()).into_par_iter().map(square).collect()
}

fn pooled(variance: &[f32], level: &[f32], width: usize, p: usize) -> f32 {
    let at = [p % width, p / width];
    let (mut sum, mut count) = (0.0, 0.0);
    for (v, m) in around(variance, width, at, RADIUS).zip(around(level, width, at, RADIUS)) {
        if v.is_finite() {
            sum += if m > level[p] { v * (level[p] / m) } else { v };
            count += 1.0;
        }
    }
    if count > 0.0 { sum / count } else { 0.0 }
}
