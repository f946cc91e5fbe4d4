use crate::cubature::{direction, gauss_1d, gauss_2d, integrate_1d, integrate_2d};
use crate::distribution::chi2_upper;
use crate::family::{ALPHA, sidak};
use crate::rng::Rng;
use std::f64::consts::TAU;

/// The outcome of Pearson's test of goodness of fit.
#[derive(Clone, Copy, Debug)]
#[must_use]
pub struct ChiSquare {
    /// `sum (observed - expected)^2 / expected` over the pooled cells.
    pub statistic: f64,
    /// Degrees of freedom: pooled cells less one.
    pub dof: f64,
    /// The chance of a statistic at least as large.
    pub p: f64,
}

impl ChiSquare {
    /// Panics when the null hypothesis falls at [`ALPHA`], shared over a family of `tests`.
    #[track_caller]
    pub fn assert_ok(self, name: &str, tests: usize) {
        let level = sidak(ALPHA, tests);
        let Self { statistic, dof, p } = self;
        assert!(
            p > level,
            "{name}: chi^2 = {statistic:.1} with {dof} degrees of freedom, p = {p:.3e} <= {level:.1e}"
        );
    }
}

/// Pearson's test of counts against their expectations; the smallest cells are pooled until each holds `min_expected`
/// (5 is customary).
///
/// A sampler that enters a cell of zero expectation fails outright (p = 0).
pub fn chi2_test(observed: &[f64], expected: &[f64], min_expected: f64) -> ChiSquare {
    assert_eq!(observed.len(), expected.len(), "as many observed as expected cells");
    let mut cells: Vec<(f64, f64)> = expected.iter().copied().zip(observed.iter().copied()).collect();
    let impossible = cells.iter().any(|&(e, o)| e <= 0.0 && o > 0.0 || !e.is_finite());
    cells.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut statistic, mut pooled, mut count) = (0.0, (0.0, 0.0), 0_u32);
    for (e, o) in cells {
        pooled = (pooled.0 + e, pooled.1 + o);
        if pooled.0 >= min_expected {
            statistic += (pooled.1 - pooled.0) * (pooled.1 - pooled.0) / pooled.0;
            count += 1;
            pooled = (0.0, 0.0);
        }
    }
    assert!(
        count > 1,
        "chi-square needs two cells of at least {min_expected}, got {count}: draw more samples"
    );
    let dof = f64::from(count - 1);
    ChiSquare { statistic, dof, p: if impossible { 0.0 } else { chi2_upper(statistic, dof) } }
}

/// Counts `n` draws into `mass.len()` bins and one more for `None`, whose expectation is the mass the bins lack.
///
/// A bin that was hit although its mass came out as zero is integrated again by `closely`: quadrature overlooks corners.
fn test_bins(
    mut draw: impl FnMut(&mut Rng) -> Option<usize>,
    mut mass: Vec<f64>,
    closely: impl Fn(usize) -> f64,
    n: usize,
    seed: u64,
) -> ChiSquare {
    let mut rng = Rng::new(seed);
    let mut observed = vec![0.0; mass.len() + 1];
    for _ in 0..n {
        observed[draw(&mut rng).unwrap_or(mass.len())] += 1.0;
    }
    for bin in 0..mass.len() {
        if mass[bin] == 0.0 && observed[bin] > 0.0 {
            mass[bin] = closely(bin);
        }
    }
    let total: f64 = mass.iter().sum();
    assert!(total < 1.0 + 1e-4, "the density integrates to {total}, more than one");
    // what quadrature leaves of one below its tolerance is no mass, and a draw there is a fault
    let lost = if 1.0 - total > 1e-5 { 1.0 - total } else { 0.0 };
    let expected: Vec<f64> = mass.iter().copied().chain([lost]).map(|m| m * n as f64).collect();
    chi2_test(&observed, &expected, 5.0)
}

/// The bin of `x` among `n` over `[a, b]`; the right edge belongs to the last.
fn bin(x: f64, [a, b]: [f64; 2], n: usize) -> Option<usize> {
    (a..=b).contains(&x).then(|| (((x - a) / (b - a) * n as f64) as usize).min(n - 1))
}

/// The expectation of one bin may be wrong by this many counts, far below the noise of any test.
const TOLERANCE: f64 = 0.02;

/// Tests `n` draws of a discrete sampler (an index, or `None` for a rejected draw) against its probabilities.
pub fn chi2_discrete(
    draw: impl FnMut(&mut Rng) -> Option<usize>,
    pmf: &[f64],
    n: usize,
    seed: u64,
) -> ChiSquare {
    test_bins(draw, pmf.to_vec(), |_| 0.0, n, seed)
}

/// Tests `n` draws of a sampler on the line against its density, in 100 bins over `range`.
///
/// Draws outside the range and `None` share one cell that holds the mass the density lacks within the range.
pub fn chi2_1d(
    mut sample: impl FnMut(&mut Rng) -> Option<f64>,
    pdf: impl Fn(f64) -> f64,
    range: [f64; 2],
    n: usize,
    seed: u64,
) -> ChiSquare {
    const BINS: usize = 100;
    let edge = |i: usize| range[0] + (range[1] - range[0]) * i as f64 / BINS as f64;
    let tolerance = TOLERANCE / n as f64;
    let mass = (0..BINS).map(|i| integrate_1d(&pdf, edge(i), edge(i + 1), tolerance)).collect();
    let closely = |i: usize| split(edge(i), edge(i + 1)).map(|[a, b]| gauss_1d(&pdf, a, b)).sum();
    test_bins(|rng| sample(rng).and_then(|x| bin(x, range, BINS)), mass, closely, n, seed)
}

/// Tests `n` draws of a sampler in the plane against its density, in 32 x 32 bins over `x` by `y`.
///
/// Draws outside and `None` share one cell that holds the mass the density lacks within the rectangle.
pub fn chi2_2d(
    mut sample: impl FnMut(&mut Rng) -> Option<[f64; 2]>,
    pdf: impl Fn([f64; 2]) -> f64,
    [x, y]: [[f64; 2]; 2],
    n: usize,
    seed: u64,
) -> ChiSquare {
    const BINS: usize = 32;
    let f = |a: f64, b: f64| pdf([a, b]);
    let grid = Grid { f: &f, x, y, n: [BINS, BINS] };
    let place = |p: [f64; 2]| Some(bin(p[0], x, BINS)? * BINS + bin(p[1], y, BINS)?);
    test_bins(|rng| sample(rng).and_then(place), grid.mass(n), |i| grid.closely(i), n, seed)
}

/// Tests `n` draws of directions against their density per steradian, in 32 x 64 bins of equal solid angle.
///
/// `None` (a rejected draw) is a cell of its own that holds the mass the density lacks over the sphere: a sampler may
/// fail exactly as often as its density integrates to less than one.
pub fn chi2_sphere(
    mut sample: impl FnMut(&mut Rng) -> Option<[f32; 3]>,
    pdf: impl Fn([f32; 3]) -> f64,
    n: usize,
    seed: u64,
) -> ChiSquare {
    const RINGS: usize = 32;
    const SECTORS: usize = 64;
    let f = |z: f64, phi: f64| pdf(direction(z, phi));
    let grid = Grid { f: &f, x: [-1.0, 1.0], y: [0.0, TAU], n: [RINGS, SECTORS] };
    let place = |w: [f32; 3]| {
        let [x, y, z] = w.map(f64::from);
        let norm = (x * x + y * y + z * z).sqrt();
        assert!((norm - 1.0).abs() < 1e-4, "expected a unit vector, got {w:?} of length {norm}");
        let phi = y.atan2(x);
        let phi = if phi < 0.0 { phi + TAU } else { phi };
        let ring = bin((z / norm).clamp(-1.0, 1.0), [-1.0, 1.0], RINGS)?;
        Some(ring * SECTORS + bin(phi.min(TAU), [0.0, TAU], SECTORS)?)
    };
    test_bins(|rng| sample(rng).and_then(place), grid.mass(n), |i| grid.closely(i), n, seed)
}

/// The point `i / n` of the way along an interval.
fn edge([a, b]: [f64; 2], i: usize, n: usize) -> f64 {
    a + (b - a) * i as f64 / n as f64
}

/// Sixty-four equal parts of an interval.
fn split(a: f64, b: f64) -> impl Iterator<Item = [f64; 2]> {
    (0..64).map(move |i| [edge([a, b], i, 64), edge([a, b], i + 1, 64)])
}

/// A density over a rectangle of bins, the second index running fastest.
struct Grid<'f> {
    f: &'f dyn Fn(f64, f64) -> f64,
    x: [f64; 2],
    y: [f64; 2],
    n: [usize; 2],
}

impl Grid<'_> {
    fn bin(&self, index: usize) -> [[f64; 2]; 2] {
        let (i, j) = (index / self.n[1], index % self.n[1]);
        let side = |range, i, n| [edge(range, i, n), edge(range, i + 1, n)];
        [side(self.x, i, self.n[0]), side(self.y, j, self.n[1])]
    }

    /// Mass of each bin, precise enough for `draws`.
    fn mass(&self, draws: usize) -> Vec<f64> {
        let mass = |[x, y]: [[f64; 2]; 2]| integrate_2d(self.f, x, y, TOLERANCE / draws as f64);
        (0..self.n[0] * self.n[1]).map(|i| mass(self.bin(i))).collect()
    }

    /// Mass of one bin from a fine mesh.
    fn closely(&self, index: usize) -> f64 {
        let [[x0, x1], [y0, y1]] = self.bin(index);
        split(x0, x1)
            .flat_map(|x| split(y0, y1).map(move |y| (x, y)))
            .map(|(x, y)| gauss_2d(self.f, x, y))
            .sum()
    }
}
