//! What the spread of pictures over seeds, and the clock, say of a renderer.

use crate::mask::Mask;
use serde_json::{Value, json};

/// Pictures of luminance Y, one per seed, with their times.
#[derive(Clone, Debug, Default)]
pub struct Measurement {
    /// Luminances, row by row.
    pub pictures: Vec<Vec<f64>>,
    /// User CPU seconds of each.
    pub seconds: Vec<f64>,
    /// Pixels of a row.
    pub width: usize,
    /// Samples per pixel.
    pub spp: f64,
}

/// What a renderer achieves.
#[derive(Clone, Copy, Debug)]
pub struct Efficiency {
    /// `1 / (MSE_Y x CPU seconds)` without the pixels of the mask.
    pub headline: f64,
    /// Its standard error over seeds.
    pub headline_se: f64,
    /// The same of all pixels.
    pub whole: f64,
    /// Its standard error over seeds.
    pub whole_se: f64,
    /// Mean squared error of Y without the pixels of the mask.
    pub mse: f64,
    /// Mean over all pixels of the squared error over the squared reference.
    pub relative_mse: f64,
    /// CPU seconds of a picture, the median over seeds.
    pub seconds: f64,
    /// Samples per CPU second.
    pub samples_per_second: f64,
    /// Mean of Y over all pixels and seeds.
    pub mean_y: f64,
    /// Its standard error over seeds.
    pub mean_y_se: f64,
}

/// The median; NaN of nothing.
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len();
    if n == 0 { f64::NAN } else { 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]) }
}

/// Mean and the squared standard error of the mean.
pub fn mean_and_variance(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let spread: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
    (mean, spread / (n * (n - 1.0)))
}

impl Measurement {
    /// Pixels of a column.
    pub fn height(&self) -> usize {
        self.pictures.first().map_or(0, |p| p.len() / self.width.max(1))
    }

    /// The mean over seeds, pixel by pixel.
    pub fn mean_picture(&self) -> Vec<f64> {
        let n = self.pictures.len() as f64;
        (0..self.pictures[0].len()).map(|i| self.pictures.iter().map(|p| p[i]).sum::<f64>() / n).collect()
    }

    /// The efficiency with its error from leaving out one seed at a time (jackknife); `reference` is what squared
    /// errors are divided by.
    pub fn efficiency(&self, mask: &Mask, reference: &[f64]) -> Efficiency {
        let seconds = self.median_seconds(None);
        let headline = |out| 1.0 / (self.mse(out, Some(mask)) * self.median_seconds(out));
        let whole = |out| 1.0 / (self.mse(out, None) * self.median_seconds(out));
        let means: Vec<f64> = self.pictures.iter().map(|p| p.iter().sum::<f64>() / p.len() as f64).collect();
        let (mean_y, variance) = mean_and_variance(&means);
        let samples = self.pictures[0].len() as f64 * self.spp;
        Efficiency {
            headline: headline(None),
            headline_se: self.jackknife(headline),
            whole: whole(None),
            whole_se: self.jackknife(whole),
            mse: self.mse(None, Some(mask)),
            relative_mse: self.relative_mse(reference),
            seconds,
            samples_per_second: samples / seconds,
            mean_y,
            mean_y_se: variance.sqrt(),
        }
    }

    fn jackknife(&self, value: impl Fn(Option<usize>) -> f64) -> f64 {
        let n = self.pictures.len() as f64;
        let without: Vec<f64> = (0..self.pictures.len()).map(|i| value(Some(i))).collect();
        let (_, variance) = mean_and_variance(&without);
        // two pictures cannot be left one out: nothing is left to tell the spread from
        if n < 3.0 { f64::NAN } else { (variance * (n - 1.0).powi(2)).sqrt() }
    }

    fn median_seconds(&self, left_out: Option<usize>) -> f64 {
        let kept: Vec<f64> =
            self.seconds.iter().enumerate().filter(|(i, _)| Some(*i) != left_out).map(|(_, &s)| s).collect();
        median(&kept)
    }

    /// Variance over seeds of a pixel.
    fn variance(&self, pixel: usize, left_out: Option<usize>) -> f64 {
        let kept =
            || self.pictures.iter().enumerate().filter(|(i, _)| Some(*i) != left_out).map(|(_, p)| p[pixel]);
        let n = kept().count() as f64;
        let mean = kept().sum::<f64>() / n;
        kept().map(|y| (y - mean).powi(2)).sum::<f64>() / (n - 1.0)
    }

    /// Mean over pixels of the variance over seeds.
    fn mse(&self, left_out: Option<usize>, mask: Option<&Mask>) -> f64 {
        let seen = (0..self.pictures[0].len()).filter(|&i| mask.is_none_or(|m| !m.hides(i)));
        let (sum, pixels) = seen.fold((0.0, 0.0), |(sum, n), i| (sum + self.variance(i, left_out), n + 1.0));
        sum / pixels
    }

    /// Mean over pixels of `Var Y / max(Y, mean Y / 100)^2` with Y of the reference.
    fn relative_mse(&self, reference: &[f64]) -> f64 {
        let floor = 0.01 * reference.iter().sum::<f64>() / reference.len() as f64;
        let one = |i: usize| self.variance(i, None) / reference[i].max(floor).powi(2);
        (0..reference.len()).map(one).sum::<f64>() / reference.len() as f64
    }
}

impl Efficiency {
    /// As the report's JSON has it.
    pub fn json(&self) -> Value {
        json!({
            "headline": self.headline, "headline_se": self.headline_se, "whole": self.whole,
            "whole_se": self.whole_se, "mse_y_headline": self.mse, "relative_mse": self.relative_mse,
            "cpu_seconds": self.seconds, "samples_per_second": self.samples_per_second, "mean_y": self.mean_y,
            "mean_y_se": self.mean_y_se,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall::base::hash;

    /// Pictures of 2000 pixels with variance 1/12 about 1, but for the first, which is hidden and wild.
    fn pictures(seeds: u32) -> Measurement {
        let value = |seed: u32, i: u32| {
            let u = f64::from(hash::to_unit_f32(hash::hash3(1, seed, i)));
            if i == 0 { 1000.0 * u } else { 0.5 + u }
        };
        Measurement {
            pictures: (0..seeds).map(|s| (0..2000).map(|i| value(s, i)).collect()).collect(),
            seconds: (0..seeds).map(|s| if s == 0 { 90.0 } else { 2.0 }).collect(),
            width: 50,
            spp: 16.0,
        }
    }

    #[test]
    fn uniform_numbers_have_their_variance_and_the_median_ignores_a_slow_run() {
        let m = pictures(8);
        let mut hidden = vec![false; 2000];
        hidden[0] = true;
        let e = m.efficiency(&Mask::of(hidden), &vec![1.0; 2000]);
        // the variance of 8 x 2000 uniform numbers is known to 0.9 % of its value (kurtosis 1.8): five of these
        assert!((e.mse * 12.0 - 1.0).abs() < 0.05, "{}", e.mse);
        assert_eq!(e.seconds, 2.0);
        assert!((e.headline * e.mse * 2.0 - 1.0).abs() < 1e-12);
        assert!(e.headline_se > 0.0 && e.headline_se < 0.05 * e.headline, "{}", e.headline_se);
        assert!(e.whole < e.headline);
        assert_eq!(e.samples_per_second, 16_000.0);
    }

    #[test]
    fn medians() {
        assert_eq!([median(&[3.0, 1.0, 2.0]), median(&[4.0, 1.0, 2.0, 3.0])], [2.0, 2.5]);
        assert!(median(&[]).is_nan());
    }
}
