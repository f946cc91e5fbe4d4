//! The fixed schedule: rounds of sample indices, cut into units of tiles and sample ranges.
//!
//! Rounds begin at samples 0, 4, 8, 16, 32, 64, then every 64, and from 512 on eight times per doubling. They depend on
//! nothing else, so that a run that stops after a round has the bits of a run with that many samples per pixel. How a round
//! is cut into units depends on the film's size only, not on the machine.

use std::ops::Range;

use tyndall_film::{FilmSpec, Guide, PixelBounds, WorkUnit};

use crate::Shard;

/// Side of a tile \[pixels\].
pub const TILE: u32 = 16;
/// Most samples per pixel.
pub const MAX_SPP: u32 = 1 << 30;
/// Samples of all pixels that make a unit large enough to be worth its delivery.
const UNIT_SAMPLES: u64 = 4096;
/// A round is cut into about so many units at most, for they are all kept in memory.
const UNITS: u64 = 1 << 18;
/// Samples of the first round.
const FIRST: u32 = 4;
/// Length up to which rounds double.
const STEADY: u32 = 64;

/// How rounds are cut into units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Schedule {
    window: PixelBounds,
    unit_samples: u64,
}

impl Schedule {
    /// The schedule of a film.
    pub fn new(film: &FilmSpec) -> Self {
        // adding a patch costs time in proportion to its bytes: let larger pixels take more samples
        let weight = (film.bytes_per_pixel() / 512).clamp(1, 16);
        Self { window: film.bounds, unit_samples: UNIT_SAMPLES * weight }
    }

    /// The units of a round that has something to do, in row-major order of tiles.
    pub fn units(&self, round: u32, samples: &Range<u32>, guide: &Guide) -> Vec<WorkUnit> {
        let mut units = Vec::new();
        let tiles =
            u64::from(self.window.width().div_ceil(TILE)) * u64::from(self.window.height().div_ceil(TILE));
        for window in self.window.tiles(TILE) {
            let (active, span) = active(&window, samples, guide);
            if active == 0 {
                continue;
            }
            let least = span.len() as u64 * tiles / UNITS;
            let chunk = (self.unit_samples / active).max(least).clamp(1, u64::from(u32::MAX)) as usize;
            for start in span.clone().step_by(chunk) {
                let end = start.saturating_add(chunk as u32).min(span.end);
                units.push(WorkUnit { window, samples: start..end, round });
            }
        }
        units
    }
}

/// Pixels of a window that take samples in the range, and the part of the range they take.
fn active(window: &PixelBounds, samples: &Range<u32>, guide: &Guide) -> (u64, Range<u32>) {
    if guide.counts.is_none() {
        return (window.area(), samples.clone());
    }
    let (mut n, mut low, mut high) = (0, u32::MAX, 0);
    for (x, y) in window.pixels() {
        let r = guide.samples_for(x, y, samples);
        if !r.is_empty() {
            n += 1;
            low = low.min(r.start);
            high = high.max(r.end);
        }
    }
    if n == 0 { (0, 0..0) } else { (n, low..high) }
}

/// The rounds of a range of sample indices, each cut to the range.
pub fn rounds(samples: Range<u32>) -> impl Iterator<Item = Range<u32>> {
    std::iter::successors(Some(round_at(samples.start)), |r| Some(round_at(r.end)))
        .take_while({
            let end = samples.end;
            move |r| r.start < end
        })
        .map(move |r| r.start.max(samples.start)..r.end.min(samples.end))
        .filter(|r| !r.is_empty())
}

/// The round that holds a sample index.
fn round_at(sample: u32) -> Range<u32> {
    if sample < FIRST {
        return 0..FIRST;
    }
    let octave = 1 << sample.ilog2();
    let length = if octave < STEADY { octave } else { (octave / 8).max(STEADY) };
    let start = sample - sample % length;
    start..start + length
}

/// Number of samples over all pixels of a range.
pub fn cost(window: &PixelBounds, samples: &Range<u32>, guide: &Guide) -> u64 {
    match &guide.counts {
        None => window.area() * u64::from(samples.end.saturating_sub(samples.start)),
        Some(_) => window.pixels().map(|(x, y)| guide.samples_for(x, y, samples).len() as u64).sum(),
    }
}

/// The sample indices of a shard: parts of equal cost, in order.
pub fn split(guide: &Guide, samples: Range<u32>, shard: Shard) -> Range<u32> {
    let cut = |k: u32| match &guide.counts {
        None => {
            let length = u64::from(samples.end - samples.start);
            samples.start + (length * u64::from(k) / u64::from(shard.count)) as u32
        }
        Some(c) => {
            let total = cost(&c.bounds(), &samples, guide);
            let goal = u128::from(total) * u128::from(k) / u128::from(shard.count);
            bisect(&samples, |end| u128::from(cost(&c.bounds(), &(samples.start..end), guide)) >= goal)
        }
    };
    let start = if shard.index <= 1 { samples.start } else { cut(shard.index - 1) };
    let end = if shard.index >= shard.count { samples.end } else { cut(shard.index) };
    start..end.max(start)
}

/// The least `end` in the range for which the monotone condition holds.
fn bisect(range: &Range<u32>, holds: impl Fn(u32) -> bool) -> u32 {
    let (mut low, mut high) = (range.start, range.end);
    while low < high {
        let mid = low + (high - low) / 2;
        if holds(mid) {
            high = mid;
        } else {
            low = mid + 1;
        }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_film::{ErrorMode, SampleCounts};

    fn guide(bounds: PixelBounds) -> Guide {
        let end = (0..bounds.area() as u32).map(|p| 16 + (p * 37) % 900).collect();
        Guide::with_counts(SampleCounts::new(bounds, vec![16; bounds.area() as usize], end).unwrap())
    }

    #[test]
    fn rounds_cover_each_sample_once_and_do_not_depend_on_the_end() {
        let all: Vec<_> = rounds(0..100_000).collect();
        assert_eq!(all[..7], [0..4, 4..8, 8..16, 16..32, 32..64, 64..128, 128..192]);
        assert!(all.windows(2).all(|w| w[0].end == w[1].start));
        assert!(all.len() < 90, "{}", all.len());
        for end in [1, 4, 5, 63, 64, 65, 700, 99_999] {
            let part: Vec<_> = rounds(0..end).collect();
            assert_eq!(part.last().unwrap().end, end);
            let same = part.len() - 1;
            assert_eq!(part[..same], all[..same]);
        }
        let middle: Vec<_> = rounds(5..70).collect();
        assert_eq!(middle, [5..8, 8..16, 16..32, 32..64, 64..70]);
        assert_eq!(rounds(7..7).count(), 0);
        assert_eq!(rounds(0..MAX_SPP).last().unwrap().end, MAX_SPP);
    }

    #[test]
    fn units_cover_each_sample_of_each_pixel_once() {
        let spec = FilmSpec {
            bounds: PixelBounds::new(3, 2, 50, 40),
            ..FilmSpec::xyz([64, 64], ErrorMode::REPLICATED)
        };
        let schedule = Schedule::new(&spec);
        for guide in [Guide::default(), guide(spec.bounds)] {
            let mut seen = vec![0u32; spec.bounds.area() as usize];
            for (r, samples) in rounds(0..916).enumerate() {
                for unit in schedule.units(r as u32, &samples, &guide) {
                    assert!(samples.start <= unit.samples.start && unit.samples.end <= samples.end);
                    for (x, y) in unit.window.pixels() {
                        seen[spec.bounds.index(x, y)] += guide.samples_for(x, y, &unit.samples).len() as u32;
                    }
                }
            }
            for (x, y) in spec.bounds.pixels() {
                let expected = guide.samples_for(x, y, &(0..916)).len() as u32;
                assert_eq!(seen[spec.bounds.index(x, y)], expected);
            }
        }
    }

    #[test]
    fn the_longest_rounds_have_no_more_units_than_memory_holds() {
        let schedule = Schedule::new(&FilmSpec::xyz([512, 512], ErrorMode::Conservative));
        let last = rounds(0..MAX_SPP).last().unwrap();
        let units = schedule.units(0, &last, &Guide::default());
        assert!(units.len() as u64 <= UNITS, "{}", units.len());
        let samples: u64 = units.iter().map(|u| u.window.area() * u.samples.len() as u64).sum();
        assert_eq!(samples, 512 * 512 * last.len() as u64);
    }

    #[test]
    fn shards_part_the_samples_at_equal_cost() {
        let b = PixelBounds::new(0, 0, 40, 30);
        for guide in [Guide::default(), guide(b)] {
            let all = guide.counts.as_ref().map_or(0..1000, |c| c.span(&b));
            for count in [1, 2, 3, 7] {
                let mut at = all.start;
                let total = cost(&b, &all, &guide) as f64;
                for index in 1..=count {
                    let part = split(&guide, all.clone(), Shard { index, count });
                    assert_eq!(part.start, at);
                    at = part.end;
                    let share = cost(&b, &part, &guide) as f64 / total * f64::from(count);
                    assert!((share - 1.0).abs() < 0.05, "{share}");
                }
                assert_eq!(at, all.end);
            }
        }
    }
}
