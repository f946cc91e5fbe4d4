//! Integrals of smooth functions in double precision, for tables and tests.

use crate::math::f64::cos;
use std::f64::consts::PI;

/// Gauss-Legendre rule on `[-1, 1]`: exact for polynomials of degree below `2 n`.
#[derive(Clone, Debug)]
pub struct GaussLegendre {
    nodes: Vec<(f64, f64)>,
}

impl GaussLegendre {
    /// The rule of `n >= 1` points, by Newton's method on the Legendre polynomial (Abramowitz & Stegun 25.4.29, 22.16.6).
    pub fn new(n: usize) -> Self {
        assert!(n > 0, "a quadrature rule needs at least one node");
        let node = |i: usize| {
            let mut x = -cos(PI * (i as f64 + 0.75) / (n as f64 + 0.5));
            for _ in 0..6 {
                let (p, derivative) = legendre(n, x);
                x -= p / derivative;
            }
            let (_, derivative) = legendre(n, x);
            (x, 2.0 / ((1.0 - x * x) * derivative * derivative))
        };
        Self { nodes: (0..n).map(node).collect() }
    }

    /// Pairs of node and weight, nodes ascending in `(-1, 1)`, weights summing to 2.
    pub fn nodes(&self) -> &[(f64, f64)] {
        &self.nodes
    }

    /// Integral of `f` over `[a, b]`.
    pub fn integrate(&self, f: impl Fn(f64) -> f64, a: f64, b: f64) -> f64 {
        let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
        self.nodes.iter().map(|&(x, w)| w * f(middle + half * x)).sum::<f64>() * half
    }
}

/// `P_n(x)` and its derivative by the three-term recurrence.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut before, mut p) = (1.0, x);
    for k in 2..=n {
        let k = k as f64;
        (before, p) = (p, ((2.0 * k - 1.0) * x * p - (k - 1.0) * before) / k);
    }
    (p, n as f64 * (x * p - before) / (x * x - 1.0))
}

/// Composite Simpson rule with `n` pairs of intervals.
pub fn simpson(f: impl Fn(f64) -> f64, a: f64, b: f64, n: usize) -> f64 {
    let h = (b - a) / (2 * n) as f64;
    let at = |i: usize| f(a + h * i as f64);
    let odd: f64 = (0..n).map(|i| at(2 * i + 1)).sum();
    let even: f64 = (1..n).map(|i| at(2 * i)).sum();
    h / 3.0 * (at(0) + 4.0 * odd + 2.0 * even + at(2 * n))
}

/// Integral of `f` over `[a, b]` by bisection until two Gauss rules (7 and 15 points) agree to `tolerance` (absolute) in each
/// part's share, at most 50 levels deep.
pub fn adaptive(f: impl Fn(f64) -> f64, a: f64, b: f64, tolerance: f64) -> f64 {
    refine(&f, [&GaussLegendre::new(7), &GaussLegendre::new(15)], [a, b], tolerance, 50)
}

fn refine(
    f: &impl Fn(f64) -> f64,
    rules: [&GaussLegendre; 2],
    [a, b]: [f64; 2],
    tolerance: f64,
    depth: u32,
) -> f64 {
    let [coarse, fine] = rules.map(|rule| rule.integrate(f, a, b));
    if depth == 0 || (coarse - fine).abs() <= tolerance {
        return fine;
    }
    let middle = 0.5 * (a + b);
    refine(f, rules, [a, middle], 0.5 * tolerance, depth - 1)
        + refine(f, rules, [middle, b], 0.5 * tolerance, depth - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gauss_is_exact_to_degree_2n_minus_1() {
        for n in [1, 2, 5, 20, 64] {
            let rule = GaussLegendre::new(n);
            assert!((rule.nodes().iter().map(|n| n.1).sum::<f64>() - 2.0).abs() < 1e-13);
            for degree in 0..2 * n {
                let integral = rule.integrate(|x| x.powi(degree as i32), 0.0, 1.0);
                assert!((integral - 1.0 / (degree as f64 + 1.0)).abs() < 1e-13, "n {n}, degree {degree}");
            }
            let beyond = rule.integrate(|x| x.powi(2 * n as i32), -1.0, 1.0);
            assert!(n > 20 || (beyond - 2.0 / (2.0 * n as f64 + 1.0)).abs() > 1e-13, "n {n}");
        }
    }

    #[test]
    fn nodes_of_five_points_are_the_tabulated_ones() {
        // Abramowitz & Stegun, table 25.4
        let expected = [
            (-0.906_179_845_938_664, 0.236_926_885_056_189),
            (-0.538_469_310_105_683, 0.478_628_670_499_366),
        ];
        for (ours, table) in GaussLegendre::new(5).nodes().iter().zip(expected) {
            assert!((ours.0 - table.0).abs() < 1e-14 && (ours.1 - table.1).abs() < 1e-14);
        }
    }

    #[test]
    fn simpson_converges_at_fourth_order() {
        let error = |n| (simpson(f64::exp, 0.0, 1.0, n) - (1.0_f64.exp() - 1.0)).abs();
        assert!((error(8) / error(16) - 16.0).abs() < 0.5);
        assert!((simpson(|x| x * x * x, 0.0, 2.0, 1) - 4.0).abs() < 1e-14);
    }

    #[test]
    fn adaptive_finds_narrow_peaks_and_jumps() {
        let peak = |x: f64| 1e-3 / (1e-6 + (x - 0.3) * (x - 0.3));
        let exact = (0.7e3_f64).atan() + (0.3e3_f64).atan();
        assert!((adaptive(peak, 0.0, 1.0, 1e-10) - exact).abs() < 1e-9);
        assert!((adaptive(|x| f64::from(u8::from(x > 0.123)), 0.0, 1.0, 1e-9) - 0.877).abs() < 1e-8);
    }
}
