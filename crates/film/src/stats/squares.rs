//! Errors of sums over pixels that have errors in common.
//!
//! Where the paths of a square of pixels are shared ([`crate::FilmSpec::square`]), a sample of one of them is correlated with
//! the sample of the same number of the others, and with nothing else. A sum of means over pixels has the variance
//! `sum over squares Q of V_Q`. With replicates, `R_pb` the weighted sum of replicate b of pixel p, `W_pb` its weight, `W_p`
//! the pixel's and `m_p` the pixel's mean, each square is one draw with `B - 1` degrees of freedom (linearised as the errors
//! of pixels are: Cochran, *Sampling Techniques*, 3rd ed. 1977, sec. 6.4 and 9.2):
//!
//! ```text
//! V_Q = B/(B-1) sum_b ( sum_{p in Q} (R_pb - m_p W_pb) / W_p )^2
//! ```
//!
//! Where only the pixels' own standard errors `s_p` are known (without replicates, and for a part of a square),
//! `V_Q <= (sum_{p in Q} s_p)^2` (Cauchy and Schwarz), with equality for pixels that err as one.

use super::PixelStats;
use crate::{Film, PixelBounds, fixed};

/// Variance of a sum, with what its degrees of freedom follow from.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SumError {
    /// `sum v_i` over independent parts; infinite when unknown.
    pub variance: f64,
    /// `sum(v_i^2 / nu_i)`.
    pub spread: f64,
}

impl SumError {
    /// Adds an independent part of variance `v` with `nu` degrees of freedom.
    pub fn add(&mut self, v: f64, nu: f64) {
        self.variance += v;
        self.spread += v * v / nu;
    }

    /// Both of a sum whose terms are multiplied by `factor`.
    pub fn scaled(self, factor: f64) -> Self {
        let square = factor * factor;
        Self { variance: self.variance * square, spread: self.spread * square * square }
    }

    /// Both sums, which are independent, together.
    pub fn and(self, other: Self) -> Self {
        Self { variance: self.variance + other.variance, spread: self.spread + other.spread }
    }

    /// Degrees of freedom by Welch (1947) and Satterthwaite (1946): `(sum v_i)^2 / sum(v_i^2 / nu_i)`; infinite where there
    /// is no variance.
    pub fn dof(&self) -> f64 {
        if self.variance == 0.0 { f64::INFINITY } else { self.variance * self.variance / self.spread }
    }
}

/// Standard errors of the pixels of a window, with what is known of those that have errors in common.
#[derive(Clone, Copy, Debug)]
pub struct Squares<'p> {
    /// The window, from whose upper left corner the squares are cut.
    pub window: PixelBounds,
    /// Side of the squares \[pixels\]; 1 where all pixels are independent.
    pub side: u32,
    /// Standard error of each pixel, row by row.
    pub pixel: &'p [f32],
    /// Standard error of the mean over the square that a pixel lies in; not finite where unknown.
    pub square: Option<&'p [f32]>,
}

impl Squares<'_> {
    /// The error of the sum over the pixels of `area` that `counts` tells by their index; `freedom` are degrees of freedom
    /// of a pixel. Exact over whole squares whose error is known; else an upper bound (see [`crate::stats::squares`]).
    pub fn sum(
        &self,
        area: PixelBounds,
        counts: impl Fn(usize) -> bool,
        freedom: impl Fn(usize) -> f64,
    ) -> SumError {
        let mut total = SumError::default();
        for square in self.touched(area) {
            let part = square.intersection(&area);
            let members = || part.pixels().map(|(x, y)| self.window.index(x, y)).filter(|&p| counts(p));
            let Some(first) = members().next() else { continue };
            let n = members().count();
            let common = self.square.map_or(f64::INFINITY, |s| f64::from(s[first]));
            let se = if n as u64 == square.area() && common.is_finite() && self.side > 1 {
                n as f64 * common
            } else {
                members().map(|p| f64::from(self.pixel[p])).sum()
            };
            total.add(se * se, members().map(&freedom).fold(f64::INFINITY, f64::min));
        }
        total
    }

    /// The squares that have pixels in common with `area`.
    fn touched(&self, area: PixelBounds) -> impl Iterator<Item = PixelBounds> {
        let (window, side) = (self.window, self.side.max(1));
        let area = area.intersection(&window);
        let down = |v: u32, from: u32| v - v.saturating_sub(from) % side;
        let x0 = down(area.x0, window.x0);
        let start = PixelBounds { x0, y0: down(area.y0, window.y0), ..area };
        start.tiles(side).map(move |t| {
            let whole = PixelBounds { x1: t.x0.saturating_add(side), y1: t.y0.saturating_add(side), ..t };
            whole.intersection(&window)
        })
    }
}

/// What the replicates of a square say together.
pub(crate) struct SquareStats<'f> {
    film: &'f Film,
    pixel: PixelStats<'f>,
    /// `sqrt(B/(B-1)) sum_p (R_pb - m_p W_pb) / W_p`: a row of channels for each replicate.
    residual: Vec<f64>,
    /// Sums of the pixels' means.
    pub sum: Vec<f64>,
    /// Degrees of freedom of the pixel that has the fewest; 0 when one is unknown.
    pub dof: u32,
}

impl<'f> SquareStats<'f> {
    pub fn new(film: &'f Film) -> Self {
        let layout = film.planes.layout;
        Self {
            film,
            pixel: PixelStats::new(film.spec(), &film.planes, true),
            residual: vec![0.0; layout.slots * layout.with_errors],
            sum: vec![0.0; layout.with_errors],
            dof: 0,
        }
    }

    /// Computes the statistics of a square.
    pub fn load(&mut self, square: PixelBounds) {
        self.residual.fill(0.0);
        self.sum.fill(0.0);
        self.dof = u32::MAX;
        for (x, y) in square.pixels() {
            let p = self.film.spec().bounds.index(x, y);
            self.pixel.load(p);
            self.dof = self.dof.min(self.pixel.dof);
            self.sum.iter_mut().zip(&self.pixel.mean).for_each(|(sum, m)| *sum += m);
            if self.pixel.dof > 0 {
                self.add(p);
            }
        }
    }

    fn add(&mut self, p: usize) {
        let planes = &self.film.planes;
        let filled = |s: &usize| planes.slot_counts(p)[*s] > 0;
        let slots = (0..planes.layout.slots).filter(filled);
        let total: f64 = slots.clone().map(|s| planes.weight(p, s)).sum();
        let b = f64::from(self.pixel.dof) + 1.0;
        let scale = (b / (b - 1.0)).sqrt() / total;
        for slot in slots {
            let (sums, w) = (planes.slot_sums(p, slot), planes.weight(p, slot));
            let row = &mut self.residual[slot * sums.len()..][..sums.len()];
            for (c, r) in row.iter_mut().enumerate() {
                *r += scale * (fixed::to_f64(sums[c]) - self.pixel.mean[c] * w);
            }
        }
    }

    /// Covariance of the sums of two channels over the square; infinite when unknown.
    pub fn covariance(&self, a: usize, b: usize) -> f64 {
        if self.dof == 0 {
            return f64::INFINITY;
        }
        self.residual.chunks_exact(self.sum.len()).map(|row| row[a] * row[b]).sum()
    }
}
