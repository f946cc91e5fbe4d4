//! `hair`: fibres, for curves. Absorption is given as such, by the concentrations of two pigments, or by a colour.

use super::diffuse::clamp;
use crate::texture::{FloatTexture, SpectrumTexture, TextureContext};
use tyndall_geometry::SurfacePoint;
use tyndall_scatter::bsdf::{Bsdf, Hair};
use tyndall_spectral::{Curve, Spectrum, Wavelengths};

/// Where a fibre's absorption comes from.
#[derive(Clone, Debug)]
pub enum HairColour {
    /// Absorption over a radius.
    SigmaA(SpectrumTexture),
    /// The colour of a head of hair (Chiang et al. 2016).
    Reflectance(SpectrumTexture),
    /// Concentrations of eumelanin and pheomelanin, and the absorption of a unit of each.
    Pigments {
        /// Eumelanin, brown and black.
        eumelanin: FloatTexture,
        /// Pheomelanin, yellow and red.
        pheomelanin: FloatTexture,
        /// Absorption of each.
        sigma_a: Box<[Curve; 2]>,
    },
}

/// Parameters: see pbrt's class.
#[derive(Clone, Debug)]
pub struct HairMaterial {
    /// Absorption.
    pub colour: HairColour,
    /// Index of refraction.
    pub eta: FloatTexture,
    /// Roughness along the fibre.
    pub beta_m: FloatTexture,
    /// Roughness round the fibre.
    pub beta_n: FloatTexture,
    /// Tilt of the scales \[degrees\].
    pub alpha: FloatTexture,
}

impl HairMaterial {
    /// The BSDF at `s`, where v runs across the fibre.
    #[inline(never)]
    pub fn bsdf<const N: usize>(&self, s: &SurfacePoint, w: &Wavelengths<N>) -> Bsdf<'static, N> {
        let at = &TextureContext::of(s);
        let unit = |t: &FloatTexture| t.eval(at).clamp(1e-3, 1.0);
        let (beta_m, beta_n) = (unit(&self.beta_m), unit(&self.beta_n));
        let sigma_a = match &self.colour {
            HairColour::SigmaA(s) => s.eval(at, w).map(|s| s.max(0.0)),
            HairColour::Reflectance(c) => Hair::sigma_a_of_colour(clamp(c.eval(at, w)), beta_n),
            HairColour::Pigments { eumelanin, pheomelanin, sigma_a } => {
                let (e, p) = (eumelanin.eval(at).max(0.0), pheomelanin.eval(at).max(0.0));
                sigma_a[0].sample(w) * e + sigma_a[1].sample(w) * p
            }
        };
        // where v runs against the frame's y, the offset along that is the other one
        let along_y = s.ns.cross(s.dpdu).dot(s.dpdv) >= 0.0;
        let h = if along_y { 2.0 * s.uv.y - 1.0 } else { 1.0 - 2.0 * s.uv.y };
        Bsdf::Hair(Hair::new(h, self.eta.eval(at).max(1.0), sigma_a, beta_m, beta_n, self.alpha.eval(at)))
    }

    /// The colour, where it is given as one.
    pub fn albedo<const N: usize>(&self, at: &TextureContext, w: &Wavelengths<N>) -> Spectrum<N> {
        match &self.colour {
            HairColour::Reflectance(c) => clamp(c.eval(at, w)),
            _ => Spectrum::ONE,
        }
    }
}
