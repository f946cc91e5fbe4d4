//! The Trowbridge-Reitz (GGX) distribution of microfacet normals, anisotropic.
//!
//! `D(m) = 1 / (pi a_x a_y (m_x^2/a_x^2 + m_y^2/a_y^2 + m_z^2)^2)` \[1/sr\], with Smith's masking
//! `Lambda(w) = (sqrt(1 + (a_x^2 w_x^2 + a_y^2 w_y^2) / w_z^2) - 1) / 2`. Light that meets the surface more than once
//! is not accounted for: rough models built on it lose that energy (some 20 % at alpha = 1), as pbrt-v4's do.
//! Sources: Trowbridge & Reitz 1975; Walter et al. 2007; Heitz 2014 (eq. 72, 85, 86, 99).

use std::f32::consts::{FRAC_1_PI, TAU};
use tyndall_base::math::sin_cos;
use tyndall_base::vec::{Vec3, vec3};

/// Below this alpha a surface is treated as perfectly smooth.
const SMOOTH_ALPHA: f32 = 1e-3;

/// Roughness along the two axes of the shading frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrowbridgeReitz {
    /// Roughness along x.
    pub alpha_x: f32,
    /// Roughness along y.
    pub alpha_y: f32,
}

impl TrowbridgeReitz {
    /// A perfectly smooth surface.
    pub const SMOOTH: Self = Self { alpha_x: 0.0, alpha_y: 0.0 };

    /// From the widths of the slope distribution; where one axis is rough the other is at least 1e-4.
    #[inline(always)]
    pub fn new(alpha_x: f32, alpha_y: f32) -> Self {
        let d = Self { alpha_x, alpha_y };
        if d.is_smooth() { d } else { Self { alpha_x: alpha_x.max(1e-4), alpha_y: alpha_y.max(1e-4) } }
    }

    /// pbrt-v4's `remaproughness`: `alpha = sqrt(roughness)`.
    #[inline(always)]
    pub fn roughness_to_alpha(roughness: f32) -> f32 {
        roughness.sqrt()
    }

    /// True when models should scatter as a delta distribution.
    #[inline(always)]
    pub fn is_smooth(&self) -> bool {
        self.alpha_x.max(self.alpha_y) < SMOOTH_ALPHA
    }

    /// Widens narrow distributions, as pbrt-v4 does after the first non-specular bounce: biased, only on request.
    #[inline(always)]
    pub fn regularized(self) -> Self {
        let widen = |a: f32| if a < 0.3 { (2.0 * a).clamp(0.1, 0.3) } else { a };
        Self { alpha_x: widen(self.alpha_x), alpha_y: widen(self.alpha_y) }
    }

    /// Density of normals `D(m)` \[1/sr\], normalised by `int D(m) |m_z| dm = 1`.
    #[inline(always)]
    pub fn d(&self, m: Vec3) -> f32 {
        let (x, y) = (m.x / self.alpha_x, m.y / self.alpha_y);
        let e = x * x + y * y + m.z * m.z;
        FRAC_1_PI / (self.alpha_x * self.alpha_y * e * e)
    }

    /// `sqrt(1 + tan^2 alpha^2) |w_z| = (1 + 2 Lambda) |w_z|`, finite at grazing angles.
    #[inline(always)]
    fn stretched_length(&self, w: Vec3) -> f32 {
        let (x, y) = (self.alpha_x * w.x, self.alpha_y * w.y);
        (x * x + y * y + w.z * w.z).sqrt()
    }

    /// `G1(w) / |w_z|` of Smith's masking.
    #[inline(always)]
    pub fn g1_over_cos(&self, w: Vec3) -> f32 {
        2.0 / (w.z.abs() + self.stretched_length(w))
    }

    /// `G(wo, wi) / (|wo_z| |wi_z|) = 1 / ((1 + Lambda(wo) + Lambda(wi)) |wo_z| |wi_z|)`, height-correlated.
    #[inline(always)]
    pub fn g_over_cos_cos(&self, wo: Vec3, wi: Vec3) -> f32 {
        let (co, ci) = (wo.z.abs(), wi.z.abs());
        2.0 / (self.stretched_length(wo) * ci + self.stretched_length(wi) * co)
    }

    /// Density of the normals seen from `w`, `G1(w) max(0, w . m) D(m) / |w_z|` \[1/sr\].
    #[inline(always)]
    pub fn pdf_visible(&self, w: Vec3, m: Vec3) -> f32 {
        self.g1_over_cos(w) * w.abs_dot(m) * self.d(m)
    }

    /// Draws a normal `m` (`m_z >= 0`) with density [`pdf_visible`](Self::pdf_visible).
    ///
    /// The reflected directions of a hemisphere lit from `w` fill a spherical cap (Dupuy & Benyoub 2023, listing 3).
    #[inline(always)]
    pub fn sample_visible(&self, w: Vec3, u: [f32; 2]) -> Vec3 {
        let w = if w.z < 0.0 { -w } else { w };
        let stretched = vec3(self.alpha_x * w.x, self.alpha_y * w.y, w.z).normalize();
        let (sin_phi, cos_phi) = sin_cos(TAU * u[0]);
        let z = (1.0 - u[1]) * (1.0 + stretched.z) - stretched.z;
        let r = (1.0 - z * z).max(0.0).sqrt();
        let h = vec3(r * cos_phi, r * sin_phi, z) + stretched;
        vec3(self.alpha_x * h.x, self.alpha_y * h.y, h.z.max(0.0)).normalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere_tests::{chi2_square, integrate_square, turn};
    use std::f64::consts::{PI, TAU as TURN};
    use tyndall_testkit::{Rng, chi2_1d};

    const ALPHAS: [(f32, f32); 5] = [(0.002, 0.002), (0.05, 0.05), (0.1, 0.4), (0.5, 0.5), (1.0, 0.3)];

    fn views() -> [Vec3; 5] {
        [(0.0, 0.0, 1.0), (0.5, 0.3, 0.8), (-0.7, 0.7, 0.1), (0.2, 0.9, 0.02), (0.3, -0.4, -0.5)]
            .map(|(x, y, z)| vec3(x, y, z).normalize())
    }

    /// Normals by slope: `-m_x / m_z = a_x r cos phi`, `-m_y / m_z = a_y r sin phi`, `1 + r^2 = 1 / (1 - x)^2`, where
    /// `D m_z dm = (1 - x) dx dphi / pi`: every lobe looks alike.
    fn normal(d: &TrowbridgeReitz, x: f64, phi: f64) -> [f64; 3] {
        let r = (1.0 / ((1.0 - x) * (1.0 - x)) - 1.0).sqrt();
        let (sx, sy) = (f64::from(d.alpha_x) * r * phi.cos(), f64::from(d.alpha_y) * r * phi.sin());
        let z = 1.0 / (1.0 + sx * sx + sy * sy).sqrt();
        [-sx * z, -sy * z, z]
    }

    /// `dm / (dx dphi)`.
    fn jacobian(d: &TrowbridgeReitz, x: f64, z: f64) -> f64 {
        f64::from(d.alpha_x * d.alpha_y) * (z / (1.0 - x)).powi(3)
    }

    #[test]
    fn normals_project_to_one() {
        for (ax, ay) in ALPHAS {
            let d = TrowbridgeReitz::new(ax, ay);
            for (x, phi) in [(0.0, 0.0), (0.3, 1.0), (0.9, 4.0), (0.999, 2.0)] {
                let m = normal(&d, x, phi);
                let density = f64::from(d.d(vec3(m[0] as f32, m[1] as f32, m[2] as f32)));
                let projected = PI * density * m[2] * jacobian(&d, x, m[2]) / (1.0 - x);
                assert!((projected - 1.0).abs() < 1e-3, "{ax} {ay} at {x}, {phi}: {projected}");
            }
        }
    }

    /// `int G1(w) max(0, w . m) D(m) dm = |w_z|` (Heitz 2014, eq. 14), and the sampler follows the integrand.
    #[test]
    fn visible_normals_are_a_density_and_are_sampled_by_it() {
        for (ax, ay) in ALPHAS {
            let d = TrowbridgeReitz::new(ax, ay);
            for w in views() {
                let up = if w.z < 0.0 { -w } else { w };
                let pdf = |x: f64, phi: f64| {
                    let m = normal(&d, x, phi);
                    let seen = vec3(m[0] as f32, m[1] as f32, m[2] as f32);
                    if up.dot(seen) > 0.0 {
                        f64::from(d.pdf_visible(w, seen)) * jacobian(&d, x, m[2])
                    } else {
                        0.0
                    }
                };
                let square = |x: f64, turn: f64| TURN * pdf(x, TURN * turn);
                let norm = integrate_square(square);
                assert!((norm - 1.0).abs() < 1e-4, "alpha {ax} {ay}, w {w:?}: {norm}");
                let draw = |rng: &mut Rng| {
                    let m = d.sample_visible(w, rng.f32x2());
                    let (sx, sy) = (f64::from(-m.x / m.z / ax), f64::from(-m.y / m.z / ay));
                    let r2 = sx * sx + sy * sy;
                    Some([1.0 - 1.0 / (1.0 + r2).sqrt(), turn(sy, sx)])
                };
                chi2_square(draw, square, 50_000, 8).assert_ok(&format!("alpha {ax} {ay}, w {w:?}"), 25);
            }
        }
    }

    /// Narrow lobes in the plane of slopes, scaled by alpha: from above, slopes follow `1 / (pi (1 + r^2)^2)`.
    #[test]
    fn narrow_lobes_keep_their_shape() {
        for alpha in [1e-3_f32, 1e-2] {
            let d = TrowbridgeReitz::new(alpha, alpha);
            let radius2 = |rng: &mut Rng| {
                let m = d.sample_visible(vec3(0.0, 0.0, 1.0), rng.f32x2());
                let r2 = f64::from(m.x * m.x + m.y * m.y) / f64::from(m.z * m.z * alpha * alpha);
                Some(r2 / (1.0 + r2))
            };
            chi2_1d(radius2, |_| 1.0, [0.0, 1.0], 50_000, 2).assert_ok("slopes", 2);
        }
    }

    #[test]
    fn smooth_below_a_thousandth() {
        assert!(TrowbridgeReitz::new(9e-4, 9e-4).is_smooth() && !TrowbridgeReitz::new(0.0, 0.1).is_smooth());
        assert_eq!(TrowbridgeReitz::new(0.0, 0.1).alpha_x, 1e-4);
        assert_eq!(TrowbridgeReitz::roughness_to_alpha(0.25), 0.5);
    }
}
