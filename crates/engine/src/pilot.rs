//! Adaptive sampling in two stages (Stein 1945): a pilot fixes each pixel's count, the result holds later samples only.
//!
//! Because the counts depend on the pilot alone, and the pilot is left out of the result, value and interval are unbiased.
//! The target speaks of standard errors *as estimated*, with `B - 1` degrees of freedom; the counts are raised by
//! a factor, the 95 % point of the F distribution of two such estimates, so that one stage mostly suffices. Where it does
//! not, a further look adds samples to the pixels that miss the target; each look halves the probability of error that an
//! interval may spend ([`confidence`]).

use tyndall_film::{Developed, Film, Guide, PixelBounds, SampleCounts};

use crate::{Job, Quantity, Target};

/// Fraction of the pixels that must meet the target.
pub const FRACTION: f64 = 0.95;
/// Most looks at the errors.
pub const MAX_LOOKS: u32 = 6;
/// F(7, 63) at 95 %: eight replicates against nine pooled pixels of the pilot. Pixels that share paths know less than nine
/// that do not, and then a second look comes more often; what the target says of a pixel stays right.
const MARGIN: f64 = 2.16;
/// A look adds at most this many times what a pixel has.
const GROWTH: f64 = 4.0;

/// Confidence at which an interval after `looks` looks still errs in at most 5 % of all cases.
pub fn confidence(looks: u32) -> f64 {
    1.0 - 0.05 / f64::from(1u32 << looks.saturating_sub(1).min(30))
}

/// What a look at a film says.
#[derive(Clone, Debug)]
pub(crate) struct Look {
    /// Error over allowed error, per pixel; 1 or less meets the target.
    ratio: Vec<f64>,
    bounds: PixelBounds,
    samples: Vec<u32>,
}

impl Look {
    pub fn new(film: &Film, target: &Target) -> Self {
        let d = film.develop();
        let ratio = match target.quantity {
            Quantity::Luminance => ratios(&d.y, &d.y_error, target.rel),
            Quantity::Channels => worst_channel(&d, target.rel),
        };
        Self { ratio, bounds: d.bounds, samples: d.samples }
    }

    /// The ratio that decides: the 95 % point over the image, or the worst of the probes.
    pub fn deciding(&self, target: &Target) -> f64 {
        if !target.probes.is_empty() {
            let at = |&(x, y): &(u32, u32)| self.ratio[self.bounds.index(x, y)];
            return target.probes.iter().map(at).fold(0.0, f64::max);
        }
        let mut sorted = self.ratio.clone();
        let rank = (FRACTION * sorted.len() as f64).ceil() as usize - 1;
        *sorted.select_nth_unstable_by(rank, f64::total_cmp).1
    }

    /// Mean samples per pixel at which the target would be met if all pixels got the same.
    pub fn projected_spp(&self, target: &Target) -> Option<f64> {
        let mean = self.samples.iter().map(|&n| f64::from(n)).sum::<f64>() / self.samples.len() as f64;
        let ratio = self.deciding(target);
        (ratio.is_finite() && mean > 0.0).then_some(mean * ratio * ratio)
    }

    /// Counts of the first adaptive stage, from the pilot.
    pub fn first_counts(&self, job: &Job, target: &Target) -> Guide {
        let least = 2 * job.film.mode.slots();
        let n = f64::from(target.pilot);
        let end = self.smooth_squares().into_iter().enumerate().map(|(p, square)| {
            let wanted = if self.counts_for(p, target) { n * square * MARGIN } else { 0.0 };
            target.pilot + rounded(wanted, least, job.spp - target.pilot)
        });
        self.guide(vec![target.pilot; self.ratio.len()], end.collect())
    }

    /// Counts after a further look: only pixels that miss the target get more; `None` when none can.
    pub fn more_counts(&self, job: &Job, target: &Target, old: &Guide) -> Option<Guide> {
        let first = old.counts.as_ref()?.end().to_vec();
        let step = job.film.mode.slots();
        let end: Vec<u32> = first
            .iter()
            .enumerate()
            .map(|(p, &at)| {
                let ratio = self.ratio[p];
                if ratio <= 1.0 || !self.counts_for(p, target) {
                    return at;
                }
                let has = f64::from(self.samples[p].max(step));
                let more = (ratio * ratio * MARGIN.sqrt() - 1.0).min(GROWTH) * has;
                at + rounded(more, step, job.spp.saturating_sub(at)).min(job.spp.saturating_sub(at))
            })
            .collect();
        (end != first).then(|| self.guide(first, end))
    }

    fn guide(&self, first: Vec<u32>, end: Vec<u32>) -> Guide {
        let counts = SampleCounts::new(self.bounds, first, end).expect("one count per pixel, none shrinks");
        Guide::with_counts(counts)
    }

    fn counts_for(&self, pixel: usize, target: &Target) -> bool {
        let width = self.bounds.width() as usize;
        let (x, y) = (self.bounds.x0 + (pixel % width) as u32, self.bounds.y0 + (pixel / width) as u32);
        target.probes.is_empty() || target.probes.contains(&(x, y))
    }

    /// Squared ratios, averaged over 3 x 3 pixels: a pilot's variance of a single pixel is too noisy to plan by. A pixel
    /// never plans by less than half of its own.
    fn smooth_squares(&self) -> Vec<f64> {
        let (w, h) = (self.bounds.width() as usize, self.bounds.height() as usize);
        let square = |p: usize| self.ratio[p] * self.ratio[p];
        let mean_around = |p: usize| {
            let (x, y) = (p % w, p / w);
            let (mut sum, mut n) = (0.0, 0.0);
            for v in y.saturating_sub(1)..=(y + 1).min(h - 1) {
                for u in x.saturating_sub(1)..=(x + 1).min(w - 1) {
                    sum += square(v * w + u);
                    n += 1.0;
                }
            }
            (sum / n).max(0.5 * square(p))
        };
        (0..self.ratio.len()).map(mean_around).collect()
    }
}

/// `wanted` rounded up to a multiple of `step`, at least `step`, at most `limit` rounded down to a multiple.
fn rounded(wanted: f64, step: u32, limit: u32) -> u32 {
    let limit = (limit / step).max(1) * step;
    if wanted >= f64::from(limit) { limit } else { (wanted.max(1.0).ceil() as u32).next_multiple_of(step) }
}

/// Standard error over `rel max(value, a hundredth of the median)`.
fn ratios(value: &[f32], error: &[f32], rel: f64) -> Vec<f64> {
    let mut sorted = value.to_vec();
    let rank = (sorted.len() - 1) / 2;
    let floor = f64::from(*sorted.select_nth_unstable_by(rank, f32::total_cmp).1).max(0.0) * 0.01;
    let ratio = |(&v, &e): (&f32, &f32)| {
        if e == 0.0 { 0.0 } else { f64::from(e) / (rel * f64::from(v.abs()).max(floor)) }
    };
    value.iter().zip(error).map(ratio).collect()
}

fn worst_channel(d: &Developed, rel: f64) -> Vec<f64> {
    let mut worst = vec![0.0f64; d.y.len()];
    for (value, error) in d.mean.iter().zip(&d.error) {
        worst.iter_mut().zip(ratios(value, error, rel)).for_each(|(w, r)| *w = w.max(r));
    }
    worst
}
