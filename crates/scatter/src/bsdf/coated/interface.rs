//! The coat's boundary, one event at a time: what is reflected or refracted when that event is forced.

use crate::bsdf::fresnel::{fresnel_dielectric, reflect, refract};
use crate::bsdf::{Dielectric, TransportMode, TrowbridgeReitz};
use tyndall_base::vec::{Vec3, vec3};
use tyndall_spectral::Spectrum;

/// A dielectric boundary at one index.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interface {
    /// Index below over above.
    pub eta: f32,
    /// Roughness.
    pub distribution: TrowbridgeReitz,
}

/// A direction and the weight `f |cos| / pdf` of the event it was forced to.
pub(super) type Forced = Option<(Vec3, f32)>;

impl Interface {
    fn dielectric(&self, mode: TransportMode) -> Dielectric<1> {
        Dielectric { mode, ..Dielectric::new(Spectrum([self.eta]), self.distribution) }
    }

    /// Whether the boundary sends light to single directions.
    #[inline]
    pub fn is_smooth(&self) -> bool {
        self.dielectric(TransportMode::Radiance).flags().is_delta()
    }

    /// BSDF and density, as for a [`Dielectric`].
    #[inline]
    pub fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (f32, f32) {
        let (f, pdf) = self.dielectric(TransportMode::Radiance).eval_pdf(wo, wi);
        (f[0], pdf[0])
    }

    /// Fresnel reflectance at the smooth boundary.
    #[inline]
    pub fn reflectance(&self, wo: Vec3) -> f32 {
        fresnel_dielectric(wo.z, self.eta)
    }

    /// Probability with which a walk is reflected: a smooth boundary's reflectance. A rough one lets light through
    /// beyond the critical angle too, so neither event is ruled out there.
    #[inline]
    pub(super) fn share_reflected(&self, wo: Vec3) -> f32 {
        let r = self.reflectance(wo);
        if self.is_smooth() { r } else { r.clamp(0.1, 0.9) }
    }

    /// The normal of the facet that is met.
    fn facet(&self, wo: Vec3, u: [f32; 2]) -> Vec3 {
        if self.is_smooth() { vec3(0.0, 0.0, 1.0) } else { self.distribution.sample_visible(wo, u) }
    }

    /// `G / G1` of the second direction; 1 at a smooth boundary.
    fn seen(&self, wo: Vec3, wi: Vec3) -> f32 {
        if self.is_smooth() {
            return 1.0;
        }
        self.distribution.g_over_cos_cos(wo, wi) * wi.z.abs() / self.distribution.g1_over_cos(wo)
    }

    /// A reflection.
    pub fn sample_reflection(&self, wo: Vec3, u: [f32; 2]) -> Forced {
        let m = self.facet(wo, u);
        let wi = reflect(wo, m);
        let weight = fresnel_dielectric(wo.dot(m), self.eta) * self.seen(wo, wi);
        (wi.z * wo.z > 0.0).then_some((wi, weight))
    }

    /// A refraction of what carries `mode`.
    pub fn sample_refraction(&self, wo: Vec3, u: [f32; 2], mode: TransportMode) -> Forced {
        let m = self.facet(wo, u);
        let (wi, etap) = refract(wo, m, self.eta)?;
        let squeeze = if mode == TransportMode::Radiance { 1.0 / (etap * etap) } else { 1.0 };
        let weight = (1.0 - fresnel_dielectric(wo.dot(m), self.eta)) * squeeze * self.seen(wo, wi);
        (wi.z * wo.z < 0.0).then_some((wi, weight))
    }
}
