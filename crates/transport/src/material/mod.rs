//! Materials: from textures at a surface point to a BSDF at the path's wavelengths.

mod coated;
mod conductor;
mod dielectric;
mod diffuse;
mod hair;
mod mapped;
mod measured;
mod mix;
mod roughness;

pub use coated::{CoatedBase, CoatedMaterial};
pub use conductor::{ConductorMaterial, Metal};
pub use dielectric::{DielectricMaterial, ThinDielectricMaterial};
pub use diffuse::{DiffuseMaterial, DiffuseTransmissionMaterial};
pub use hair::{HairColour, HairMaterial};
pub use mapped::{MappedMaterial, Relief};
pub use measured::MeasuredMaterial;
pub use mix::MixMaterial;
pub use roughness::Roughness;

use crate::texture::TextureContext;
use tyndall_base::hash;
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
    /// A surface under a coat.
    Coated(Box<CoatedMaterial>),
    /// Fibres.
    Hair(Box<HairMaterial>),
    /// Tables of a real surface.
    Measured(MeasuredMaterial),
    /// A material with a normal map or a bump map.
    Mapped(Box<MappedMaterial>),
    /// One of two materials, chosen at random; the scene chooses at the hit, so that no path gets here.
    Mix(Box<MixMaterial>),
}

impl Material {
    /// The shading frame (z = shading normal) and the BSDF at a surface point.
    #[inline(always)]
    pub fn shade<const N: usize>(&self, s: &SurfacePoint, w: &Wavelengths<N>) -> (Frame, Bsdf<'_, N>) {
        if let Self::Mapped(m) = self {
            return (m.frame(s), m.material.bsdf(s, w));
        }
        (Frame::from_xz(s.dpdu, s.ns), self.bsdf(s, w))
    }

    #[inline(always)]
    fn bsdf<const N: usize>(&self, s: &SurfacePoint, w: &Wavelengths<N>) -> Bsdf<'_, N> {
        let at = TextureContext { p: s.p, n: s.ng, uv: s.uv };
        match self {
            Self::Diffuse(m) => m.bsdf(&at, w),
            Self::DiffuseTransmission(m) => m.bsdf(&at, w),
            Self::Conductor(m) => m.bsdf(&at, w),
            Self::Dielectric(m) => m.bsdf(&at, w),
            Self::ThinDielectric(m) => m.bsdf(w),
            Self::Coated(m) => m.bsdf(&at, w, seed(s, w)),
            Self::Hair(m) => m.bsdf(s, w),
            Self::Measured(m) => m.bsdf(w),
            Self::Mapped(_) | Self::Mix(_) => black(),
        }
    }

    /// Whether heights turn the normal: those ask for how the normal changes along the surface.
    #[inline(always)]
    pub fn is_bumped(&self) -> bool {
        matches!(self, Self::Mapped(m) if matches!(m.relief, Relief::Heights(_)))
    }

    /// Whether it only scatters evenly.
    pub fn is_matte(&self) -> bool {
        match self {
            Self::Diffuse(_) | Self::DiffuseTransmission(_) | Self::Mix(_) => true,
            Self::Mapped(m) => m.material.is_matte(),
            _ => false,
        }
    }

    /// Directional albedo at normal incidence, without the angular details: for the `albedo` output.
    pub fn albedo<const N: usize>(&self, s: &SurfacePoint, w: &Wavelengths<N>) -> Spectrum<N> {
        let at = TextureContext { p: s.p, n: s.ng, uv: s.uv };
        match self {
            Self::Diffuse(m) => m.reflectance(&at, w),
            Self::DiffuseTransmission(m) => m.albedo(&at, w),
            Self::Conductor(m) => m.normal_reflectance(&at, w),
            Self::Dielectric(_) | Self::ThinDielectric(_) => Spectrum::ONE,
            Self::Coated(m) => m.albedo(&at, w),
            Self::Hair(m) => m.albedo(&at, w),
            Self::Measured(m) => m.albedo(w),
            Self::Mapped(m) => m.material.albedo(s, w),
            Self::Mix(_) => Spectrum::ZERO,
        }
    }
}

/// A number that no other visit of a surface has: point and wavelengths together.
#[inline(always)]
fn seed<const N: usize>(s: &SurfacePoint, w: &Wavelengths<N>) -> u64 {
    let place = hash::hash4_u64(s.p.x.to_bits(), s.p.y.to_bits(), s.p.z.to_bits(), w.lambda[0].to_bits());
    place ^ u64::from(s.uv.x.to_bits())
}

/// What materials are that lie within themselves: readers build none.
#[inline(never)]
fn black<const N: usize>() -> Bsdf<'static, N> {
    Bsdf::Diffuse(tyndall_scatter::bsdf::Diffuse { reflectance: Spectrum::ZERO })
}
