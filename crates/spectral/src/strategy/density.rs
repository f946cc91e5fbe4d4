//! Densities over wavelength: 1 nm tables and lines.

use crate::range::LambdaRange;
use crate::wavelengths::CONTINUUM;

/// `u` moves on this grid, so cumulative sums rounded to it are exact probabilities.
const GRID: f64 = 16_777_216.0;
/// The greatest number below 1 on that grid.
const LAST: f32 = 1.0 - 1.0 / 16_777_216.0;
/// Buckets of the guide table.
const GUIDE: usize = 4096;

/// A piecewise constant density on cells of at most 1 nm, and lines with probabilities.
///
/// Cumulative probabilities are multiples of 2^-24, like the random numbers: `pdf` is the density of what `sample`
/// returns, to the bit.
#[derive(Clone, Debug, PartialEq)]
pub struct Density {
    range: LambdaRange,
    cells: Vec<Cell>,
    guide: Box<[u16; GUIDE]>,
    lines: Vec<LineCell>,
    /// Probability of the continuum.
    continuum: f32,
    cells_per_nm: f32,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Cell {
    cdf: f32,
    lambda: f32,
    nm_per_u: f32,
    pdf: f32,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct LineCell {
    lambda: f32,
    probability: f32,
    /// Cumulative, this line included.
    cdf: f32,
}

impl Density {
    /// The same density everywhere on `range`.
    pub fn uniform(range: LambdaRange) -> Self {
        Weights { range, cells: vec![1.0; cell_count(range)], lines: Vec::new() }.into()
    }

    /// `(wavelength [nm], density [1/nm] or probability, line or CONTINUUM)` for `u` in \[0, 1).
    #[inline(always)]
    pub fn sample(&self, u: f32) -> (f32, f32, u16) {
        // sums that were rounded up to 1 belong to the last cell
        let u = if u < LAST { u } else { LAST };
        if u >= self.continuum {
            return self.sample_line(u);
        }
        let bucket = (u * GUIDE as f32) as i32 as u32 as usize & (GUIDE - 1);
        let mut i = usize::from(self.guide[bucket]);
        // a bucket holds the start of at most one cell of usual mass: no branch for that one
        i += usize::from(self.cells[i + 1].cdf <= u);
        while self.cells[i + 1].cdf <= u {
            i += 1;
        }
        let cell = &self.cells[i];
        let lambda = cell.lambda + (u - cell.cdf) * cell.nm_per_u;
        (if lambda > self.range.max { self.range.max } else { lambda }, cell.pdf, CONTINUUM)
    }

    #[inline(never)]
    fn sample_line(&self, u: f32) -> (f32, f32, u16) {
        let i = self.lines.iter().position(|l| u < l.cdf).unwrap_or(self.lines.len() - 1);
        (self.lines[i].lambda, self.lines[i].probability, i as u16)
    }

    /// Density of the continuum at `lambda` \[1/nm\], 0 outside the range.
    pub fn pdf(&self, lambda: f32) -> f32 {
        if !self.range.contains(lambda) {
            return 0.0;
        }
        let i = ((lambda - self.range.min) * self.cells_per_nm) as usize;
        self.cells[i.min(self.cells.len() - 2)].pdf
    }

    /// Wavelengths \[nm\] and probabilities of the lines, in the order of their indices.
    pub fn lines(&self) -> impl Iterator<Item = (f32, f32)> + '_ {
        self.lines.iter().map(|l| (l.lambda, l.probability))
    }

    /// The range of the continuum.
    pub fn range(&self) -> LambdaRange {
        self.range
    }
}

/// Weights per cell and per line before they are made a [`Density`]; all sums of both together are one.
pub(super) struct Weights {
    pub(super) range: LambdaRange,
    pub(super) cells: Vec<f64>,
    /// Wavelength \[nm\] and probability.
    pub(super) lines: Vec<(f32, f64)>,
}

impl From<Weights> for Density {
    fn from(w: Weights) -> Self {
        let total: f64 = w.cells.iter().sum::<f64>() + w.lines.iter().map(|l| l.1).sum::<f64>();
        let on_grid = |sum: f64| ((sum / total * GRID).round() / GRID) as f32;
        let mut sum = 0.0;
        let mut next = |mass: f64| {
            sum += mass;
            on_grid(sum)
        };
        let width = f64::from(w.range.width()) / w.cells.len() as f64;
        let cell_cdf: Vec<f32> = w.cells.iter().map(|&mass| next(mass)).collect();
        let line_cdf: Vec<f32> = w.lines.iter().map(|l| next(l.1)).collect();
        let starts = std::iter::once(0.0).chain(cell_cdf.iter().copied());
        let cells: Vec<Cell> =
            starts.enumerate().map(|(i, cdf)| cell(w.range.min, width, i, cdf, cell_cdf.get(i))).collect();
        let continuum = cell_cdf.last().copied().unwrap_or(0.0);
        let before = std::iter::once(continuum).chain(line_cdf.iter().copied());
        let lines = w.lines.iter().zip(line_cdf.iter().zip(before));
        let lines =
            lines.map(|(l, (&cdf, start))| LineCell { lambda: l.0, probability: cdf - start, cdf }).collect();
        let guide = guide(&cells);
        Self { range: w.range, cells, guide, lines, continuum, cells_per_nm: (1.0 / width) as f32 }
    }
}

/// Cell `i` from `cdf` to `end`; the last one has no end and is only a sentinel.
fn cell(min: f32, width: f64, i: usize, cdf: f32, end: Option<&f32>) -> Cell {
    let mass = end.map_or(0.0, |end| f64::from(end - cdf));
    let nm_per_u = if mass > 0.0 { (width / mass) as f32 } else { 0.0 };
    let lambda = (f64::from(min) + i as f64 * width) as f32;
    Cell { cdf, lambda, nm_per_u, pdf: (mass / width) as f32 }
}

/// For each bucket of `u`, the last cell that starts at or before the bucket.
fn guide(cells: &[Cell]) -> Box<[u16; GUIDE]> {
    let last = cells.len().saturating_sub(2);
    let start = |b: usize| {
        let u = b as f32 / GUIDE as f32;
        cells.partition_point(|c| c.cdf <= u).saturating_sub(1).min(last) as u16
    };
    Box::new(std::array::from_fn(start))
}

/// Number of cells on a range: 1 nm each, wider only beyond 32768 nm.
pub(super) fn cell_count(range: LambdaRange) -> usize {
    (range.width().ceil() as usize).clamp(1, 32768)
}
