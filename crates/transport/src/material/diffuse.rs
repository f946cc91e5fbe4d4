//! `diffuse` and `diffusetransmission`: Lambertian surfaces.

use crate::texture::{SpectrumTexture, TextureContext};
use tyndall_scatter::bsdf::{Bsdf, Diffuse, DiffuseTransmission};
use tyndall_spectral::{Spectrum, Wavelengths};

/// Parameter `reflectance`; texture values are clamped to \[0, 1\].
#[derive(Clone, Debug)]
pub struct DiffuseMaterial {
    /// Hemispherical reflectance.
    pub reflectance: SpectrumTexture,
}

impl DiffuseMaterial {
    /// The reflectance at `at`.
    #[inline(always)]
    pub fn reflectance<const N: usize>(&self, at: &TextureContext, w: &Wavelengths<N>) -> Spectrum<N> {
        clamp(self.reflectance.eval(at, w))
    }

    /// The BSDF at `at`.
    #[inline(always)]
    pub fn bsdf<const N: usize>(&self, at: &TextureContext, w: &Wavelengths<N>) -> Bsdf<'static, N> {
        Bsdf::Diffuse(Diffuse { reflectance: self.reflectance(at, w) })
    }
}

/// Parameters `reflectance`, `transmittance`, `scale`.
#[derive(Clone, Debug)]
pub struct DiffuseTransmissionMaterial {
    /// Hemispherical reflectance.
    pub reflectance: SpectrumTexture,
    /// Hemispherical transmittance.
    pub transmittance: SpectrumTexture,
    /// Factor on both.
    pub scale: f32,
}

impl DiffuseTransmissionMaterial {
    fn both<const N: usize>(&self, at: &TextureContext, w: &Wavelengths<N>) -> (Spectrum<N>, Spectrum<N>) {
        let value = |t: &SpectrumTexture| clamp(t.eval(at, w) * self.scale);
        (value(&self.reflectance), value(&self.transmittance))
    }

    /// Reflectance plus transmittance.
    pub fn albedo<const N: usize>(&self, at: &TextureContext, w: &Wavelengths<N>) -> Spectrum<N> {
        let (r, t) = self.both(at, w);
        r + t
    }

    /// The BSDF at `at`.
    pub fn bsdf<const N: usize>(&self, at: &TextureContext, w: &Wavelengths<N>) -> Bsdf<'static, N> {
        let (reflectance, transmittance) = self.both(at, w);
        Bsdf::DiffuseTransmission(DiffuseTransmission { reflectance, transmittance })
    }
}

#[inline(always)]
pub(super) fn clamp<const N: usize>(s: Spectrum<N>) -> Spectrum<N> {
    s.map(|v| v.clamp(0.0, 1.0))
}
