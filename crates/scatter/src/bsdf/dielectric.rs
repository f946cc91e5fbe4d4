//! The boundary of a dielectric, smooth or rough, with dispersion: `eta` has one value per lane.
//!
//! Smooth: reflection with `R(cos_o, eta)`, refraction with `1 - R`. A refracted direction belongs to the hero's index:
//! lanes of another index cannot go there (`f = pdf = 0`; spectral MIS reweights), lanes of the same index go along.
//! Rough: `f_r = D(m) G F / (4 |cos_o cos_i|)` and
//! `f_t = D(m) G (1 - F) |wo . m| |wi . m| / (|cos_o cos_i| (wi . m + wo . m / etap)^2)` \[1/sr\], `m` the generalised
//! half vector of the lane's own index, so every lane has a value and a density at every direction.
//! Carrying radiance, refraction scales by `1 / etap^2` (Veach 1997, 5.2); [`TransportMode::Importance`] leaves it out.
//! Multiple bounces between microfacets are not accounted for: seen from outside, glass loses 1 to 4 % at alpha = 0.3 and
//! 10 to 25 % at alpha = 1; from inside about 10 % and more than half. Sources: Walter et al. 2007, eq. 16-21.

use super::fresnel::{fresnel_dielectric, fresnel_dielectric_n, reflect, refract, transmittance};
use super::{BsdfFlags, BsdfSample, TransportMode, TrowbridgeReitz};
use tyndall_base::vec::{Vec3, vec3};
use tyndall_spectral::Spectrum;

/// Relative index n(below) / n(above) per lane and a roughness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dielectric<const N: usize> {
    /// Index below the surface over index above it (the side of +z), per lane.
    pub eta: Spectrum<N>,
    /// Roughness; smooth gives delta distributions.
    pub distribution: TrowbridgeReitz,
    /// What the path carries.
    pub mode: TransportMode,
}

/// `n(side of wi) / n(side of wo)` of one lane.
#[inline(always)]
fn relative(eta: f32, wo: Vec3) -> f32 {
    if wo.z < 0.0 { 1.0 / eta } else { eta }
}

impl<const N: usize> Dielectric<N> {
    /// A boundary for radiance; without a step in the index there is nothing to be rough about, and it is smooth.
    #[inline(always)]
    pub fn new(eta: Spectrum<N>, distribution: TrowbridgeReitz) -> Self {
        let matched = eta.0.iter().all(|&e| e == 1.0);
        let distribution = if matched { TrowbridgeReitz::SMOOTH } else { distribution };
        Self { eta, distribution, mode: TransportMode::Radiance }
    }

    /// With a wider lobe, unless there is no step in the index.
    #[inline]
    pub fn regularized(self) -> Self {
        Self { mode: self.mode, ..Self::new(self.eta, self.distribution.regularized()) }
    }

    /// The events it has.
    #[inline(always)]
    pub fn flags(&self) -> BsdfFlags {
        let kind = if self.distribution.is_smooth() { BsdfFlags::DELTA } else { BsdfFlags::GLOSSY };
        BsdfFlags::REFLECTION | BsdfFlags::TRANSMISSION | kind
    }

    /// The factor of a refracted radiance.
    #[inline(always)]
    fn squeeze(&self, etap: f32) -> f32 {
        match self.mode {
            TransportMode::Radiance => 1.0 / (etap * etap),
            TransportMode::Importance => 1.0,
        }
    }

    /// See [`Bsdf::eval_pdf`](super::Bsdf::eval_pdf). Each lane's density is what it would be if it were the hero: a
    /// visible normal, then reflection with its own `F`; so `f` and `pdf` differ by masking and `1 / etap^2` alone.
    #[inline]
    pub fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Spectrum<N>, Spectrum<N>) {
        if self.distribution.is_smooth() || wo.z * wi.z == 0.0 {
            return (Spectrum::ZERO, Spectrum::ZERO);
        }
        let d = &self.distribution;
        let (g, g1) = (d.g_over_cos_cos(wo, wi), d.g1_over_cos(wo));
        if wo.z * wi.z > 0.0 {
            let m = upward(wo + wi);
            let lobe = fresnel_dielectric_n(wo.dot(m), &self.eta) * (0.25 * d.d(m));
            return (lobe * g, lobe * g1);
        }
        let etap = self.eta.map(|eta| relative(eta, wo));
        let lobe = etap.map(|etap| refracted(d, wo, wi, etap));
        (lobe * etap.map(|etap| self.squeeze(etap)) * g, lobe * g1)
    }

    /// See [`Bsdf::sample`](super::Bsdf::sample).
    #[inline]
    pub fn sample(&self, wo: Vec3, uc: f32, u: [f32; 2]) -> Option<BsdfSample<N>> {
        if self.distribution.is_smooth() { self.sample_smooth(wo, uc) } else { self.sample_rough(wo, uc, u) }
    }

    #[inline]
    fn sample_smooth(&self, wo: Vec3, uc: f32) -> Option<BsdfSample<N>> {
        let r = fresnel_dielectric_n(wo.z, &self.eta);
        if uc < r.hero() {
            let flags = BsdfFlags::REFLECTION | BsdfFlags::DELTA;
            return BsdfSample::delta(r, vec3(-wo.x, -wo.y, wo.z), r, 1.0, flags);
        }
        let (wi, etap) = refract(wo, vec3(0.0, 0.0, 1.0), self.eta.hero())?;
        // the direction is the hero's: only lanes of the same index refract there
        let hero = self.eta.hero();
        let t = Spectrum::from_fn(|k| if self.eta[k] == hero { 1.0 - r[k] } else { 0.0 });
        let flags = BsdfFlags::TRANSMISSION | BsdfFlags::DELTA;
        BsdfSample::delta(t * self.squeeze(etap), wi, t, etap, flags)
    }

    #[inline]
    fn sample_rough(&self, wo: Vec3, uc: f32, u: [f32; 2]) -> Option<BsdfSample<N>> {
        let m = self.distribution.sample_visible(wo, u);
        if wo.dot(m) * wo.z <= 0.0 {
            return None; // rounding at a grazing angle
        }
        let (wi, etap, side) = if uc < fresnel_dielectric(wo.dot(m), self.eta.hero()) {
            (reflect(wo, m), 1.0, BsdfFlags::REFLECTION)
        } else {
            let (wi, etap) = refract(wo, m, self.eta.hero())?;
            (wi, etap, BsdfFlags::TRANSMISSION)
        };
        // a direction on the wrong side would need a second bounce
        if (wo.z * wi.z > 0.0) != side.is_reflection() {
            return None;
        }
        BsdfSample::smooth(self.eval_pdf(wo, wi), wi, etap, side | BsdfFlags::GLOSSY)
    }
}

/// The unit vector along `m` or `-m` with `z >= 0`.
#[inline(always)]
fn upward(m: Vec3) -> Vec3 {
    let m = m.normalize();
    if m.z < 0.0 { -m } else { m }
}

/// `D(m) (1 - F) |wo . m| dm/dwi` of the microfacet that refracts `wo` into `wi`, with
/// `dm/dwi = |wi . m| / (wi . m + wo . m / etap)^2` (Walter et al. 2007, eq. 17); zero where it would be seen from behind.
#[inline(always)]
fn refracted(d: &TrowbridgeReitz, wo: Vec3, wi: Vec3, etap: f32) -> f32 {
    // a half vector of zero length gives NaN here, which no comparison below accepts
    let m = upward(wi * etap + wo);
    let (cos_o, cos_i) = (wo.dot(m), wi.dot(m));
    let bend = cos_i + cos_o / etap;
    let value = d.d(m) * transmittance(cos_o, cos_i, etap) * (cos_o * cos_i).abs() / (bend * bend);
    let seen = cos_o * wo.z > 0.0 && cos_i * wi.z > 0.0 && bend != 0.0;
    if seen { value } else { 0.0 }
}
