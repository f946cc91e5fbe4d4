//! Fireflies: pixels that one sample in a million paths has lit.
//!
//! A pixel `u` with standard error `s` stands out when it is far from the median `m` of its neighbourhood by the errors
//! that are usual there, yet not by its own, because what lit it is rare: `|u - m| > FAR usual` and `|u - m| < OWN s`.
//! A lamp or an edge has a small error of its own and stays. So does what two neighbours share: noise falls on single
//! pixels.

use super::noisy::Channel;
use super::window::{around, median};
use rayon::prelude::*;

/// Reach of the neighbourhood.
const RADIUS: usize = 2;
/// Distance from the median in units of the usual error.
const FAR: f32 = 6.0;
/// Distance from the median in units of the pixel's own error: `n - 1` ordinary samples and one that outshines them
/// have 1, four bright ones of many about 2.
const OWN: f32 = 2.5;
/// Largest variances of the neighbours that do not count as usual.
const TRIMMED: usize = 3;

/// Puts the median of its neighbours in the place of each pixel that stands out, and of numbers that are not finite.
pub(super) fn replace(channel: &mut Channel, width: usize) {
    let found: Vec<(usize, f32, f32)> =
        (0..channel.mean.len()).into_par_iter().filter_map(|p| outlier(channel, width, p)).collect();
    for (p, mean, variance) in found {
        channel.mean[p] = mean;
        channel.variance[p] = variance;
    }
}

/// The index of a pixel that stands out, with the mean and variance that are usual there.
fn outlier(channel: &Channel, width: usize, p: usize) -> Option<(usize, f32, f32)> {
    let (u, own) = (channel.mean[p], channel.variance[p]);
    let at = [p % width, p / width];
    if u.is_finite() && !isolated(channel, width, at) {
        return None;
    }
    let mut values: Vec<f32> = around(&channel.mean, width, at, RADIUS).skip(1).collect();
    let m = median(&mut values);
    let usual = usual_variance(channel, width, at);
    let step = u - m;
    let stands_out = step * step > FAR * FAR * usual && step * step < OWN * OWN * own;
    (stands_out || !u.is_finite()).then_some((p, m, usual))
}

/// No more than one of the eight nearest has gone half of the way from the others' median to the pixel.
fn isolated(channel: &Channel, width: usize, at: [usize; 2]) -> bool {
    let near: Vec<f32> = around(&channel.mean, width, at, 1).collect();
    let m = median(&mut near[1..].to_vec());
    let step = near[0] - m;
    near[1..].iter().filter(|v| (*v - m) * step.signum() > 0.5 * step.abs()).count() <= 1
}

/// Mean of the neighbours' variances without the largest.
fn usual_variance(channel: &Channel, width: usize, at: [usize; 2]) -> f32 {
    let known = around(&channel.variance, width, at, RADIUS).skip(1).filter(|v| v.is_finite());
    let mut known: Vec<f32> = known.collect();
    known.sort_unstable_by(f32::total_cmp);
    known.truncate(known.len().saturating_sub(TRIMMED).max(1));
    if known.is_empty() { 0.0 } else { known.iter().sum::<f32>() / known.len() as f32 }
}
