//! Smooth reflectances from three numbers: a sigmoid of a quadratic in wavelength.
//!
//! `S(lambda) = 1/2 + x / (2 sqrt(1 + x^2))`, `x = c[0] t^2 + c[1] t + c[2]`, `t = (lambda - 360 nm) / 470 nm`.
//! Source: Jakob, Hanika, "A low-dimensional function space for efficient spectral upsampling", Computer Graphics
//! Forum 38(2), 2019. The polynomial is kept in `t` because its terms are then of like size and `f32` suffices.

use crate::range::LambdaRange;

/// Coefficients of the quadratic; the value lies in \[0, 1\] at every wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SigmoidPolynomial {
    /// Factors of `t^2`, `t` and `1`.
    pub c: [f32; 3],
}

const T_PER_NM: f32 = 1.0 / 470.0;
/// Beyond this the sigmoid is 0 or 1 in `f32`; it keeps `x * x` finite.
const X_LIMIT: f32 = 1e9;

impl SigmoidPolynomial {
    /// The same value `v` in \[0, 1\] at every wavelength.
    pub fn constant(v: f32) -> Self {
        let y = 2.0 * v - 1.0;
        let x = (y / (1.0 - y * y).max(0.0).sqrt()).clamp(-X_LIMIT, X_LIMIT);
        Self { c: [0.0, 0.0, x] }
    }

    /// Value at `lambda` \[nm\].
    #[inline(always)]
    pub fn eval(&self, lambda: f32) -> f32 {
        let t = (lambda - 360.0) * T_PER_NM;
        sigmoid((self.c[0] * t + self.c[1]) * t + self.c[2])
    }

    /// Least and greatest value on `range`: at its ends or at the vertex of the quadratic.
    pub fn bounds(&self, range: LambdaRange) -> [f32; 2] {
        let vertex = 360.0 - 470.0 * self.c[1] / (2.0 * self.c[0]);
        let mut bounds = [f32::INFINITY, f32::NEG_INFINITY];
        let inside = (vertex.is_finite() && range.contains(vertex)).then_some(vertex);
        for l in [Some(range.min), Some(range.max), inside].into_iter().flatten() {
            let v = self.eval(l);
            bounds = [bounds[0].min(v), bounds[1].max(v)];
        }
        bounds
    }
}

/// `1/2 + x / (2 sqrt(1 + x^2))`.
#[inline(always)]
fn sigmoid(x: f32) -> f32 {
    let x = x.clamp(-X_LIMIT, X_LIMIT);
    0.5 + 0.5 * x / (1.0 + x * x).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constants_come_back() {
        for v in [0.0f32, 1e-4, 0.18, 0.5, 0.9, 1.0] {
            let s = SigmoidPolynomial::constant(v);
            assert!((s.eval(400.0) - v).abs() < 1e-6 && (s.eval(700.0) - v).abs() < 1e-6, "{v}");
        }
    }

    #[test]
    fn bounds_hold_on_a_fine_grid_and_huge_coefficients_stay_finite() {
        let range = LambdaRange { min: 380.0, max: 780.0 };
        for c in [[20.0, -18.0, 3.0], [-9.0, 8.0, -1.0], [0.0, 4.0, -2.0], [1e30, -1e30, 1e29]] {
            let s = SigmoidPolynomial { c };
            let [low, high] = s.bounds(range);
            for i in 0..=4000 {
                let v = s.eval(380.0 + 0.1 * i as f32);
                assert!((0.0..=1.0).contains(&v));
                assert!(v >= low - 1e-6 && v <= high + 1e-6);
            }
        }
    }
}
