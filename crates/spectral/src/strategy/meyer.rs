//! Meyer's four wavelengths: a Gaussian quadrature in an opponent space of colour vision.
//!
//! G. W. Meyer, "Wavelength selection for synthetic image generation", Computer Vision, Graphics, and Image Processing
//! 41, 1988. With `(A, C1, C2) = M (X, Y, Z)` the responses `a, c1, c2 = M (xbar, ybar, zbar)` are weights of integrals that
//! Gauss's rules approximate from few wavelengths: the achromatic A, which carries most of a picture, from three, C1 from
//! two, C2 from one. A's outer nodes (483.0 and 632.4 nm) are moved to those of C1 close by, so that four wavelengths
//! serve all three:
//!
//! ```text
//! C2: the node of its one-point rule                    456.4 nm, weight its integral
//! C1: the nodes and weights of its two-point rule       490.9, 631.5 nm
//! A:  the middle node of its three-point rule, 557.8 nm, and the nodes of C1; weights that keep its moments 0, 1, 2
//! ```
//!
//! The numbers are computed here from the CIE 1931 tables of this crate at 1 nm. The publication's, as commonly quoted
//! (456.4, 490.9, 557.7, 631.4 nm; weights over 101: C2 .54640; C1 .31824, -.46008; A .18892, .67493, .19253), agree to
//! 0.1 nm and to 0.001, as a test shows.

use crate::{cie, colour::Matrix3};

/// `(A, C1, C2)` from `(X, Y, Z)` (Meyer 1988).
const OPPONENT: Matrix3 =
    Matrix3([[-0.0177, 1.0090, 0.0073], [-1.5370, 1.0821, 0.3209], [0.1946, -0.2045, 0.5264]]);
/// Moments are taken about this wavelength and in this unit \[nm\], so that they stay of order one.
const CENTRE: f64 = 550.0;
const UNIT: f64 = 100.0;

/// The four wavelengths and what radiance there adds to X, Y and Z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meyer {
    /// Ascending \[nm\].
    pub lambda: [f64; 4],
    /// Weights of A, C1 and C2 at each wavelength \[nm\].
    pub opponent: [[f64; 3]; 4],
    /// Weights of X, Y and Z at each wavelength \[nm\].
    pub xyz: [[f64; 3]; 4],
}

impl Meyer {
    /// Derives the rule.
    pub fn derive() -> Self {
        let (a, c1, c2) = (moments(0), moments(1), moments(2));
        let node_c2 = c2[1] / c2[0];
        let [low, high] = quadratic(two_points(&c1));
        // the middle node of A by bisection between its neighbours: p3 changes its sign there
        let p3 = three_points(&a);
        let middle = bisect(|x| ((x + p3[2]) * x + p3[1]) * x + p3[0], low, high);
        let weight_high = (c1[1] - low * c1[0]) / (high - low);
        let of_a = solve3([low, middle, high], [a[0], a[1], a[2]]);
        let opponent = [
            [0.0, 0.0, c2[0]],
            [of_a[0], c1[0] - weight_high, 0.0],
            [of_a[1], 0.0, 0.0],
            [of_a[2], weight_high, 0.0],
        ];
        let back = OPPONENT.inverse().expect("the opponent matrix is regular");
        let lambda = [node_c2, low, middle, high].map(|x| CENTRE + UNIT * x);
        Self { lambda, opponent, xyz: opponent.map(|row| back.apply(row)) }
    }
}

/// Moments 0 to 5 of one opponent response over the whole nanometres from 360 to 830.
fn moments(channel: usize) -> [f64; 6] {
    let mut sum = [0.0; 6];
    for nm in 360u16..=830 {
        let bars = cie::matching_functions().each_ref().map(|c| f64::from(c.eval(f32::from(nm))));
        let (response, x) = (OPPONENT.apply(bars)[channel], (f64::from(nm) - CENTRE) / UNIT);
        let mut power = response;
        for s in &mut sum {
            *s += power;
            power *= x;
        }
    }
    sum
}

/// Coefficients `[p0, p1]` of the monic polynomial of degree 2 that is orthogonal to 1 and x.
fn two_points(m: &[f64; 6]) -> [f64; 2] {
    let det = m[0] * m[2] - m[1] * m[1];
    [(m[1] * m[3] - m[2] * m[2]) / det, (m[1] * m[2] - m[0] * m[3]) / det]
}

/// Coefficients `[p0, p1, p2]` of the monic polynomial of degree 3 that is orthogonal to 1, x and x^2.
fn three_points(m: &[f64; 6]) -> [f64; 3] {
    let h = Matrix3([[m[0], m[1], m[2]], [m[1], m[2], m[3]], [m[2], m[3], m[4]]]);
    h.inverse().expect("a response of one sign has three orthogonal polynomials").apply([-m[3], -m[4], -m[5]])
}

/// The roots of `x^2 + p1 x + p0`, ascending.
fn quadratic([p0, p1]: [f64; 2]) -> [f64; 2] {
    let root = (0.25 * p1 * p1 - p0).sqrt();
    [-0.5 * p1 - root, -0.5 * p1 + root]
}

/// The root of `f` between `low` and `high`, where its signs differ.
fn bisect(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let sign = f(low) > 0.0;
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if (f(middle) > 0.0) == sign {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Weights at `x` that give the moments `m`.
fn solve3(x: [f64; 3], m: [f64; 3]) -> [f64; 3] {
    let vandermonde = Matrix3([[1.0; 3], x, x.map(|v| v * v)]);
    vandermonde.inverse().expect("three different nodes").apply(m)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{colour::chromaticity, curve::Curve, illuminant::illuminant, range::Outside};

    /// The publication's numbers come out of the colour matching functions.
    #[test]
    fn the_published_rule_is_derived() {
        let m = Meyer::derive();
        for (got, published) in m.lambda.iter().zip([456.4, 490.9, 557.7, 631.4]) {
            assert!((got - published).abs() < 0.1, "{got} {published}");
        }
        let published =
            [[0.0, 0.0, 0.54640], [0.18892, 0.31824, 0.0], [0.67493, 0.0, 0.0], [0.19253, -0.46008, 0.0]];
        for (got, published) in m.opponent.iter().flatten().zip(published.iter().flatten()) {
            assert!((got / 101.0 - published).abs() < 1e-3, "{} {published}", got / 101.0);
        }
    }

    /// Each of A, C1, C2 is exact for polynomials up to the degree that its nodes allow.
    #[test]
    fn moments_are_kept() {
        let m = Meyer::derive();
        for (channel, degree) in [(0, 2), (1, 3), (2, 1)] {
            let exact = moments(channel);
            for (power, exact) in exact.iter().enumerate().take(degree + 1) {
                let x = m.lambda.map(|l| (l - CENTRE) / UNIT);
                let sum: f64 = (0..4).map(|i| m.opponent[i][channel] * x[i].powi(power as i32)).sum();
                assert!(
                    (sum - exact).abs() < 1e-9 * exact.abs().max(1.0),
                    "{channel} {power}: {sum} {exact}"
                );
            }
        }
    }

    /// Daylight on smooth reflectances: chromaticities to 0.02, as the rule is for.
    #[test]
    fn smooth_spectra_keep_their_colour() {
        let m = Meyer::derive();
        let d65 = illuminant("D65", Outside::Error).unwrap();
        let ramp = |a: f32, b: f32| Curve::linear(&[360.0, 830.0], &[a, b], Outside::Error).unwrap();
        for curve in [Curve::ONE, ramp(0.1, 0.9), ramp(0.9, 0.1)] {
            let light = d65.times(&curve);
            let exact = cie::xyz(&light);
            let mut sum = [0.0; 3];
            for (lambda, row) in m.lambda.iter().zip(&m.xyz) {
                (0..3).for_each(|c| sum[c] += row[c] * f64::from(light.eval(*lambda as f32)));
            }
            let (got, exact_xy) = (chromaticity(sum), chromaticity(exact));
            for (g, e) in got.iter().zip(exact_xy) {
                assert!((g - e).abs() < 0.02, "{got:?} {exact_xy:?}");
            }
            assert!((sum[1] / exact[1] - 1.0).abs() < 0.05, "{} {}", sum[1], exact[1]);
        }
    }
}
