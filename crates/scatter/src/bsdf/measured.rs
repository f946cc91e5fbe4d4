//! Measured reflection: `f = F(u, lambda) D(h) / (4 sigma(wo) cos wi)` \[1/sr\], all of them tables.
//!
//! Dupuy, Jakob 2018, "An adaptive parameterization for efficient material acquisition and rendering". The half vector h lies
//! in the unit square by (sqrt(2 theta / pi), phi / 2 pi + 1/2); u is what the inverse of drawing visible normals makes of it.
//! Directions are drawn by the measured luminance of u, then by the visible normals. Both sides reflect, as in pbrt.

mod grid2d;

pub use grid2d::Grid2d;

use super::{BsdfFlags, BsdfSample};
use std::f32::consts::{FRAC_1_PI, FRAC_2_PI, FRAC_PI_2, PI};
use tyndall_base::{
    math,
    vec::{Vec3, vec3},
};
use tyndall_spectral::Spectrum;

/// The tables of a material.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredTables {
    /// Density of normals over the square of h.
    pub ndf: Grid2d,
    /// Projected area over the square of wo.
    pub sigma: Grid2d,
    /// Density of visible normals, by phi and theta of wo \[rad\].
    pub vndf: Grid2d,
    /// Density of u, by phi and theta of wo \[rad\].
    pub luminance: Grid2d,
    /// F, by phi and theta of wo \[rad\] and wavelength \[nm\]; held at its ends.
    pub spectra: Grid2d,
    /// Nothing depends on the azimuth of wo but through that of h.
    pub isotropic: bool,
}

/// A surface of a measured material at the wavelengths of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured<'m, const N: usize> {
    /// Its tables.
    pub tables: &'m MeasuredTables,
    /// Wavelengths \[nm\].
    pub lambda: [f32; N],
}

/// Theta of a direction, without the loss of digits near the pole.
fn theta(w: Vec3) -> f32 {
    math::atan2((w.x * w.x + w.y * w.y).sqrt(), w.z)
}

fn phi(w: Vec3) -> f32 {
    math::atan2(w.y, w.x)
}

fn square_of(theta: f32, phi: f32) -> [f32; 2] {
    let v = 0.5 * FRAC_1_PI * phi + 0.5;
    [(theta * FRAC_2_PI).max(0.0).sqrt(), v - v.floor()]
}

impl<const N: usize> Measured<'_, N> {
    /// The events it has.
    pub const FLAGS: BsdfFlags = BsdfFlags::REFLECTION.or(BsdfFlags::GLOSSY);

    /// See [`Bsdf::eval_pdf`](super::Bsdf::eval_pdf).
    #[inline(never)]
    pub fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Spectrum<N>, Spectrum<N>) {
        let dark = (Spectrum::ZERO, Spectrum::ZERO);
        if wo.z * wi.z <= 0.0 {
            return dark;
        }
        let (wo, wi) = if wo.z < 0.0 { (-wo, -wi) } else { (wo, wi) };
        let h = wo + wi;
        if h.length_squared() == 0.0 {
            return dark;
        }
        let h = h.normalize();
        let (theta_h, from) = (theta(h), [phi(wo), theta(wo)]);
        let turned = if self.tables.isotropic { from[0] } else { 0.0 };
        let p = square_of(theta_h, phi(h) - turned);
        let (u, visible) = self.tables.vndf.invert(p, &self.tables.vndf.at(&from));
        let drawn = self.tables.luminance.eval(u, &self.tables.luminance.at(&from));
        let pdf = visible * drawn / jacobian(p, theta_h, wo.dot(h));
        (self.value(u, p, from, wi), Spectrum::splat(pdf))
    }

    /// F, D and sigma together.
    fn value(&self, u: [f32; 2], p: [f32; 2], from: [f32; 2], wi: Vec3) -> Spectrum<N> {
        let t = self.tables;
        let normals = t.ndf.eval(p, &t.ndf.at(&[]));
        let area = t.sigma.eval(square_of(from[1], from[0]), &t.sigma.at(&[]));
        let factor = normals / (4.0 * area * wi.z);
        if !factor.is_finite() {
            return Spectrum::ZERO;
        }
        let spectral =
            |k: usize| t.spectra.eval(u, &t.spectra.at(&[from[0], from[1], self.lambda[k]])).max(0.0);
        Spectrum::from_fn(spectral) * factor
    }

    /// See [`Bsdf::sample`](super::Bsdf::sample).
    #[inline(never)]
    pub fn sample(&self, wo: Vec3, u: [f32; 2]) -> Option<BsdfSample<N>> {
        let below = wo.z < 0.0;
        let wo = if below { -wo } else { wo };
        let t = self.tables;
        let from = [phi(wo), theta(wo)];
        let (u, drawn) = t.luminance.sample(u, &t.luminance.at(&from));
        let (p, visible) = t.vndf.sample(u, &t.vndf.at(&from));
        let theta_h = p[0] * p[0] * FRAC_PI_2;
        let turned = if t.isotropic { from[0] } else { 0.0 };
        let (sin_t, cos_t) = math::sin_cos(theta_h);
        let (sin_p, cos_p) = math::sin_cos((2.0 * p[1] - 1.0) * PI + turned);
        let h = vec3(sin_t * cos_p, sin_t * sin_p, cos_t);
        let wi = h * (2.0 * wo.dot(h)) - wo;
        if wi.z <= 0.0 {
            return None;
        }
        let pdf = visible * drawn / jacobian(p, theta_h, wo.dot(h));
        let f = self.value(u, p, from, wi);
        let wi = if below { -wi } else { wi };
        BsdfSample::smooth((f, Spectrum::splat(pdf)), wi, 1.0, Self::FLAGS)
    }
}

/// `d omega_i / d p`: of the square to normals, `2 pi^2 p_x sin theta`, and of normals to reflected directions, `4 wo . h`.
fn jacobian(p: [f32; 2], theta_h: f32, cos: f32) -> f32 {
    4.0 * cos * (2.0 * PI * PI * p[0] * math::sin(theta_h)).max(1e-6)
}

#[cfg(test)]
mod tests;
