//! Standard errors of a pixel, t intervals, summaries.
//!
//! With weights `w_i` in {1, -1} and values `v_i`, a pixel is `m = sum(w v) / W`, `W = sum(w)`. Its variance by
//! linearisation of the ratio (Cochran, *Sampling Techniques*, 3rd ed. 1977, sec. 2.11 and 6.4):
//!
//! - conservative: `n/(n-1) sum (w_i v_i - m w_i)^2 / W^2`, which is the plain variance of the mean for unit weights;
//! - replicated, over the B replicates that hold samples: `B/(B-1) sum (R_b - m W_b)^2 / W^2`.

use crate::fixed;
use crate::planes::Planes;
use crate::spec::Layout;
use crate::{ErrorMode, FilmSpec};

mod pooled;
pub mod squares;
mod student;
mod summary;

pub use pooled::Pooled;
pub use squares::{Squares, SumError};
pub use student::{t_quantile, t_tail};
pub use summary::ErrorSummary;

/// One pixel's means, variances of the means, and luminance.
pub(crate) struct PixelStats<'f> {
    planes: &'f Planes,
    luminance: Vec<f64>,
    replicated: bool,
    /// Means of all channels.
    pub mean: Vec<f64>,
    /// Variances of the means of the channels with errors; infinite when unknown.
    pub variance: Vec<f64>,
    /// Mean of Y.
    pub y: f64,
    /// Variance of the mean of Y.
    pub y_variance: f64,
    /// Degrees of freedom of the variances.
    pub dof: u32,
    /// Samples.
    pub n: u32,
}

impl<'f> PixelStats<'f> {
    /// With the variances of all channels, or of Y alone.
    pub fn new(spec: &FilmSpec, planes: &'f Planes, channels: bool) -> Self {
        Self {
            planes,
            luminance: spec.luminance.iter().map(|&w| f64::from(w)).collect(),
            replicated: matches!(spec.mode, ErrorMode::Replicated { .. }),
            mean: vec![0.0; planes.layout.channels],
            variance: vec![f64::INFINITY; if channels { planes.layout.with_errors } else { 0 }],
            y: 0.0,
            y_variance: f64::INFINITY,
            dof: 0,
            n: 0,
        }
    }

    /// Computes the statistics of a pixel.
    pub fn load(&mut self, pixel: usize) {
        self.n = self.planes.count(pixel);
        self.dof = 0;
        let weight = self.total_weight(pixel);
        self.variance.fill(f64::INFINITY);
        self.y_variance = f64::INFINITY;
        if weight == 0.0 {
            self.mean.fill(0.0);
            self.y = 0.0;
            return;
        }
        self.load_means(pixel, weight);
        if self.replicated {
            self.load_replicated(pixel, weight);
        } else {
            self.load_conservative(pixel, weight);
        }
    }

    fn total_weight(&self, pixel: usize) -> f64 {
        (0..self.planes.layout.slots).map(|s| self.planes.weight(pixel, s)).sum()
    }

    fn load_means(&mut self, pixel: usize, weight: f64) {
        let Layout { with_errors, slots, .. } = self.planes.layout;
        for c in 0..with_errors {
            let mut sum = 0;
            (0..slots).for_each(|s| fixed::merge(&mut sum, self.planes.slot_sums(pixel, s)[c]));
            self.mean[c] = fixed::to_f64(sum) / weight;
        }
        for (mean, &sum) in self.mean[with_errors..].iter_mut().zip(self.planes.mean_sums(pixel)) {
            *mean = fixed::to_f64(sum) / weight;
        }
        self.y = dot(&self.luminance, &self.mean);
    }

    fn load_conservative(&mut self, pixel: usize, weight: f64) {
        if self.n < 2 {
            return;
        }
        let n = f64::from(self.n);
        let squares = self.planes.pixel_squares(pixel);
        let plain = |c: usize| match self.planes.pixel_cross(pixel) {
            [] => fixed::to_f64(self.planes.slot_sums(pixel, 0)[c]),
            cross => fixed::to_f64(cross[c]),
        };
        // sum (w v - m w)^2 = sum v^2 - 2 m sum v + n m^2, because w^2 = 1
        let variance = |square: f64, plain: f64, m: f64| {
            let residual = square - 2.0 * m * plain + n * m * m;
            if residual > 0.0 { n / (n - 1.0) * residual / (weight * weight) } else { 0.0 }
        };
        for c in 0..self.variance.len() {
            self.variance[c] = variance(fixed::square_to_f64(squares[c]), plain(c), self.mean[c]);
        }
        let plain_y = self.luminance.iter().enumerate().map(|(c, w)| w * plain(c)).sum();
        let square_y = fixed::square_to_f64(squares[self.planes.layout.with_errors]);
        self.y_variance = variance(square_y, plain_y, self.y);
        self.dof = self.n - 1;
    }

    fn load_replicated(&mut self, pixel: usize, weight: f64) {
        let filled = self.planes.slot_counts(pixel).iter().filter(|&&n| n > 0).count();
        if filled < 2 {
            return;
        }
        self.variance.fill(0.0);
        self.y_variance = 0.0;
        for slot in (0..self.planes.layout.slots).filter(|&s| self.planes.slot_counts(pixel)[s] > 0) {
            let w = self.planes.weight(pixel, slot);
            let sums = self.planes.slot_sums(pixel, slot);
            let mut luma = 0.0;
            for c in 0..self.variance.len().max(self.luminance.len()) {
                let residual = fixed::to_f64(sums[c]) - self.mean[c] * w;
                if let Some(v) = self.variance.get_mut(c) {
                    *v += residual * residual;
                }
                luma += self.luminance.get(c).map_or(0.0, |weight| weight * residual);
            }
            self.y_variance += luma * luma;
        }
        let scale = filled as f64 / (filled as f64 - 1.0) / (weight * weight);
        self.variance.iter_mut().for_each(|v| *v *= scale);
        self.y_variance *= scale;
        self.dof = filled as u32 - 1;
    }

    /// True when one sample carries half of the variance of Y or more.
    pub fn dominated(&self, pixel: usize, y_variance: f64) -> bool {
        let largest = f64::from(f32::from_bits((self.planes.largest[pixel] >> 32) as u32));
        let shift = (largest - self.y.abs()) / f64::from(self.n.max(1));
        self.n >= 2 && shift > 0.0 && shift * shift >= 0.5 * y_variance && y_variance > 0.0
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}
