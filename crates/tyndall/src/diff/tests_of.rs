//! Tests of a channel: blocks and the whole image by t, several tests by Sidak and Holm.

use super::{ChannelDiff, ChannelTests, channel::Pair};
use tyndall_film::stats::t_tail;

/// Sums over pixels that give a t.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    difference: f64,
    variance: f64,
    /// `sum(v_i^2 / nu_i)`.
    freedom: f64,
    pixels: usize,
    /// A pixel's error is unknown.
    unknown: bool,
}

impl Sums {
    fn add(&mut self, pair: &Pair<'_>, p: usize) {
        let Some((a, b)) = pair.at(p) else { return };
        let v = pair.variances(p);
        self.unknown |= v.iter().any(|v| !v.is_finite());
        self.pixels += 1;
        self.difference += a - b;
        self.variance += v[0] + v[1];
        let freedom = pair.freedom(p);
        self.freedom += v[0] * v[0] / freedom[0] + v[1] * v[1] / freedom[1];
    }

    fn join(&mut self, other: &Self) {
        self.difference += other.difference;
        self.variance += other.variance;
        self.freedom += other.freedom;
        self.pixels += other.pixels;
    }

    /// t and its two-sided probability.
    fn t(&self) -> (f64, f64) {
        if self.difference == 0.0 {
            return (0.0, 1.0);
        }
        if self.variance == 0.0 {
            return (f64::INFINITY.copysign(self.difference), 0.0);
        }
        let t = self.difference / self.variance.sqrt();
        let nu = (self.variance * self.variance / self.freedom).clamp(1.0, 1e6) as u32;
        (t, t_tail(t, nu))
    }
}

/// `None` when no block's errors are known.
pub(super) fn test(pair: &Pair<'_>, block: usize) -> Option<ChannelTests> {
    let height = pair.a.len() / pair.width.max(1);
    let mut all = Sums::default();
    let mut blocks = Vec::new();
    for y in (0..height).step_by(block) {
        for x in (0..pair.width).step_by(block) {
            let mut sums = Sums::default();
            for row in y..(y + block).min(height) {
                (x..(x + block).min(pair.width)).for_each(|column| sums.add(pair, row * pair.width + column));
            }
            if sums.pixels > 0 && !sums.unknown {
                all.join(&sums);
                blocks.push(([x, y], sums.t()));
            }
        }
    }
    let &(worst_at, (worst_t, least_p)) = blocks.iter().max_by(|a, b| a.1.0.abs().total_cmp(&b.1.0.abs()))?;
    let squares: f64 = blocks.iter().map(|(_, (t, _))| t * t).sum();
    let (t, p) = all.t();
    Some(ChannelTests {
        t,
        p,
        blocks: blocks.len(),
        worst_t,
        worst_at,
        worst_p: sidak(least_p, blocks.len()),
        rms_t: (squares / blocks.len() as f64).sqrt(),
        rejected: false,
    })
}

/// Probability that the least of `n` independent p-values is at most `p`: `1 - (1 - p)^n`, without cancellation.
fn sidak(p: f64, n: usize) -> f64 {
    if p >= 1.0 { 1.0 } else { -(n as f64 * (-p).ln_1p()).exp_m1() }
}

/// Holm's step-down procedure over two tests a channel.
pub(super) fn holm(channels: &mut [ChannelDiff], alpha: f64) {
    let mut tests: Vec<(f64, usize)> = channels
        .iter()
        .enumerate()
        .filter_map(|(i, c)| c.tests.as_ref().map(|t| [(t.p, i), (t.worst_p, i)]))
        .flatten()
        .collect();
    tests.sort_by(|a, b| a.0.total_cmp(&b.0));
    let count = tests.len();
    for (rank, (p, i)) in tests.into_iter().enumerate() {
        if p > alpha / (count - rank) as f64 {
            return;
        }
        if let Some(t) = &mut channels[i].tests {
            t.rejected = true;
        }
    }
}
