//! Means over all pixels and the covariances of the channels, which share their paths.

use super::squares::SquareStats;
use crate::{ErrorMode, Film};

/// Means over the window of the channels that have errors, with the covariance matrix of these means.
///
/// With replicates only: `cov(a, b) = sum_Q B/(B-1) sum_r e_Qra e_Qrb / n^2` over the squares Q of the `n` pixels whose samples
/// share paths ([`crate::FilmSpec::square`]; single pixels where none do), `e_Qra = sum_{p in Q} (R_pra - m_pa W_pr) / W_p`.
/// Replicates of different squares are independent of each other. Where pixels are, the diagonal holds the squares of
/// [`crate::Developed`]'s errors.
#[derive(Clone, Debug, PartialEq)]
pub struct Pooled {
    /// Means of the channels.
    pub mean: Vec<f64>,
    /// Covariances of the means, row by row; infinite when unknown.
    pub covariance: Vec<f64>,
    /// Degrees of freedom: those of a square, `B - 1`, times the number of squares.
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
        let bounds = self.spec().bounds;
        let pixels = bounds.area() as f64;
        let replicated = matches!(self.spec().mode, ErrorMode::Replicated { .. });
        let mut stats = SquareStats::new(self);
        let mut out =
            Pooled { mean: vec![0.0; channels], covariance: vec![0.0; channels * channels], dof: 0 };
        for square in bounds.tiles(self.spec().square) {
            stats.load(square);
            out.mean.iter_mut().zip(&stats.sum).for_each(|(mean, sum)| *mean += sum / pixels);
            if stats.dof == 0 || !replicated {
                out.covariance.fill(f64::INFINITY);
                continue;
            }
            out.dof += stats.dof;
            for (i, cell) in out.covariance.iter_mut().enumerate() {
                *cell += stats.covariance(i / channels, i % channels) / (pixels * pixels);
            }
        }
        out
    }
}
