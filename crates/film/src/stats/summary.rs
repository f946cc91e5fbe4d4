//! One number for the error of an image.

use crate::ErrorMode;

/// Summary of the relative standard errors of Y: `SE_Y / max(Y, a hundredth of the median Y)` over the pixels.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct ErrorSummary {
    /// How errors were estimated.
    pub mode: ErrorMode,
    /// Median over pixels; infinite while most errors are unknown.
    pub median_rel_se_y: f64,
    /// The worst pixel's.
    pub max_rel_se_y: f64,
    /// 95 % of the pixels have at most this one: `rel=1%` is met when it is 0.01 or less.
    pub p95_rel_se_y: f64,
    /// Pixels in which one sample carries half of the variance of Y or more.
    pub flagged: u64,
    /// Pixels whose errors were pooled over their tile because they have fewer than two samples a replicate.
    pub pooled: u64,
    /// Pixels whose error is unknown: fewer than two samples, or weights that cancel.
    pub unknown: u64,
    /// All pixels.
    pub pixels: u64,
}

/// A hundredth of the median: below it, errors count as relative to it.
pub(crate) fn floor_of(y: &[f64]) -> f64 {
    let mut y = y.to_vec();
    (quantile(&mut y, 0.5) * 0.01).max(0.0)
}

/// The rule by which an error becomes relative.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Relative {
    pub floor: f64,
}

impl Relative {
    /// `se / max(y, floor)`, 0 where there is no error.
    pub fn of(self, y: f64, se: f64) -> f64 {
        if se == 0.0 { 0.0 } else { se / y.abs().max(self.floor) }
    }
}

impl ErrorSummary {
    pub(crate) fn new(mode: ErrorMode, y: &[f64], se: &[f64]) -> Self {
        let rule = Relative { floor: floor_of(y) };
        let mut rel: Vec<f64> = y.iter().zip(se).map(|(&y, &se)| rule.of(y, se)).collect();
        Self {
            mode,
            median_rel_se_y: quantile(&mut rel, 0.5),
            max_rel_se_y: rel.iter().copied().fold(0.0, f64::max),
            p95_rel_se_y: quantile(&mut rel, 0.95),
            flagged: 0,
            pooled: 0,
            unknown: se.iter().filter(|s| s.is_infinite()).count() as u64,
            pixels: y.len() as u64,
        }
    }
}

/// The least value that at least a fraction `q` of the values do not exceed.
fn quantile(v: &mut [f64], q: f64) -> f64 {
    if v.is_empty() {
        return 0.0;
    }
    let rank = (q * v.len() as f64).ceil().clamp(1.0, v.len() as f64) as usize - 1;
    *v.select_nth_unstable_by(rank, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_count_from_below() {
        let mut v: Vec<f64> = (1..=100).rev().map(f64::from).collect();
        assert_eq!(quantile(&mut v, 0.5), 50.0);
        assert_eq!(quantile(&mut v, 0.95), 95.0);
        assert_eq!(quantile(&mut [7.0], 0.95), 7.0);
    }

    #[test]
    fn dark_pixels_count_relative_to_a_hundredth_of_the_median() {
        let mut y = vec![1.0; 99];
        y.push(1e-6);
        let mut se = vec![0.001; 99];
        se.push(0.002);
        let s = ErrorSummary::new(ErrorMode::Conservative, &y, &se);
        assert_eq!(s.median_rel_se_y, 0.001);
        assert!((s.max_rel_se_y - 0.2).abs() < 1e-12);
    }

    #[test]
    fn a_black_image_has_no_error() {
        let s = ErrorSummary::new(ErrorMode::Conservative, &[0.0; 9], &[0.0; 9]);
        assert_eq!((s.median_rel_se_y, s.max_rel_se_y, s.p95_rel_se_y), (0.0, 0.0, 0.0));
    }
}
