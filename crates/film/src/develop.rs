//! From sums to planes of means and standard errors.

use crate::stats::{ErrorSummary, PixelStats, Squares, SumError, squares::SquareStats, t_quantile};
use crate::{ErrorMode, Film, PixelBounds};

/// Side of the tiles over which errors are pooled when a pixel has too few samples for its own.
pub const POOL_TILE: u32 = 16;

/// A number with its standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Mean.
    pub value: f32,
    /// Standard error of the mean; infinite when unknown.
    pub se: f32,
    /// Degrees of freedom of the standard error.
    pub dof: u32,
}

impl Estimate {
    /// Half the width of the two-sided interval that holds the truth with probability `confidence` (0.95).
    pub fn half_width(&self, confidence: f64) -> f64 {
        if self.se == 0.0 { 0.0 } else { t_quantile(0.5 + 0.5 * confidence, self.dof) * f64::from(self.se) }
    }
}

/// Planes of a film, row-major over `bounds`.
#[derive(Clone, Debug, PartialEq)]
pub struct Developed {
    /// Window.
    pub bounds: PixelBounds,
    /// Names of the channels, groups in order.
    pub names: Vec<String>,
    /// Units of the channels.
    pub units: Vec<String>,
    /// Means, one plane per channel.
    pub mean: Vec<Vec<f32>>,
    /// Standard errors, one plane for each of the leading channels that have errors; infinite when unknown.
    pub error: Vec<Vec<f32>>,
    /// Side of the squares of pixels that have errors in common, see [`crate::FilmSpec::square`].
    pub square: u32,
    /// Standard errors of the means over these squares, at each of their pixels: planes as of `error`. Infinite where one of
    /// the pixels does not know its own; no planes without replicates, and where pixels are independent.
    pub square_error: Vec<Vec<f32>>,
    /// Luminance Y.
    pub y: Vec<f32>,
    /// Standard error of Y.
    pub y_error: Vec<f32>,
    /// Degrees of freedom of the errors.
    pub dof: Vec<u32>,
    /// Samples per pixel.
    pub samples: Vec<u32>,
    /// Pixels in which one sample carries half of the variance of Y or more.
    pub flagged: Vec<bool>,
    /// Pixels whose errors were pooled over their tile.
    pub pooled: Vec<bool>,
    /// Largest |Y| of a sample, and the index of that sample.
    pub largest: Vec<(f32, u32)>,
    /// The errors in short.
    pub summary: ErrorSummary,
}

impl Developed {
    /// All channels that have errors at a pixel.
    pub fn pixel(&self, x: u32, y: u32) -> Vec<Estimate> {
        let p = self.bounds.index(x, y);
        let estimate = |(m, e): (&Vec<f32>, &Vec<f32>)| Estimate { value: m[p], se: e[p], dof: self.dof[p] };
        self.mean.iter().zip(&self.error).map(estimate).collect()
    }

    /// Luminance at a pixel.
    pub fn luminance(&self, x: u32, y: u32) -> Estimate {
        let p = self.bounds.index(x, y);
        Estimate { value: self.y[p], se: self.y_error[p], dof: self.dof[p] }
    }

    /// Standard errors of a channel, from which those of sums over pixels follow.
    pub fn squares(&self, channel: usize) -> Squares<'_> {
        Squares {
            window: self.bounds,
            side: self.square,
            pixel: &self.error[channel],
            square: self.square_error.get(channel).map(Vec::as_slice),
        }
    }

    /// Mean of a channel over an area of the window, and its error, by [`Squares::sum`].
    pub fn mean_over(&self, channel: usize, area: PixelBounds) -> (f64, SumError) {
        let area = area.intersection(&self.bounds);
        let n = area.area() as f64;
        let at = |(x, y)| f64::from(self.mean[channel][self.bounds.index(x, y)]);
        let error = self.squares(channel).sum(area, |_| true, |p| f64::from(self.dof[p]));
        (area.pixels().map(at).sum::<f64>() / n, error.scaled(1.0 / n))
    }
}

impl Film {
    /// Means and standard errors of every channel.
    pub fn develop(&self) -> Developed {
        let wide = Wide::new(self, true);
        let spec = self.spec();
        let narrow = |v: &[f64]| v.iter().map(|&x| x as f32).collect::<Vec<f32>>();
        let root = |v: &[f64]| v.iter().map(|&x| x.sqrt() as f32).collect::<Vec<f32>>();
        let units = spec.groups.iter().flat_map(|g| g.channels.iter().map(|_| g.unit.clone())).collect();
        let pixels = 0..self.planes.largest.len();
        Developed {
            bounds: spec.bounds,
            names: spec.channel_names(),
            units,
            mean: wide.mean.iter().map(|m| narrow(m)).collect(),
            error: wide.variance.iter().map(|v| root(v)).collect(),
            square: spec.square,
            square_error: self.square_errors(&wide.pooled),
            y: narrow(&wide.y),
            y_error: root(&wide.y_variance),
            samples: pixels.map(|p| self.planes.count(p)).collect(),
            largest: self
                .planes
                .largest
                .iter()
                .map(|&k| (f32::from_bits((k >> 32) as u32), !(k as u32)))
                .collect(),
            summary: wide.summary(spec.mode),
            dof: wide.dof,
            flagged: wide.flagged,
            pooled: wide.pooled,
        }
    }

    /// Errors of the means over squares. Those with a pixel whose error is pooled have too few samples for their own.
    fn square_errors(&self, pooled: &[bool]) -> Vec<Vec<f32>> {
        let spec = self.spec();
        if spec.square == 1 || spec.mode == ErrorMode::Conservative {
            return Vec::new();
        }
        let mut planes = vec![vec![f32::INFINITY; pooled.len()]; self.planes.layout.with_errors];
        let mut stats = SquareStats::new(self);
        for square in spec.bounds.tiles(spec.square) {
            let members = || square.pixels().map(|(x, y)| spec.bounds.index(x, y));
            if members().any(|p| pooled[p]) {
                continue;
            }
            stats.load(square);
            for (c, plane) in planes.iter_mut().enumerate() {
                let se = (stats.covariance(c, c).sqrt() / square.area() as f64) as f32;
                members().for_each(|p| plane[p] = se);
            }
        }
        planes
    }

    /// Summary of the errors of Y: what the progress line shows.
    pub fn summary(&self) -> ErrorSummary {
        Wide::new(self, false).summary(self.spec().mode)
    }
}

/// Planes in f64 before they are narrowed.
pub(crate) struct Wide {
    pub mean: Vec<Vec<f64>>,
    pub variance: Vec<Vec<f64>>,
    pub y: Vec<f64>,
    pub y_variance: Vec<f64>,
    pub dof: Vec<u32>,
    pub flagged: Vec<bool>,
    pub pooled: Vec<bool>,
}

impl Wide {
    /// All channels, or luminance alone.
    pub fn new(film: &Film, channels: bool) -> Self {
        let spec = film.spec();
        let pixels = spec.bounds.area() as usize;
        let l = film.planes.layout;
        let planes = |n: usize| vec![vec![0.0; pixels]; if channels { n } else { 0 }];
        let mut wide = Self {
            mean: planes(l.channels),
            variance: planes(l.with_errors),
            y: vec![0.0; pixels],
            y_variance: vec![0.0; pixels],
            dof: vec![0; pixels],
            flagged: vec![false; pixels],
            pooled: vec![false; pixels],
        };
        let mut stats = PixelStats::new(spec, &film.planes, channels);
        for p in 0..pixels {
            stats.load(p);
            wide.store(p, &stats);
        }
        wide.pool(film);
        for p in (0..pixels).filter(|&p| wide.pooled[p]) {
            stats.load(p);
            wide.flagged[p] = stats.dominated(p, wide.y_variance[p]);
        }
        wide
    }

    fn store(&mut self, p: usize, s: &PixelStats<'_>) {
        self.mean.iter_mut().zip(&s.mean).for_each(|(plane, &m)| plane[p] = m);
        self.variance.iter_mut().zip(&s.variance).for_each(|(plane, &v)| plane[p] = v);
        self.y[p] = s.y;
        self.y_variance[p] = s.y_variance;
        self.dof[p] = s.dof;
        self.flagged[p] = s.dominated(p, s.y_variance);
    }

    /// Replaces the errors of pixels with fewer than two samples a replicate by those of their tile.
    fn pool(&mut self, film: &Film) {
        let ErrorMode::Replicated { replicates } = film.spec().mode else { return };
        let bounds = film.spec().bounds;
        let n: Vec<u32> = (0..self.y.len()).map(|p| film.planes.count(p)).collect();
        for tile in bounds.tiles(POOL_TILE) {
            let members: Vec<usize> = tile.pixels().map(|(x, y)| bounds.index(x, y)).collect();
            let sparse: Vec<usize> =
                members.iter().copied().filter(|&p| n[p] > 0 && n[p] < 2 * replicates).collect();
            if sparse.is_empty() {
                continue;
            }
            // pixels of a square may err as one, and then count once
            let squares = tile.tiles(film.spec().square);
            let most = |s: PixelBounds| s.pixels().map(|(x, y)| self.dof[bounds.index(x, y)]).max();
            let dof: u32 = squares.filter_map(most).sum();
            for plane in self.variance.iter_mut().chain([&mut self.y_variance]) {
                let per_sample = pooled_variance(plane, &self.dof, &n, &members);
                sparse.iter().for_each(|&p| plane[p] = per_sample / f64::from(n[p]));
            }
            for p in sparse {
                self.dof[p] = dof;
                self.pooled[p] = true;
            }
        }
    }

    fn summary(&self, mode: ErrorMode) -> ErrorSummary {
        let se: Vec<f64> = self.y_variance.iter().map(|v| v.sqrt()).collect();
        let mut summary = ErrorSummary::new(mode, &self.y, &se);
        summary.flagged = self.flagged.iter().filter(|&&f| f).count() as u64;
        summary.pooled = self.pooled.iter().filter(|&&f| f).count() as u64;
        summary
    }
}

/// Mean variance of one sample over the pixels that know theirs, weighted by degrees of freedom.
fn pooled_variance(variance: &[f64], dof: &[u32], n: &[u32], members: &[usize]) -> f64 {
    let (mut sum, mut weight) = (0.0, 0.0);
    for &p in members.iter().filter(|&&p| dof[p] > 0) {
        sum += f64::from(dof[p]) * variance[p] * f64::from(n[p]);
        weight += f64::from(dof[p]);
    }
    if weight > 0.0 { sum / weight } else { f64::INFINITY }
}
