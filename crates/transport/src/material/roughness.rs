//! Roughness of microfacet materials: two float textures and pbrt's remapping.

use crate::texture::{FloatTexture, TextureContext};
use tyndall_scatter::bsdf::TrowbridgeReitz;

/// Parameters `uroughness`, `vroughness`, `remaproughness`.
#[derive(Clone, Debug)]
pub struct Roughness {
    /// Along the surface's u.
    pub u: FloatTexture,
    /// Along the surface's v.
    pub v: FloatTexture,
    /// Take the values as perceptual roughness: alpha = sqrt(roughness).
    pub remap: bool,
}

impl Roughness {
    /// A perfectly smooth surface.
    pub fn smooth() -> Self {
        Self { u: FloatTexture::Constant(0.0), v: FloatTexture::Constant(0.0), remap: true }
    }

    /// The distribution of microfacets at `at`.
    #[inline]
    pub fn distribution(&self, at: &TextureContext) -> TrowbridgeReitz {
        let alpha = |t: &FloatTexture| {
            let r = t.eval(at).max(0.0);
            if self.remap { r.sqrt() } else { r }
        };
        TrowbridgeReitz::new(alpha(&self.u), alpha(&self.v))
    }
}
