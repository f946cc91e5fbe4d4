//! A diffuse surface or a metal under a dielectric coat: `coateddiffuse`, `coatedconductor`.
//!
//! Light enters the coat, is scattered to and fro between coat and base, with a medium of extinction 1 and Henyey and
//! Greenstein's phase function between them (`thickness` is an optical one), and leaves. There is no closed form:
//! [`Coated::eval`] is an unbiased estimate by random walks whose numbers come from the surface's seed, and a sample is
//! one such walk with its exact weight. The density that both report is a deterministic stand-in, positive wherever the
//! surface scatters and the same for both, so that weights of multiple importance sampling add up to one and the weight
//! `f |cos| / pdf` of a sample is that of its walk. Walks draw alike for all wavelengths; a coat whose index varies
//! between them must be rendered one wavelength at a time ([`Coated::is_dispersive`]). Source: Guo, Hasan & Zhao 2018,
//! *Position-free Monte Carlo simulation for arbitrary layered BSDFs*; parameters and the two-sidedness of pbrt-v4.

mod interface;
mod walk;

pub use interface::Interface;

use super::{BsdfFlags, BsdfSample, Conductor, Diffuse, TrowbridgeReitz};
use std::f32::consts::{FRAC_1_PI, TAU};
use tyndall_base::{hash, rng::Pcg32, vec::Vec3};
use tyndall_spectral::Spectrum;
use walk::Walk;

/// What lies under the coat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Base<const N: usize> {
    /// Lambertian.
    Diffuse(Diffuse<N>),
    /// Metal.
    Conductor(Conductor<N>),
}

/// See the module.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coated<const N: usize> {
    /// The coat's upper boundary, at the hero's index.
    pub coat: Interface,
    /// The index varies between the lanes.
    pub dispersive: bool,
    /// What lies below.
    pub base: Base<N>,
    /// Optical thickness of the medium between.
    pub thickness: f32,
    /// Its albedo; zero for none.
    pub albedo: Spectrum<N>,
    /// Its mean cosine.
    pub g: f32,
    /// Most events of a walk.
    pub max_depth: u32,
    /// Walks an evaluation.
    pub samples: u32,
    /// What the walks draw from, another one for every visit of a surface.
    pub seed: u64,
}

/// Share of the stand-in density that is the same for all directions.
const EVEN: f32 = 0.1;

impl<const N: usize> Coated<N> {
    /// The events it has, the delta ones if there are no others.
    #[inline(never)]
    pub fn flags(&self) -> BsdfFlags {
        let metal = match &self.base {
            Base::Conductor(c) => c.distribution.is_smooth(),
            Base::Diffuse(_) => false,
        };
        let kind = if metal && self.coat.is_smooth() && self.albedo.is_zero() {
            BsdfFlags::DELTA
        } else {
            BsdfFlags::GLOSSY
        };
        BsdfFlags::REFLECTION | kind
    }

    /// Whether lanes other than the hero's have another index.
    #[inline(always)]
    pub fn is_dispersive(&self) -> bool {
        self.dispersive
    }

    /// See [`Bsdf::eval`](super::Bsdf::eval): an unbiased estimate.
    #[inline(never)]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Spectrum<N> {
        if wo.z * wi.z <= 0.0 || self.flags().is_delta() {
            return Spectrum::ZERO;
        }
        let (wo, wi) = if wo.z < 0.0 { (-wo, -wi) } else { (wo, wi) };
        let count = self.samples.max(1);
        let mut rng = self.rng(wo, wi);
        let mut sum = Spectrum::ZERO;
        for _ in 0..count {
            sum += Walk::new(self, &mut rng).towards(wo, wi);
        }
        let surface = if self.coat.is_smooth() { 0.0 } else { self.coat.eval_pdf(wo, wi).0 };
        sum * (1.0 / count as f32) + Spectrum::splat(surface)
    }

    /// See [`Bsdf::pdf`](super::Bsdf::pdf): the stand-in, the same for all lanes.
    #[inline(never)]
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> Spectrum<N> {
        if wo.z * wi.z <= 0.0 || self.flags().is_delta() {
            return Spectrum::ZERO;
        }
        let (wo, wi) = if wo.z < 0.0 { (-wo, -wi) } else { (wo, wi) };
        let mut lobe = self.base_lobe(wo, wi);
        if !self.coat.is_smooth() {
            let r = self.coat.reflectance(wo);
            // the boundary's own density holds its reflectance already
            lobe = (1.0 - r) * lobe + self.coat.eval_pdf(wo, wi).1;
        }
        Spectrum::splat((1.0 - EVEN) * lobe + EVEN / TAU)
    }

    /// About the density of what comes back from the base.
    fn base_lobe(&self, wo: Vec3, wi: Vec3) -> f32 {
        match &self.base {
            Base::Diffuse(_) => wi.z * FRAC_1_PI,
            Base::Conductor(c) => {
                let (a, b) = (&c.distribution, &self.coat.distribution);
                let widen = |a: f32, b: f32| (a * a + b * b).sqrt().max(1e-2);
                let d = TrowbridgeReitz::new(widen(a.alpha_x, b.alpha_x), widen(a.alpha_y, b.alpha_y));
                let m = (wo + wi).normalize();
                0.25 * d.d(m) * d.g1_over_cos(wo)
            }
        }
    }

    /// See [`Bsdf::sample`](super::Bsdf::sample).
    #[inline(never)]
    pub fn sample(&self, wo: Vec3, uc: f32, u: [f32; 2]) -> Option<BsdfSample<N>> {
        let turned = wo.z < 0.0;
        let up = if turned { -wo } else { wo };
        let key = hash::hash3_u64(uc.to_bits(), u[0].to_bits(), u[1].to_bits());
        let mut rng = Pcg32::from_key(self.seed ^ key);
        let end = Walk::new(self, &mut rng).out(up, uc, u)?;
        let wi = if turned { -end.wi } else { end.wi };
        if end.specular {
            let flags = BsdfFlags::REFLECTION | BsdfFlags::DELTA;
            return BsdfSample::delta(end.weight, wi, Spectrum::ONE, 1.0, flags);
        }
        let pdf = self.pdf(wo, wi);
        let f = end.weight * (pdf.hero() / wi.z.abs());
        BsdfSample::smooth((f, pdf), wi, 1.0, BsdfFlags::REFLECTION | BsdfFlags::GLOSSY)
    }

    fn rng(&self, wo: Vec3, wi: Vec3) -> Pcg32 {
        let bits = |v: Vec3| hash::hash3_u64(v.x.to_bits(), v.y.to_bits(), v.z.to_bits());
        Pcg32::from_key(hash::mix64(self.seed ^ bits(wo)) ^ bits(wi))
    }

    /// With wider lobes.
    #[inline]
    pub fn regularized(mut self) -> Self {
        self.coat.distribution = self.coat.distribution.regularized();
        if let Base::Conductor(c) = &mut self.base {
            c.distribution = c.distribution.regularized();
        }
        self
    }
}

#[cfg(test)]
mod tests;
