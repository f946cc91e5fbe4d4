//! Means over all pixels and the covariances of the channels, which share their paths.

use super::PixelStats;
use crate::fixed;
use crate::{ErrorMode, Film};

/// Means over the window of the channels that have errors, with the covariance matrix of these means.
///
/// With replicates only: `cov(a, b) = sum_p B/(B-1) sum_r (R_ra - m_a W_r)(R_rb - m_b W_r) / W^2 / n^2` over `n` pixels
/// whose replicates are independent of each other; its diagonal holds the squares of [`crate::Developed`]'s errors.
#[derive(Clone, Debug, PartialEq)]
pub struct Pooled {
    /// Means of the channels.
    pub mean: Vec<f64>,
    /// Covariances of the means, row by row; infinite when unknown.
    pub covariance: Vec<f64>,
    /// Degrees of freedom.
    pub dof: u32,
}

impl Pooled {
    /// Covariance of the means of two channels.
    pub fn covariance(&self, a: usize, b: usize) -> f64 {
        self.covariance[a * self.mean.len() + b]
    }

    /// Standard error of the mean of a channel.
    pub fn se(&self, channel: usize) -> f64 {
        self.covariance(channel, channel).sqrt()
    }
}

impl Film {
    /// Means over all pixels with their covariances; infinite ones without replicates.
    pub fn pooled(&self) -> Pooled {
        let channels = self.planes.layout.with_errors;
        let pixels = self.planes.largest.len();
        let mut stats = PixelStats::new(self.spec(), &self.planes, true);
        let mut out =
            Pooled { mean: vec![0.0; channels], covariance: vec![0.0; channels * channels], dof: 0 };
        let replicated = matches!(self.spec().mode, ErrorMode::Replicated { .. });
        for pixel in 0..pixels {
            stats.load(pixel);
            out.mean.iter_mut().zip(&stats.mean).for_each(|(sum, m)| *sum += m / pixels as f64);
            if stats.dof == 0 || !replicated {
                out.covariance.fill(f64::INFINITY);
                continue;
            }
            out.dof += stats.dof;
            self.add_covariance(pixel, &stats, 1.0 / (pixels as f64).powi(2), &mut out.covariance);
        }
        out
    }

    fn add_covariance(&self, pixel: usize, stats: &PixelStats<'_>, scale: f64, to: &mut [f64]) {
        let slots = 0..self.planes.layout.slots;
        let filled: Vec<usize> = slots.filter(|&s| self.planes.slot_counts(pixel)[s] > 0).collect();
        let weights: Vec<f64> = filled.iter().map(|&s| self.planes.weight(pixel, s)).collect();
        let (b, total) = (filled.len() as f64, weights.iter().sum::<f64>());
        let scale = scale * b / (b - 1.0) / (total * total);
        let channels = self.planes.layout.with_errors;
        let mut residual = vec![0.0; channels];
        for (&slot, w) in filled.iter().zip(weights) {
            let sums = self.planes.slot_sums(pixel, slot);
            for c in 0..channels {
                residual[c] = fixed::to_f64(sums[c]) - stats.mean[c] * w;
            }
            for (i, cell) in to.iter_mut().enumerate() {
                *cell += scale * residual[i / channels] * residual[i % channels];
            }
        }
    }
}
