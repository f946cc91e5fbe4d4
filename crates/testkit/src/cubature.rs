//! Adaptive Gauss cubature over rectangles: bins of a histogram, with densities that may peak or jump inside them.

/// Nodes and weights of the 5-point Gauss-Legendre rule on `[-1, 1]` (Abramowitz & Stegun, table 25.4).
const GAUSS: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

pub(crate) fn gauss_1d(f: &dyn Fn(f64) -> f64, a: f64, b: f64) -> f64 {
    let (m, h) = (0.5 * (a + b), 0.5 * (b - a));
    GAUSS.iter().map(|(x, w)| w * f(m + h * x)).sum::<f64>() * h
}

/// Integral of `f` over `[a, b]` to about `tolerance`, by bisection.
pub fn integrate_1d(f: &dyn Fn(f64) -> f64, a: f64, b: f64, tolerance: f64) -> f64 {
    refine_1d(f, a, b, gauss_1d(f, a, b), tolerance, 40)
}

fn refine_1d(f: &dyn Fn(f64) -> f64, a: f64, b: f64, whole: f64, tolerance: f64, depth: u32) -> f64 {
    let m = 0.5 * (a + b);
    let (left, right) = (gauss_1d(f, a, m), gauss_1d(f, m, b));
    if depth == 0 || (left + right - whole).abs() <= tolerance {
        return left + right;
    }
    refine_1d(f, a, m, left, 0.5 * tolerance, depth - 1)
        + refine_1d(f, m, b, right, 0.5 * tolerance, depth - 1)
}

pub(crate) fn gauss_2d(f: &dyn Fn(f64, f64) -> f64, x: [f64; 2], y: [f64; 2]) -> f64 {
    gauss_1d(&|s| gauss_1d(&|t| f(s, t), y[0], y[1]), x[0], x[1])
}

/// Integral of `f` over a rectangle to about `tolerance`, by quartering; edges of jumps are followed ten levels deep.
///
/// Features narrower than a twentieth of the sides may be overlooked. The tolerance halves with each level: where `f` is smooth the rule gains far more, and the parts that a line of jumps
/// crosses double.
pub fn integrate_2d(f: &dyn Fn(f64, f64) -> f64, x: [f64; 2], y: [f64; 2], tolerance: f64) -> f64 {
    refine_2d(f, x, y, gauss_2d(f, x, y), tolerance, 10)
}

fn refine_2d(
    f: &dyn Fn(f64, f64) -> f64,
    x: [f64; 2],
    y: [f64; 2],
    whole: f64,
    tolerance: f64,
    depth: u32,
) -> f64 {
    let (mx, my) = (0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1]));
    let quarters = [
        ([x[0], mx], [y[0], my]),
        ([mx, x[1]], [y[0], my]),
        ([x[0], mx], [my, y[1]]),
        ([mx, x[1]], [my, y[1]]),
    ];
    let parts = quarters.map(|(x, y)| gauss_2d(f, x, y));
    let sum: f64 = parts.iter().sum();
    if depth == 0 || (sum - whole).abs() <= tolerance {
        return sum;
    }
    quarters
        .iter()
        .zip(parts)
        .map(|((x, y), part)| refine_2d(f, *x, *y, part, 0.5 * tolerance, depth - 1))
        .sum()
}

/// The unit vector with height `z` and azimuth `phi` about the third axis.
pub(crate) fn direction(z: f64, phi: f64) -> [f32; 3] {
    let r = (1.0 - z * z).max(0.0).sqrt();
    let (sin, cos) = phi.sin_cos();
    [(r * cos) as f32, (r * sin) as f32, z as f32]
}

/// Integral of `f` over the sphere of directions to about `tolerance` (1 for a density: the norm).
pub fn integrate_sphere(f: &dyn Fn([f32; 3]) -> f64, tolerance: f64) -> f64 {
    let g = |z: f64, phi: f64| f(direction(z, phi));
    let n = 16;
    let cells = (0..n * n).map(|i| {
        let (a, b) = ((i / n) as f64 / n as f64, (i % n) as f64 / n as f64);
        let step = 1.0 / n as f64;
        let tau = std::f64::consts::TAU;
        integrate_2d(
            &g,
            [2.0 * a - 1.0, 2.0 * (a + step) - 1.0],
            [tau * b, tau * (b + step)],
            tolerance * step * step,
        )
    });
    cells.sum()
}
