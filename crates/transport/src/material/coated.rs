//! `coateddiffuse` and `coatedconductor`: a surface under a dielectric coat.

use super::{ConductorMaterial, DiffuseMaterial, Roughness, diffuse::clamp};
use crate::texture::{FloatTexture, SpectrumTexture, TextureContext};
use tyndall_scatter::bsdf::{
    Bsdf, Coated,
    coated::{Base, Interface},
};
use tyndall_spectral::{Curve, Spectrum, Wavelengths};

/// What lies under the coat.
#[derive(Clone, Debug)]
pub enum CoatedBase {
    /// Lambertian.
    Diffuse(DiffuseMaterial),
    /// Metal; its indices are against vacuum and are divided by the coat's.
    Conductor(ConductorMaterial),
}

/// Parameters: see pbrt's classes.
#[derive(Clone, Debug)]
pub struct CoatedMaterial {
    /// What lies under the coat.
    pub base: CoatedBase,
    /// Index of the coat.
    pub eta: Curve,
    /// Roughness of the coat.
    pub roughness: Roughness,
    /// Optical thickness of the medium between coat and base.
    pub thickness: FloatTexture,
    /// Its albedo.
    pub albedo: SpectrumTexture,
    /// Its mean cosine.
    pub g: FloatTexture,
    /// Most events of a walk between the layers.
    pub max_depth: u32,
    /// Walks an evaluation.
    pub samples: u32,
}

/// Layers thinner than this are as thick: a walk needs room.
const LEAST_THICKNESS: f32 = 1e-6;

impl CoatedMaterial {
    /// The BSDF at `at`; `seed` is new at every visit.
    #[inline(never)]
    pub fn bsdf<const N: usize>(
        &self,
        at: &TextureContext,
        w: &Wavelengths<N>,
        seed: u64,
    ) -> Bsdf<'static, N> {
        let eta = self.eta.sample(w);
        let base = match &self.base {
            CoatedBase::Diffuse(m) => {
                Base::Diffuse(tyndall_scatter::bsdf::Diffuse { reflectance: m.reflectance(at, w) })
            }
            CoatedBase::Conductor(m) => {
                let mut metal = m.conductor(at, w);
                metal.eta = Spectrum::from_fn(|k| metal.eta[k] / eta[k]);
                metal.k = Spectrum::from_fn(|k| metal.k[k] / eta[k]);
                Base::Conductor(metal)
            }
        };
        Bsdf::Coated(Coated {
            coat: Interface { eta: eta.hero(), distribution: self.roughness.distribution(at) },
            dispersive: eta.0.iter().any(|e| *e != eta.hero()),
            base,
            thickness: self.thickness.eval(at).max(LEAST_THICKNESS),
            albedo: clamp(self.albedo.eval(at, w)),
            g: self.g.eval(at).clamp(-0.999, 0.999),
            max_depth: self.max_depth,
            samples: self.samples,
            seed,
        })
    }

    /// About what comes back at normal incidence, without what happens between the layers.
    pub fn albedo<const N: usize>(&self, at: &TextureContext, w: &Wavelengths<N>) -> Spectrum<N> {
        match &self.base {
            CoatedBase::Diffuse(m) => m.reflectance(at, w),
            CoatedBase::Conductor(m) => m.normal_reflectance(at, w),
        }
    }
}
