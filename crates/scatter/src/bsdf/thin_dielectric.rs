//! A plane-parallel dielectric plate too thin to displace light: all internal reflections in one.
//!
//! With `R` of one face, `R' = R + (1 - R)^2 R / (1 - R^2) = 2 R / (1 + R)` and `T' = 1 - R'`; transmission goes
//! straight on, so no wavelength is lost to dispersion. Source: Stokes 1862 (pile of plates).

use super::fresnel::fresnel_dielectric_n;
use super::{BsdfFlags, BsdfSample};
use tyndall_base::vec::{Vec3, vec3};
use tyndall_spectral::Spectrum;

/// Relative index per lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinDielectric<const N: usize> {
    /// Index of the plate relative to its surroundings.
    pub eta: Spectrum<N>,
}

impl<const N: usize> ThinDielectric<N> {
    /// The events it has.
    pub const FLAGS: BsdfFlags = BsdfFlags::REFLECTION.or(BsdfFlags::TRANSMISSION).or(BsdfFlags::DELTA);

    /// Reflectance of the plate per lane.
    #[inline(always)]
    pub fn reflectance(&self, wo: Vec3) -> Spectrum<N> {
        // either side of a plate is its outside
        fresnel_dielectric_n(wo.z.abs(), &self.eta).map(|r| 2.0 * r / (1.0 + r))
    }

    /// See [`Bsdf::sample`](super::Bsdf::sample); each lane would choose by its own reflectance.
    #[inline]
    pub fn sample(&self, wo: Vec3, uc: f32) -> Option<BsdfSample<N>> {
        let r = self.reflectance(wo);
        if uc < r.hero() {
            let flags = BsdfFlags::REFLECTION | BsdfFlags::DELTA;
            BsdfSample::delta(r, vec3(-wo.x, -wo.y, wo.z), r, 1.0, flags)
        } else {
            let t = Spectrum::ONE - r;
            BsdfSample::delta(t, -wo, t, 1.0, BsdfFlags::TRANSMISSION | BsdfFlags::DELTA)
        }
    }
}
