//! Materials: from textures at a surface point to a BSDF at the path's wavelengths.

mod conductor;
mod dielectric;
mod diffuse;
mod roughness;

pub use conductor::{ConductorMaterial, Metal};
pub use dielectric::{DielectricMaterial, ThinDielectricMaterial};
pub use diffuse::{DiffuseMaterial, DiffuseTransmissionMaterial};
pub use roughness::Roughness;

use crate::texture::TextureContext;
use tyndall_geometry::{Frame, SurfacePoint};
use tyndall_scatter::bsdf::Bsdf;
use tyndall_spectral::{Spectrum, Wavelengths};

/// Any material.
#[derive(Clone, Debug)]
pub enum Material {
    /// Lambertian reflection.
    Diffuse(DiffuseMaterial),
    /// Lambertian reflection and transmission.
    DiffuseTransmission(DiffuseTransmissionMaterial),
    /// Metal.
    Conductor(ConductorMaterial),
    /// Glass, water.
    Dielectric(DielectricMaterial),
    /// A thin plate.
    ThinDielectric(ThinDielectricMaterial),
}

impl Material {
    /// The shading frame (z = shading normal) and the BSDF at a surface point.
    #[inline(always)]
    pub fn shade<const N: usize>(&self, s: &SurfacePoint, w: &Wavelengths<N>) -> (Frame, Bsdf<N>) {
        let frame = Frame::from_xz(s.dpdu, s.ns);
        let at = TextureContext { p: s.p, n: s.ns, uv: s.uv };
        let bsdf = match self {
            Self::Diffuse(m) => m.bsdf(&at, w),
            Self::DiffuseTransmission(m) => m.bsdf(&at, w),
            Self::Conductor(m) => m.bsdf(&at, w),
            Self::Dielectric(m) => m.bsdf(&at, w),
            Self::ThinDielectric(m) => m.bsdf(w),
        };
        (frame, bsdf)
    }

    /// Directional albedo at normal incidence, without the angular details: for the `albedo` output.
    pub fn albedo<const N: usize>(&self, s: &SurfacePoint, w: &Wavelengths<N>) -> Spectrum<N> {
        let at = TextureContext { p: s.p, n: s.ns, uv: s.uv };
        match self {
            Self::Diffuse(m) => m.reflectance(&at, w),
            Self::DiffuseTransmission(m) => m.albedo(&at, w),
            Self::Conductor(m) => m.normal_reflectance(&at, w),
            Self::Dielectric(_) | Self::ThinDielectric(_) => Spectrum::ONE,
        }
    }
}
