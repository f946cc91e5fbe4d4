//! Functions on the unit square, bilinear between the points of a grid, that depend on parameters: interpolated linearly
//! between slices. Their density can be drawn from, and the drawing undone.
//!
//! Rows first by the marginal, then within a row, by solving the quadratic of a linear density (Dupuy, Jakob 2018).

use crate::error::ScatterError;

/// Parameters that a function can have at most.
const MOST: usize = 3;

/// See the module.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid2d {
    size: [usize; 2],
    /// Ascending values of each parameter, slowest first.
    axes: Vec<Vec<f32>>,
    /// Slice by slice, row by row.
    values: Vec<f32>,
    /// Integrals along each row up to each point, and of rows up to each row; empty where nothing is drawn.
    conditional: Vec<f32>,
    marginal: Vec<f32>,
}

/// Slices and their weights.
#[derive(Clone, Copy, Debug)]
pub struct Slices {
    index: [usize; 1 << MOST],
    weight: [f32; 1 << MOST],
    count: usize,
}

fn unusable(why: String) -> ScatterError {
    ScatterError::Unusable { what: "measured material", why }
}

impl Grid2d {
    /// Values at `width x height` points for each combination of the axes' values.
    ///
    /// # Errors
    /// When sizes do not agree, an axis does not ascend, or a value is not finite.
    pub fn new(
        [width, height]: [usize; 2],
        axes: Vec<Vec<f32>>,
        values: Vec<f32>,
    ) -> Result<Self, ScatterError> {
        let slices: usize = axes.iter().map(Vec::len).product();
        if width < 2 || height < 2 || axes.len() > MOST || values.len() != slices * width * height {
            return Err(unusable(format!(
                "{} values do not fill {slices} slices of {width} x {height}",
                values.len()
            )));
        }
        let ascends = |a: &Vec<f32>| !a.is_empty() && a.windows(2).all(|w| w[0] < w[1]);
        if !axes.iter().all(ascends) {
            return Err(unusable("its parameters do not ascend".into()));
        }
        if let Some(v) = values.iter().find(|v| !v.is_finite()) {
            return Err(unusable(format!("a value is {v}")));
        }
        let size = [width, height];
        Ok(Self { size, axes, values, conditional: Vec::new(), marginal: Vec::new() })
    }

    /// The same with every slice scaled to integral 1, to draw from.
    ///
    /// # Errors
    /// As [`Self::new`], and when a value is negative or a slice zero.
    pub fn density(size: [usize; 2], axes: Vec<Vec<f32>>, values: Vec<f32>) -> Result<Self, ScatterError> {
        let mut grid = Self::new(size, axes, values)?;
        let [w, h] = size;
        let cells = ((w - 1) * (h - 1)) as f64;
        for slice in grid.values.chunks_exact_mut(w * h) {
            if let Some(v) = slice.iter().find(|v| **v < 0.0) {
                return Err(unusable(format!("a density is {v}")));
            }
            let (mut rows, mut along) = (Vec::with_capacity(h), Vec::with_capacity(w * h));
            for row in slice.chunks_exact(w) {
                let mut sum = 0.0;
                along.push(sum);
                for pair in row.windows(2) {
                    sum += 0.5 * (f64::from(pair[0]) + f64::from(pair[1]));
                    along.push(sum);
                }
                rows.push(sum);
            }
            let total: f64 = rows.windows(2).map(|r| 0.5 * (r[0] + r[1])).sum();
            if total <= 0.0 {
                return Err(unusable("a density is zero everywhere".into()));
            }
            let mut sum = 0.0;
            grid.marginal.push(0.0);
            for r in rows.windows(2) {
                sum += 0.5 * (r[0] + r[1]) / total;
                grid.marginal.push(sum as f32);
            }
            grid.conditional.extend(along.iter().map(|v| (v / total) as f32));
            slice.iter_mut().for_each(|v| *v = (f64::from(*v) * cells / total) as f32);
        }
        Ok(grid)
    }

    /// The slices around `parameters`; beyond an axis its last value holds.
    #[inline]
    pub fn at(&self, parameters: &[f32]) -> Slices {
        let mut s = Slices { index: [0; 1 << MOST], weight: [1.0; 1 << MOST], count: 1 };
        for (axis, &p) in self.axes.iter().zip(parameters) {
            let last = axis.len() - 1;
            let i = axis.partition_point(|v| *v <= p).saturating_sub(1).min(last.saturating_sub(1));
            let t = if last == 0 { 0.0 } else { ((p - axis[i]) / (axis[i + 1] - axis[i])).clamp(0.0, 1.0) };
            let before = s.count;
            for k in 0..before {
                let first = s.index[k] * axis.len() + i;
                s.index[k] = first;
                if t > 0.0 {
                    s.index[s.count] = first + 1;
                    s.weight[s.count] = s.weight[k] * t;
                    s.weight[k] *= 1.0 - t;
                    s.count += 1;
                }
            }
        }
        s
    }

    #[inline(always)]
    fn look(s: &Slices, table: &[f32], stride: usize, i: usize) -> f32 {
        let mut sum = 0.0;
        for k in 0..s.count {
            sum += s.weight[k] * table[s.index[k] * stride + i];
        }
        sum
    }

    /// Cell and position within it.
    #[inline(always)]
    fn cell(&self, p: [f32; 2]) -> ([usize; 2], [f32; 2]) {
        let axis = |k: usize| {
            let x = p[k].clamp(0.0, 1.0) * (self.size[k] - 1) as f32;
            let i = (x as usize).min(self.size[k] - 2);
            (i, x - i as f32)
        };
        let (x, y) = (axis(0), axis(1));
        ([x.0, y.0], [x.1, y.1])
    }

    /// Values at the left and right edge of a cell, `y` of the way up.
    #[inline(always)]
    fn edges(&self, s: &Slices, [i, j]: [usize; 2], y: f32) -> [f32; 2] {
        let [w, h] = self.size;
        let v = |k: usize| Self::look(s, &self.values, w * h, k);
        let first = j * w + i;
        [(1.0 - y) * v(first) + y * v(first + w), (1.0 - y) * v(first + 1) + y * v(first + w + 1)]
    }

    /// The value at `p`: of a density, the density.
    #[inline]
    pub fn eval(&self, p: [f32; 2], s: &Slices) -> f32 {
        let (cell, [x, y]) = self.cell(p);
        let [a, b] = self.edges(s, cell, y);
        (1.0 - x) * a + x * b
    }

    /// A point drawn with the numbers `u`, and its density.
    #[inline]
    pub fn sample(&self, u: [f32; 2], s: &Slices) -> ([f32; 2], f32) {
        let [w, h] = self.size;
        let row = |j: usize| Self::look(s, &self.marginal, h, j);
        let j = last_below(h - 1, |j| row(j) <= u[1]);
        let whole = |j: usize| Self::look(s, &self.conditional, w * h, j * w + w - 1);
        let y = solve(u[1] - row(j), whole(j), whole(j + 1));
        let along = |i: usize| {
            let c = |j: usize| Self::look(s, &self.conditional, w * h, j * w + i);
            (1.0 - y) * c(j) + y * c(j + 1)
        };
        let target = u[0] * along(w - 1);
        let i = last_below(w - 1, |i| along(i) <= target);
        let [a, b] = self.edges(s, [i, j], y);
        let scale = ((w - 1) * (h - 1)) as f32;
        let x = solve(target - along(i), a / scale, b / scale);
        ([(i as f32 + x) / (w - 1) as f32, (j as f32 + y) / (h - 1) as f32], (1.0 - x) * a + x * b)
    }

    /// The numbers that [`Self::sample`] makes `p` of, and the density there.
    #[inline]
    pub fn invert(&self, p: [f32; 2], s: &Slices) -> ([f32; 2], f32) {
        let [w, h] = self.size;
        let ([i, j], [x, y]) = self.cell(p);
        let [a, b] = self.edges(s, [i, j], y);
        let scale = ((w - 1) * (h - 1)) as f32;
        let along = |i: usize| {
            let c = |j: usize| Self::look(s, &self.conditional, w * h, j * w + i);
            (1.0 - y) * c(j) + y * c(j + 1)
        };
        let whole = |j: usize| Self::look(s, &self.conditional, w * h, j * w + w - 1);
        let (r0, r1) = (whole(j), whole(j + 1));
        let v = Self::look(s, &self.marginal, h, j) + y * (r0 + 0.5 * y * (r1 - r0));
        let total = along(w - 1);
        let u = if total > 0.0 { (along(i) + x * (a + 0.5 * x * (b - a)) / scale) / total } else { 0.5 };
        ([u, v], (1.0 - x) * a + x * b)
    }
}

/// The last index below `n` that satisfies a condition which holds up to some index.
#[inline(always)]
fn last_below(n: usize, holds: impl Fn(usize) -> bool) -> usize {
    let (mut low, mut high) = (0, n);
    while high - low > 1 {
        let middle = usize::midpoint(low, high);
        if holds(middle) { low = middle } else { high = middle }
    }
    low
}

/// Where the integral of a density that is linear from `a` to `b` over \[0, 1\] reaches `target`: the root of
/// `a x + (b - a) x^2 / 2 = target` in the form that holds at a = b.
#[inline(always)]
fn solve(target: f32, a: f32, b: f32) -> f32 {
    let root = (a * a + 2.0 * target * (b - a)).max(0.0).sqrt();
    let sum = a + root;
    if sum > 0.0 { (2.0 * target / sum).clamp(0.0, 1.0) } else { 0.5 }
}
