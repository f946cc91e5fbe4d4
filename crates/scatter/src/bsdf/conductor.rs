//! A metal: `F(eta - i k)` times a mirror, or times the Trowbridge-Reitz reflection
//! `f = D(m) G(wo, wi) F(wo . m) / (4 |cos_o cos_i|)` \[1/sr\] with `m` the half vector. Multiple bounces between
//! microfacets are not accounted for. Source: Cook & Torrance 1982; Walter et al. 2007, eq. 20.

use super::fresnel::{fresnel_conductor_n, reflect};
use super::{BsdfFlags, BsdfSample, TrowbridgeReitz};
use tyndall_base::vec::{Vec3, vec3};
use tyndall_spectral::Spectrum;

/// Complex relative index `eta - i k` per lane and a roughness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conductor<const N: usize> {
    /// Real part per lane, > 0.
    pub eta: Spectrum<N>,
    /// Absorption index per lane, >= 0.
    pub k: Spectrum<N>,
    /// Roughness; smooth gives a mirror.
    pub distribution: TrowbridgeReitz,
}

impl<const N: usize> Conductor<N> {
    /// The events it has.
    #[inline(always)]
    pub fn flags(&self) -> BsdfFlags {
        let kind = if self.distribution.is_smooth() { BsdfFlags::DELTA } else { BsdfFlags::GLOSSY };
        BsdfFlags::REFLECTION | kind
    }

    /// The microfacet normal that mirrors `wo` into `wi`, when the surface has a density there.
    #[inline(always)]
    fn half_vector(&self, wo: Vec3, wi: Vec3) -> Option<Vec3> {
        let m = wo + wi;
        let visible = wo.z * wi.z > 0.0 && !self.distribution.is_smooth() && m.length_squared() > 0.0;
        visible.then(|| m.normalize())
    }

    /// See [`Bsdf::eval_pdf`](super::Bsdf::eval_pdf). The density is the same for every lane: normals have no colour.
    #[inline]
    pub fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Spectrum<N>, Spectrum<N>) {
        let Some(m) = self.half_vector(wo, wi) else { return (Spectrum::ZERO, Spectrum::ZERO) };
        let d = &self.distribution;
        // pdf_visible / (4 |wo . m|), with the cosine cancelled
        let lobe = 0.25 * d.d(m);
        let f = fresnel_conductor_n(wo.abs_dot(m), &self.eta, &self.k) * (lobe * d.g_over_cos_cos(wo, wi));
        (f, Spectrum::splat(lobe * d.g1_over_cos(wo)))
    }

    /// See [`Bsdf::sample`](super::Bsdf::sample).
    #[inline]
    pub fn sample(&self, wo: Vec3, u: [f32; 2]) -> Option<BsdfSample<N>> {
        if self.distribution.is_smooth() {
            let f = fresnel_conductor_n(wo.z, &self.eta, &self.k);
            return BsdfSample::delta(f, vec3(-wo.x, -wo.y, wo.z), Spectrum::ONE, 1.0, self.flags());
        }
        let m = self.distribution.sample_visible(wo, u);
        let wi = reflect(wo, if wo.z < 0.0 { -m } else { m });
        BsdfSample::smooth(self.eval_pdf(wo, wi), wi, 1.0, self.flags())
    }
}
