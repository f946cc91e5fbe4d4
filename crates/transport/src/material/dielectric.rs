//! `dielectric` and `thindielectric`: glass and water; dispersive when eta varies with wavelength.

use super::Roughness;
use crate::texture::TextureContext;
use tyndall_scatter::bsdf::{Bsdf, Dielectric, ThinDielectric};
use tyndall_spectral::{Curve, Wavelengths};

/// Parameters: index of refraction relative to the outside, roughness.
#[derive(Clone, Debug)]
pub struct DielectricMaterial {
    /// Index of refraction inside over outside.
    pub eta: Curve,
    /// Roughness of the surface.
    pub roughness: Roughness,
}

impl DielectricMaterial {
    /// The BSDF at `at`.
    #[inline]
    pub fn bsdf<const N: usize>(&self, at: &TextureContext, w: &Wavelengths<N>) -> Bsdf<'static, N> {
        Bsdf::Dielectric(Dielectric::new(self.eta.sample(w), self.roughness.distribution(at)))
    }
}

/// Parameter: index of refraction of the plate.
#[derive(Clone, Debug)]
pub struct ThinDielectricMaterial {
    /// Index of refraction of the plate over its surroundings.
    pub eta: Curve,
}

impl ThinDielectricMaterial {
    /// The BSDF.
    pub fn bsdf<const N: usize>(&self, w: &Wavelengths<N>) -> Bsdf<'static, N> {
        Bsdf::ThinDielectric(ThinDielectric { eta: self.eta.sample(w) })
    }
}
