//! Lambertian reflection and transmission, `f = R / pi` on the side of `wo` and `T / pi` on the other \[1/sr\].

use super::{BsdfFlags, BsdfSample};
use std::f32::consts::FRAC_1_PI;
use tyndall_base::vec::Vec3;
use tyndall_base::warp::{pdf_cosine_hemisphere, sample_cosine_hemisphere};
use tyndall_spectral::Spectrum;

/// A thin diffuser; `R + T <= 1` per lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiffuseTransmission<const N: usize> {
    /// Reflectance per lane.
    pub reflectance: Spectrum<N>,
    /// Transmittance per lane.
    pub transmittance: Spectrum<N>,
}

impl<const N: usize> DiffuseTransmission<N> {
    /// The events it has.
    pub const FLAGS: BsdfFlags = BsdfFlags::REFLECTION.or(BsdfFlags::TRANSMISSION).or(BsdfFlags::DIFFUSE);

    /// See [`Bsdf::eval`](super::Bsdf::eval).
    #[inline(always)]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Spectrum<N> {
        let albedo = if wo.z * wi.z > 0.0 { self.reflectance } else { self.transmittance };
        albedo * FRAC_1_PI
    }

    /// Each lane chooses the side by its own `R / (R + T)`; a black lane never scatters.
    #[inline(always)]
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> Spectrum<N> {
        let side = if wo.z * wi.z > 0.0 { self.reflectance } else { self.transmittance };
        side.safe_div(self.reflectance + self.transmittance) * pdf_cosine_hemisphere(wi.z.abs())
    }

    /// See [`Bsdf::sample`](super::Bsdf::sample).
    #[inline(always)]
    pub fn sample(&self, wo: Vec3, uc: f32, u: [f32; 2]) -> Option<BsdfSample<N>> {
        let (r, t) = (self.reflectance.hero(), self.transmittance.hero());
        let reflected = uc * (r + t) < r;
        let mut wi = sample_cosine_hemisphere(u);
        if reflected == (wo.z < 0.0) {
            wi.z = -wi.z;
        }
        let side = if reflected { BsdfFlags::REFLECTION } else { BsdfFlags::TRANSMISSION };
        BsdfSample::smooth((self.eval(wo, wi), self.pdf(wo, wi)), wi, 1.0, side | BsdfFlags::DIFFUSE)
    }
}
