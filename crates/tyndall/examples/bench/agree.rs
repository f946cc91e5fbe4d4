//! Whether two renderers converge to the same picture: means, and scores of blocks of 8 x 8 pixels.

use crate::efficiency::{Measurement, mean_and_variance};
use serde_json::{Value, json};

/// Pixels along each side of a block.
const BLOCK: usize = 8;
/// Fewer pictures than this leave errors too uncertain for a verdict.
const LEAST_SEEDS: usize = 4;
/// Scores of the whole frame beyond this are a difference.
const WHOLE_LIMIT: f64 = 4.0;

/// How two renderers' pictures of a scene compare.
#[derive(Clone, Copy, Debug)]
pub struct Agreement {
    /// Mean of Y of the one over that of the other.
    pub ratio: f64,
    /// Its standard error.
    pub ratio_se: f64,
    /// Mean square of the blocks' scores over what Student's t gives: 1 when only noise differs.
    pub blocks: f64,
    /// Its standard deviation when only noise differs.
    pub blocks_sd: f64,
    /// Whether both are as noise would have them; `None` when the pictures are too few to tell.
    pub same: Option<bool>,
}

/// Compares two renderers; `None` when the pictures differ in size.
pub fn compare(a: &Measurement, b: &Measurement) -> Option<Agreement> {
    if a.width != b.width || a.height() != b.height() {
        return None;
    }
    let ((x, vx), (y, vy)) = (mean_and_variance(&whole(a)), mean_and_variance(&whole(b)));
    let ratio = x / y;
    let ratio_se = ratio.abs() * (vx / (x * x) + vy / (y * y)).sqrt();
    let scores: Vec<(f64, f64)> = blocks(a).iter().zip(blocks(b)).map(|(x, y)| score(x, &y)).collect();
    let n = scores.len() as f64;
    let square = |df: f64| df / (df - 2.0);
    let expected = scores.iter().map(|s| square(s.1)).sum::<f64>() / n;
    let mean_square = scores.iter().map(|s| s.0 * s.0).sum::<f64>() / n;
    // E[t^4] = 3 df^2 / ((df - 2) (df - 4))
    let fourth = |df: f64| 3.0 * df * df / ((df - 2.0) * (df - 4.0));
    let variance = scores.iter().map(|s| fourth(s.1) - square(s.1).powi(2)).sum::<f64>() / (n * n);
    let (blocks, blocks_sd) = (mean_square / expected, variance.sqrt() / expected);
    let enough = a.pictures.len().min(b.pictures.len()) >= LEAST_SEEDS;
    let same = (ratio - 1.0).abs() <= WHOLE_LIMIT * ratio_se && blocks - 1.0 <= WHOLE_LIMIT * blocks_sd;
    Some(Agreement { ratio, ratio_se, blocks, blocks_sd, same: enough.then_some(same) })
}

/// Mean of each picture.
fn whole(m: &Measurement) -> Vec<f64> {
    m.pictures.iter().map(|p| p.iter().sum::<f64>() / p.len() as f64).collect()
}

/// Means of every block: one list of seeds for each.
fn blocks(m: &Measurement) -> Vec<Vec<f64>> {
    let (columns, rows) = (m.width / BLOCK, m.height() / BLOCK);
    let mean = |p: &[f64], i: usize| {
        let (x0, y0) = (i % columns * BLOCK, i / columns * BLOCK);
        let row = |y: usize| p[y * m.width + x0..y * m.width + x0 + BLOCK].iter().sum::<f64>();
        (y0..y0 + BLOCK).map(row).sum::<f64>() / (BLOCK * BLOCK) as f64
    };
    (0..columns * rows).map(|i| m.pictures.iter().map(|p| mean(p, i)).collect()).collect()
}

/// Welch's t and its degrees of freedom, at least 5 so that its moments exist.
fn score(a: &[f64], b: &[f64]) -> (f64, f64) {
    let ((x, vx), (y, vy)) = (mean_and_variance(a), mean_and_variance(b));
    let (n, m) = (a.len() as f64 - 1.0, b.len() as f64 - 1.0);
    let all = vx + vy;
    if all <= 0.0 {
        // without noise on either side blocks differ or they do not
        return (if x == y { 0.0 } else { f64::INFINITY }, n + m);
    }
    ((x - y) / all.sqrt(), (all * all / (vx * vx / n + vy * vy / m)).max(5.0))
}

impl Agreement {
    /// As the report's JSON has it.
    pub fn json(&self) -> Value {
        json!({
            "ratio_of_means": self.ratio, "ratio_se": self.ratio_se, "blocks_mean_square": self.blocks,
            "blocks_sd": self.blocks_sd, "same": self.same,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall::base::hash;

    fn noise(key: u32, factor: f64, corner: f64) -> Measurement {
        let value = |seed: u32, i: u32| {
            let u = f64::from(hash::to_unit_f32(hash::hash3(key, seed, i)));
            let lift = if i % 64 < 16 && i / 64 < 16 { corner } else { 1.0 };
            factor * lift * (0.9 + 0.2 * u)
        };
        let pictures = (0..8).map(|s| (0..4096).map(|i| value(s, i)).collect()).collect();
        Measurement { pictures, seconds: vec![1.0; 8], width: 64, spp: 1.0 }
    }

    #[test]
    fn noise_is_the_same_and_a_difference_is_not() {
        let a = noise(1, 1.0, 1.0);
        let same = compare(&a, &noise(2, 1.0, 1.0)).expect("sizes agree");
        assert_eq!(same.same, Some(true), "{same:?}");
        let brighter = compare(&a, &noise(2, 1.01, 1.0)).expect("sizes agree");
        assert_eq!(brighter.same, Some(false), "{brighter:?}");
        // one sixteenth of the blocks brighter by 2 %, the rest darker so that the means agree
        let lifted = compare(&a, &noise(2, 1.0 / (1.0 + 0.02 / 16.0), 1.02)).expect("sizes agree");
        assert!((lifted.ratio - 1.0).abs() < 4.0 * lifted.ratio_se, "{lifted:?}");
        assert_eq!(lifted.same, Some(false), "{lifted:?}");
    }
}
