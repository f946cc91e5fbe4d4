//! Tests of a channel: blocks and the whole image by t, several tests by Sidak and Holm.

use super::{ChannelDiff, ChannelTests, channel::Pair};
use tyndall_film::{PixelBounds, SumError, stats::t_tail};

/// Sums over pixels that give a t.
#[derive(Clone, Copy, Debug)]
struct Sums {
    difference: f64,
    error: SumError,
    pixels: usize,
}

impl Sums {
    /// Over the pixels of an area that count and are finite.
    fn of(pair: &Pair<'_>, area: PixelBounds, counts: impl Fn(usize) -> bool) -> Self {
        let index = |(x, y)| y as usize * pair.width + x as usize;
        let members = area.pixels().map(index).filter(|&p| counts(p)).filter_map(|p| pair.at(p));
        let (difference, pixels) = members.fold((0.0, 0), |(sum, n), (a, b)| (sum + (a - b), n + 1));
        Self { difference, error: pair.error(area, |p| counts(p) && pair.at(p).is_some()), pixels }
    }

    /// Some pixels count, and all of their errors are known.
    fn is_known(&self) -> bool {
        self.pixels > 0 && self.error.variance.is_finite()
    }

    /// t and its two-sided probability.
    fn t(&self) -> (f64, f64) {
        if self.difference == 0.0 {
            return (0.0, 1.0);
        }
        if self.error.variance == 0.0 {
            return (f64::INFINITY.copysign(self.difference), 0.0);
        }
        let t = self.difference / self.error.variance.sqrt();
        (t, t_tail(t, self.error.dof().clamp(1.0, 1e6) as u32))
    }
}

/// `None` when no block's errors are known.
pub(super) fn test(pair: &Pair<'_>, block: usize) -> Option<ChannelTests> {
    let mut known = vec![false; pair.a.len()];
    let mut blocks = Vec::new();
    for area in pair.area().tiles(u32::try_from(block).unwrap_or(u32::MAX)) {
        let sums = Sums::of(pair, area, |_| true);
        if sums.is_known() {
            area.pixels().for_each(|(x, y)| known[y as usize * pair.width + x as usize] = true);
            blocks.push(([area.x0 as usize, area.y0 as usize], sums.t()));
        }
    }
    // not from the sums of the blocks, which are not independent where they cut squares
    let all = Sums::of(pair, pair.area(), |p| known[p]);
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
