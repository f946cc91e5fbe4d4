//! `conductor`: metals, by complex index of refraction eta + i k or by reflectance at normal incidence.

use super::{Roughness, diffuse::clamp};
use crate::texture::{SpectrumTexture, TextureContext};
use tyndall_scatter::bsdf::{Bsdf, Conductor, fresnel};
use tyndall_spectral::{Spectrum, Wavelengths};

/// How the metal is given.
#[derive(Clone, Debug)]
pub enum Metal {
    /// Index of refraction and extinction coefficient.
    Index {
        /// Real part.
        eta: SpectrumTexture,
        /// Imaginary part.
        k: SpectrumTexture,
    },
    /// Reflectance r at normal incidence: eta = 1, k = 2 sqrt(r / (1 - r)).
    Reflectance(SpectrumTexture),
}

/// Parameters: the metal and its roughness.
#[derive(Clone, Debug)]
pub struct ConductorMaterial {
    /// The metal.
    pub metal: Metal,
    /// Its roughness.
    pub roughness: Roughness,
}

impl ConductorMaterial {
    fn index<const N: usize>(&self, at: &TextureContext, w: &Wavelengths<N>) -> (Spectrum<N>, Spectrum<N>) {
        match &self.metal {
            Metal::Index { eta, k } => (eta.eval(at, w), k.eval(at, w)),
            Metal::Reflectance(r) => {
                // a reflectance of exactly 1 would need an infinite k
                let r = clamp(r.eval(at, w)).map(|r| r.min(0.9999));
                (Spectrum::ONE, r.map(|r| 2.0 * (r / (1.0 - r)).sqrt()))
            }
        }
    }

    /// Fresnel reflectance at normal incidence.
    pub fn normal_reflectance<const N: usize>(&self, at: &TextureContext, w: &Wavelengths<N>) -> Spectrum<N> {
        let (eta, k) = self.index(at, w);
        Spectrum::from_fn(|i| fresnel::fresnel_conductor(1.0, eta[i], k[i]))
    }

    /// The metal at `at`.
    pub fn conductor<const N: usize>(&self, at: &TextureContext, w: &Wavelengths<N>) -> Conductor<N> {
        let (eta, k) = self.index(at, w);
        Conductor { eta, k, distribution: self.roughness.distribution(at) }
    }

    /// The BSDF at `at`.
    pub fn bsdf<const N: usize>(&self, at: &TextureContext, w: &Wavelengths<N>) -> Bsdf<'static, N> {
        Bsdf::Conductor(self.conductor(at, w))
    }
}
