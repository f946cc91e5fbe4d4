//! One axis of a separable filter.

use std::sync::Arc;

/// Cells of a table over half the support.
const CELLS: usize = 2048;

/// A symmetric function of one offset, sampled in proportion to its magnitude.
#[derive(Clone, Debug)]
pub(super) enum Axis {
    /// Constant up to the radius.
    Box(f32),
    /// Linear fall to zero at the radius.
    Triangle(f32),
    /// Any even function, as a table.
    Table(Arc<Table>),
}

impl Axis {
    /// An offset and the sign of the function there.
    #[inline]
    pub fn sample(&self, u: f32) -> (f32, f32) {
        match self {
            Self::Box(r) => ((2.0 * u - 1.0) * r, 1.0),
            Self::Triangle(r) => {
                let (side, v) = fold(u);
                (side * (r * (1.0 - (1.0 - v).sqrt())), 1.0)
            }
            Self::Table(t) => t.sample(u),
        }
    }

    /// The function at an offset, with integral 1.
    pub fn eval(&self, x: f32) -> f32 {
        match self {
            Self::Box(r) if x.abs() <= *r => 0.5 / r,
            Self::Triangle(r) if x.abs() <= *r => (1.0 - x.abs() / r) / r,
            Self::Table(t) => t.eval(x),
            _ => 0.0,
        }
    }

    pub fn radius(&self) -> f32 {
        match self {
            Self::Box(r) | Self::Triangle(r) => *r,
            Self::Table(t) => t.radius,
        }
    }

    pub fn is_signed(&self) -> bool {
        matches!(self, Self::Table(t) if t.signed)
    }
}

/// The half of the support that `u` falls into, and `u` stretched to [0, 1) there.
#[inline(always)]
fn fold(u: f32) -> (f32, f32) {
    if u < 0.5 { (-1.0, 1.0 - 2.0 * u) } else { (1.0, 2.0 * u - 1.0) }
}

/// Straight lines between the values of an even function at the ends of equal cells of `[0, radius]`.
///
/// A cell in which the sign changes is short enough (1/2048 of the radius) to count as zero at the crossing's side:
/// there |f| is below a thousandth of the peak.
#[derive(Debug)]
pub(super) struct Table {
    radius: f32,
    signed: bool,
    /// Values at the ends of cells, normalised to integrate to 1 over the whole axis.
    values: Vec<f32>,
    /// Integral of |f| from 0 to the end of each cell over that to the radius.
    cdf: Vec<f32>,
    /// First cell whose cdf exceeds k / CELLS.
    start: Vec<u16>,
}

impl Table {
    /// Tabulates `f` over `[0, radius]`.
    pub fn new(radius: f32, f: impl Fn(f64) -> f64) -> Self {
        let step = f64::from(radius) / CELLS as f64;
        let mut values: Vec<f64> = (0..=CELLS).map(|k| f(k as f64 * step)).collect();
        let area = |a: f64, b: f64| 0.5 * step * (a + b);
        let integral: f64 = 2.0 * values.windows(2).map(|w| area(w[0], w[1])).sum::<f64>();
        values.iter_mut().for_each(|v| *v /= integral);
        let mut sum = 0.0;
        let cumulative: Vec<f64> = values
            .windows(2)
            .map(|w| {
                sum += area(w[0].abs(), w[1].abs());
                sum
            })
            .collect();
        let cdf: Vec<f32> = cumulative.iter().map(|c| (c / sum) as f32).collect();
        let first = |k: usize| {
            cdf.partition_point(|&c| f64::from(c) * CELLS as f64 <= k as f64).min(CELLS - 1) as u16
        };
        Self {
            radius,
            signed: values.iter().any(|&v| v < 0.0),
            start: (0..CELLS).map(first).collect(),
            values: values.iter().map(|&v| v as f32).collect(),
            cdf,
        }
    }

    #[inline]
    fn sample(&self, u: f32) -> (f32, f32) {
        let (side, v) = fold(u);
        let mut cell = usize::from(self.start[((v * CELLS as f32) as usize).min(CELLS - 1)]);
        while cell + 1 < CELLS && self.cdf[cell] <= v {
            cell += 1;
        }
        let below = if cell == 0 { 0.0 } else { self.cdf[cell - 1] };
        let part = ((v - below) / (self.cdf[cell] - below)).clamp(0.0, 1.0);
        let (a, b) = (self.values[cell], self.values[cell + 1]);
        let x = (cell as f32 + linear(a.abs(), b.abs(), part)) * (self.radius / CELLS as f32);
        (side * x.min(self.radius), if a + b < 0.0 { -1.0 } else { 1.0 })
    }

    fn eval(&self, x: f32) -> f32 {
        let t = x.abs() / self.radius * CELLS as f32;
        if t >= CELLS as f32 {
            return 0.0;
        }
        let cell = t as usize;
        let (a, b) = (self.values[cell], self.values[cell + 1]);
        a + (b - a) * (t - cell as f32)
    }
}

/// A number in [0, 1] with density proportional to the line from `a` to `b` (both >= 0).
#[inline(always)]
fn linear(a: f32, b: f32, u: f32) -> f32 {
    let root = (a * a + u * (b * b - a * a)).max(0.0).sqrt();
    if a + root > 0.0 { (u * (a + b) / (a + root)).min(1.0) } else { u }
}
