//! Lambertian reflection, `f = R / pi` \[1/sr\] on the side of `wo`, from both sides of the surface.

use super::{BsdfFlags, BsdfSample};
use std::f32::consts::FRAC_1_PI;
use tyndall_base::vec::Vec3;
use tyndall_base::warp::{pdf_cosine_hemisphere, sample_cosine_hemisphere};
use tyndall_spectral::Spectrum;

/// A Lambertian surface of reflectance `R` in \[0, 1\] per lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diffuse<const N: usize> {
    /// Reflectance per lane.
    pub reflectance: Spectrum<N>,
}

impl<const N: usize> Diffuse<N> {
    /// The events it has.
    pub const FLAGS: BsdfFlags = BsdfFlags::REFLECTION.or(BsdfFlags::DIFFUSE);

    /// See [`Bsdf::eval`](super::Bsdf::eval).
    #[inline(always)]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Spectrum<N> {
        if wo.z * wi.z > 0.0 { self.reflectance * FRAC_1_PI } else { Spectrum::ZERO }
    }

    /// See [`Bsdf::pdf`](super::Bsdf::pdf).
    #[inline(always)]
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> Spectrum<N> {
        if wo.z * wi.z > 0.0 { Spectrum::splat(pdf_cosine_hemisphere(wi.z.abs())) } else { Spectrum::ZERO }
    }

    /// See [`Bsdf::sample`](super::Bsdf::sample).
    #[inline(always)]
    pub fn sample(&self, wo: Vec3, u: [f32; 2]) -> Option<BsdfSample<N>> {
        let mut wi = sample_cosine_hemisphere(u);
        if wo.z < 0.0 {
            wi.z = -wi.z;
        }
        BsdfSample::smooth((self.eval(wo, wi), self.pdf(wo, wi)), wi, 1.0, Self::FLAGS)
    }
}
