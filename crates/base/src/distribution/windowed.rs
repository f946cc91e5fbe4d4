use super::DistributionError;

/// A piecewise constant density on the unit square, drawn within any axis-parallel window of it.
///
/// Integrals over windows come from a table of sums (Crow 1984, "Summed-area tables for texture mapping"), in double
/// precision: bilinear interpolation of the sums is exact for piecewise constant weights. So is the inversion within a
/// cell, but for rounding (Bitterli, Novák, Jarosz 2015, "Portal-masked environment map sampling").
#[derive(Clone, Debug)]
pub struct Windowed2d {
    width: usize,
    height: usize,
    /// `(width + 1) x (height + 1)` sums of all weights of smaller indices.
    sums: Vec<f64>,
}

/// A window of the unit square: lowest and highest corner.
pub type Window = [[f32; 2]; 2];

impl Windowed2d {
    /// Density in proportion to `weights`, `width` a row and `height` rows; the first index of a point runs along rows.
    ///
    /// # Errors
    /// When there are no weights, not `width x height`, all zero, or one is negative or not finite.
    pub fn new(weights: &[f32], width: usize, height: usize) -> Result<Self, DistributionError> {
        let count = weights.len();
        if width.checked_mul(height) != Some(count) {
            return Err(DistributionError::Shape { width, height, count });
        }
        if count == 0 {
            return Err(DistributionError::Empty);
        }
        let mut sums = vec![0.0; (width + 1) * (height + 1)];
        for (y, row) in weights.chunks_exact(width).enumerate() {
            let mut along = 0.0;
            for (x, &weight) in row.iter().enumerate() {
                if !(weight >= 0.0 && weight.is_finite()) {
                    return Err(DistributionError::Weight { index: y * width + x, value: weight.into() });
                }
                along += f64::from(weight);
                let above = sums[y * (width + 1) + x + 1];
                sums[(y + 1) * (width + 1) + x + 1] = above + along;
            }
        }
        if sums[count + width + height] == 0.0 {
            return Err(DistributionError::AllZero { count });
        }
        Ok(Self { width, height, sums })
    }

    /// Columns and rows.
    pub fn size(&self) -> [usize; 2] {
        [self.width, self.height]
    }

    /// A point of `window`, the density per unit area within it, and the column and row that it lies in; `None` where the window
    /// holds no weight.
    pub fn sample(&self, u: [f32; 2], window: &Window) -> Option<([f32; 2], f32, [usize; 2])> {
        let [x0, x1, y0, y1] = self.cells(window);
        let total = self.integral(x0, x1, y0, y1);
        if total <= 0.0 {
            return None;
        }
        let (x, column) = invert(u[0], x0, x1, |x| self.integral(x0, x, y0, y1))?;
        let (left, right) = (column as f64, column as f64 + 1.0);
        let (y, row) = invert(u[1], y0, y1, |y| self.integral(left, right, y0, y))?;
        let pdf = self.density(column, row, total);
        let p = [(x / self.width as f64) as f32, (y / self.height as f64) as f32];
        (pdf > 0.0).then_some((p, pdf, [column, row]))
    }

    /// The density of [`Self::sample`] at `p`; zero outside the window.
    pub fn pdf(&self, p: [f32; 2], window: &Window) -> f32 {
        let [low, high] = window;
        if (0..2).any(|k| p[k] < low[k] || p[k] > high[k]) {
            return 0.0;
        }
        let [x0, x1, y0, y1] = self.cells(window);
        let total = self.integral(x0, x1, y0, y1);
        if total <= 0.0 {
            return 0.0;
        }
        let [column, row] = self.cell(p);
        self.density(column, row, total)
    }

    /// Column and row of a point, the nearest for points outside.
    #[inline]
    pub fn cell(&self, [x, y]: [f32; 2]) -> [usize; 2] {
        let of = |t: f32, n: usize| ((t * n as f32) as usize).min(n - 1);
        [of(x, self.width), of(y, self.height)]
    }

    fn cells(&self, [low, high]: &Window) -> [f64; 4] {
        let (w, h) = (self.width as f64, self.height as f64);
        let x = |t: f32| (f64::from(t) * w).clamp(0.0, w);
        let y = |t: f32| (f64::from(t) * h).clamp(0.0, h);
        [x(low[0]), x(high[0]), y(low[1]), y(high[1])]
    }

    /// Weight of a cell over the mean weight of a unit square like the window's `total`.
    fn density(&self, column: usize, row: usize, total: f64) -> f32 {
        let (x, y) = (column as f64, row as f64);
        let weight = self.integral(x, x + 1.0, y, y + 1.0).max(0.0);
        (weight / total * (self.width * self.height) as f64) as f32
    }

    /// Integral of the weights, in cells.
    fn integral(&self, x0: f64, x1: f64, y0: f64, y1: f64) -> f64 {
        (self.sum(x1, y1) - self.sum(x0, y1)) - (self.sum(x1, y0) - self.sum(x0, y0))
    }

    fn sum(&self, x: f64, y: f64) -> f64 {
        let (i, j) = ((x as usize).min(self.width - 1), (y as usize).min(self.height - 1));
        let (fx, fy) = (x - i as f64, y - j as f64);
        let first = j * (self.width + 1) + i;
        let next = first + self.width + 1;
        let row = |k: usize| (1.0 - fx) * self.sums[k] + fx * self.sums[k + 1];
        (1.0 - fy) * row(first) + fy * row(next)
    }
}

/// Where `cumulative`, linear within cells, reaches the share `u` of its value at `b`, and the cell it lies in.
fn invert(u: f32, a: f64, b: f64, cumulative: impl Fn(f64) -> f64) -> Option<(f64, usize)> {
    let total = cumulative(b);
    if total <= 0.0 {
        return None;
    }
    let target = f64::from(u) * total;
    let edge = |k: usize| (k as f64).clamp(a, b);
    let (mut low, mut high) = (a as usize, (b.ceil() as usize).max(a as usize + 1));
    // the cell with cumulative(low) <= target < cumulative(low + 1)
    while high - low > 1 {
        let middle = usize::midpoint(low, high);
        if cumulative(edge(middle)) <= target { low = middle } else { high = middle }
    }
    let (c0, c1) = (cumulative(edge(low)), cumulative(edge(high)));
    let share = if c1 > c0 { ((target - c0) / (c1 - c0)).clamp(0.0, 1.0) } else { 0.5 };
    Some((edge(low) + share * (edge(high) - edge(low)), low))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Pcg32;

    const W: usize = 7;
    const H: usize = 5;

    fn table() -> (Vec<f32>, Windowed2d) {
        let mut rng = Pcg32::new(3, 4);
        let weights: Vec<f32> =
            (0..W * H).map(|i| if i % 4 == 1 { 0.0 } else { rng.next_f32() * 3.0 }).collect();
        let windowed = Windowed2d::new(&weights, W, H).expect("valid");
        (weights, windowed)
    }

    /// Overlap of a cell with a window, in cells.
    fn overlap([x, y]: [usize; 2], [low, high]: &Window) -> f64 {
        let along = |k: usize, n: usize, a: f32, b: f32| {
            let (a, b) = (f64::from(a) * n as f64, f64::from(b) * n as f64);
            (b.min(k as f64 + 1.0) - a.max(k as f64)).max(0.0)
        };
        along(x, W, low[0], high[0]) * along(y, H, low[1], high[1])
    }

    #[test]
    fn frequencies_are_those_of_the_cells() {
        let (weights, windowed) = table();
        for window in [[[0.0, 0.0], [1.0, 1.0]], [[0.21, 0.13], [0.67, 0.95]], [[0.3, 0.41], [0.42, 0.59]]] {
            let of = |k: usize| f64::from(weights[k]) * overlap([k % W, k / W], &window);
            let total: f64 = (0..W * H).map(of).sum();
            let n = 200;
            let mut counts = vec![0.0; W * H];
            for i in 0..n * n {
                let u = [((i % n) as f32 + 0.5) / n as f32, ((i / n) as f32 + 0.5) / n as f32];
                let (p, pdf, [x, y]) = windowed.sample(u, &window).expect("weight");
                counts[y * W + x] += 1.0 / f64::from(n * n);
                let expected = f64::from(weights[y * W + x]) * (W * H) as f64 / total;
                assert!((f64::from(pdf) / expected - 1.0).abs() < 1e-5, "{pdf} {expected}");
                assert!((f64::from(windowed.pdf(p, &window)) / expected - 1.0).abs() < 1e-5, "{p:?}");
            }
            // a regular grid misplaces less than one row and one column in every cell
            for (k, count) in counts.iter().enumerate() {
                assert!((count - of(k) / total).abs() < 2.0 / f64::from(n), "{k}: {count} {}", of(k) / total);
            }
        }
    }

    #[test]
    fn windows_without_weight_have_no_point() {
        let weights = [0.0, 1.0, 0.0, 0.0];
        let windowed = Windowed2d::new(&weights, 4, 1).expect("valid");
        assert!(windowed.sample([0.3, 0.7], &[[0.5, 0.0], [1.0, 1.0]]).is_none());
        assert_eq!(windowed.pdf([0.6, 0.5], &[[0.5, 0.0], [1.0, 1.0]]), 0.0);
        assert_eq!(windowed.pdf([0.3, 0.5], &[[0.4, 0.0], [1.0, 1.0]]), 0.0);
        let (p, pdf, cell) = windowed.sample([0.5, 0.5], &[[0.4, 0.2], [0.9, 0.6]]).expect("weight");
        assert!((p[0] - 0.45).abs() < 1e-6 && (p[1] - 0.4).abs() < 1e-6 && cell == [1, 0]);
        assert!((pdf - 1.0 / (0.1 * 0.4)).abs() < 1e-4, "{pdf}");
    }

    #[test]
    fn bad_weights_are_refused() {
        assert!(Windowed2d::new(&[], 0, 0).is_err());
        assert!(Windowed2d::new(&[1.0], 2, 1).is_err());
        assert!(Windowed2d::new(&[0.0, 0.0], 2, 1).is_err());
        assert!(Windowed2d::new(&[1.0, f32::NAN], 2, 1).is_err());
    }
}
