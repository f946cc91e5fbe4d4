use super::{DistributionError, STEP, STEPS, share_steps, step_of, total};

/// A piecewise constant density on `[a, b]` with bins of equal width, drawn by its inverse cumulative distribution
/// (monotone: stratified numbers give stratified points).
#[derive(Clone, Debug)]
pub struct Piecewise1d {
    cdf: Cdf,
    a: f32,
    width: f32,
}

impl Piecewise1d {
    /// Density in proportion to `weights`, one a bin; see the module for their rounding. At most 2^22 weights.
    pub fn new(weights: &[f64], a: f32, b: f32) -> Result<Self, DistributionError> {
        if !(a < b && (b - a).is_finite()) {
            return Err(DistributionError::Interval { a, b });
        }
        Ok(Self { cdf: Cdf::new(weights)?, a, width: b - a })
    }

    /// A point of `[a, b]` and its density.
    #[inline]
    pub fn sample(&self, u: f32) -> (f32, f32) {
        let (x, pdf, _) = self.cdf.sample(u);
        (self.a + self.width * x, pdf / self.width)
    }

    /// The density at `x`; zero outside `[a, b]`.
    #[inline]
    pub fn pdf(&self, x: f32) -> f32 {
        self.cdf.pdf((x - self.a) / self.width) / self.width
    }

    /// The uniform number that [`Self::sample`] maps to `x`: the cumulative distribution.
    #[inline]
    pub fn invert(&self, x: f32) -> f32 {
        self.cdf.invert((x - self.a) / self.width)
    }
}

/// A piecewise constant density on the unit square: rows by their sums, then a bin within the row.
#[derive(Clone, Debug)]
pub struct Piecewise2d {
    rows: Cdf,
    /// One a row; rows of weight zero are never drawn and have none.
    columns: Vec<Option<Cdf>>,
}

impl Piecewise2d {
    /// Density in proportion to `weights`, `width` a row and `height` rows; the first index of a point runs along rows.
    pub fn new(weights: &[f32], width: usize, height: usize) -> Result<Self, DistributionError> {
        let count = weights.len();
        if width.checked_mul(height) != Some(count) {
            return Err(DistributionError::Shape { width, height, count });
        }
        if count == 0 {
            return Err(DistributionError::Empty);
        }
        let (mut sums, mut columns) = (Vec::with_capacity(height), Vec::with_capacity(height));
        for (y, row) in weights.chunks_exact(width).enumerate() {
            let row: Vec<f64> = row.iter().map(|&w| f64::from(w)).collect();
            match total(row.iter().copied()) {
                Ok(sum) => {
                    sums.push(sum);
                    columns.push(Some(Cdf::new(&row)?));
                }
                Err(DistributionError::AllZero { .. }) => {
                    sums.push(0.0);
                    columns.push(None);
                }
                Err(DistributionError::Weight { index, value }) => {
                    return Err(DistributionError::Weight { index: y * width + index, value });
                }
                Err(other) => return Err(other),
            }
        }
        let rows = Cdf::new(&sums).map_err(|e| match e {
            DistributionError::AllZero { .. } => DistributionError::AllZero { count },
            other => other,
        })?;
        Ok(Self { rows, columns })
    }

    /// A point of the unit square and its density per unit area.
    #[inline]
    pub fn sample(&self, u: [f32; 2]) -> ([f32; 2], f32) {
        let (y, row_pdf, row) = self.rows.sample(u[1]);
        let columns =
            self.columns[row].as_ref().expect("a row of weight zero has no step and is never drawn");
        let (x, pdf, _) = columns.sample(u[0]);
        ([x, y], row_pdf * pdf)
    }

    /// The density at a point; zero outside the unit square.
    #[inline]
    pub fn pdf(&self, [x, y]: [f32; 2]) -> f32 {
        let Some(row) = self.rows.bin(y) else { return 0.0 };
        self.columns[row].as_ref().map_or(0.0, |columns| columns.pdf(x)) * self.rows.pdf(y)
    }
}

/// A cumulative distribution over bins of the unit interval, in steps of 2^-24.
#[derive(Clone, Debug)]
struct Cdf {
    /// `edges[i]` steps lie before bin i; the last entry is 2^24.
    edges: Vec<u32>,
    /// The bins of the first of every `2^shift` steps, and of the last: where to look for the others (Chen and Asau 1974).
    guide: Vec<u32>,
    shift: u32,
}

/// Bins for each entry of a guide.
const GUIDED: usize = 4;

impl Cdf {
    fn new(weights: &[f64]) -> Result<Self, DistributionError> {
        let steps = share_steps(weights)?;
        let mut sum = 0;
        let edges = std::iter::once(0).chain(steps.into_iter().map(|s| {
            sum += s;
            sum
        }));
        let edges: Vec<u32> = edges.collect();
        let entries = ((edges.len() - 1) / GUIDED).max(1).next_power_of_two();
        let shift = STEPS.trailing_zeros() - entries.trailing_zeros();
        let firsts = (0..entries as u32).map(|k| k << shift).chain([STEPS - 1]);
        let guide = firsts.map(|step| edges.partition_point(|&e| e <= step) as u32 - 1).collect();
        Ok(Self { edges, guide, shift })
    }

    fn bins(&self) -> usize {
        self.edges.len() - 1
    }

    /// The bin of a point of the unit interval.
    #[inline(always)]
    fn bin(&self, x: f32) -> Option<usize> {
        let n = self.bins();
        (0.0..=1.0).contains(&x).then(|| ((x * n as f32) as usize).min(n - 1))
    }

    #[inline(always)]
    fn density(&self, bin: usize) -> f32 {
        (self.edges[bin + 1] - self.edges[bin]) as f32 * STEP * self.bins() as f32
    }

    /// Point, density and bin. Each step stands for its middle.
    #[inline(always)]
    fn sample(&self, u: f32) -> (f32, f32, usize) {
        let step = step_of(u);
        let k = (step >> self.shift) as usize;
        let (least, greatest) = (self.guide[k] as usize, self.guide[k + 1] as usize);
        let bin = least + self.edges[least + 1..=greatest].partition_point(|&e| e <= step);
        let (first, next) = (self.edges[bin], self.edges[bin + 1]);
        let within = ((step - first) as f32 + 0.5) / (next - first) as f32;
        ((bin as f32 + within) / self.bins() as f32, self.density(bin), bin)
    }

    #[inline(always)]
    fn pdf(&self, x: f32) -> f32 {
        self.bin(x).map_or(0.0, |bin| self.density(bin))
    }

    #[inline(always)]
    fn invert(&self, x: f32) -> f32 {
        let Some(bin) = self.bin(x) else { return if x < 0.0 { 0.0 } else { 1.0 } };
        let within = x * self.bins() as f32 - bin as f32;
        let steps = self.edges[bin] as f32 + within * (self.edges[bin + 1] - self.edges[bin]) as f32;
        (steps / STEPS as f32).min(1.0)
    }
}
