//! The inside of a body whose boundary is painted: textures of a surface give the coefficients of what it encloses.
//!
//! A texture has no values inside. The coefficients are those of the point where a path enters the body, and hold until
//! the path leaves it: seen from the camera, those of the point from which light leaves. pbrt-v4 takes the coefficients
//! of its diffusion model from the same point.
//!
//! With a colour `R` and a mean free path, `sigma_t = 1 / mfp` and the albedo is such that a thick body has the colour `R`
//! under diffuse light ([`albedo_of`]).

use super::MediumProperties;
use crate::texture::{SpectrumTexture, TextureContext};
use tyndall_scatter::phase::{HenyeyGreenstein, PhaseFunction};
use tyndall_spectral::{Curve, Spectrum, Wavelengths};

/// Mean free paths below this count as this \[m\].
const SHORTEST: f32 = 1e-9;

/// See the module.
#[derive(Clone, Debug)]
pub struct Painted {
    /// What the textures say.
    pub paint: Paint,
    /// Factor of the coefficients, or of the mean free path where that is given.
    pub scale: f32,
    /// Mean cosine of the phase function.
    pub g: f32,
    /// Distribution of scattered directions, with the mean cosine `g`.
    pub phase: PhaseFunction,
}

/// What is painted on the boundary.
#[derive(Clone, Debug)]
pub enum Paint {
    /// The coefficients.
    Coefficients {
        /// Absorption coefficient \[1/m\].
        sigma_a: SpectrumTexture,
        /// Scattering coefficient \[1/m\].
        sigma_s: SpectrumTexture,
    },
    /// How the body looks.
    Colour {
        /// Reflectance of a thick body.
        reflectance: SpectrumTexture,
        /// Mean free path \[m\].
        mfp: SpectrumTexture,
        /// Index of refraction of the boundary.
        eta: Curve,
    },
}

impl Painted {
    /// The body with Henyey-Greenstein's phase function.
    pub fn new(paint: Paint, scale: f32, g: f32) -> Result<Self, tyndall_scatter::ScatterError> {
        let phase = PhaseFunction::HenyeyGreenstein(HenyeyGreenstein::new(Curve::Constant(g))?);
        Ok(Self { paint, scale, g, phase })
    }

    /// The properties of the inside for a path that entered at `entry`.
    #[inline(never)]
    pub fn at<const N: usize>(&self, entry: &TextureContext, w: &Wavelengths<N>) -> MediumProperties<'_, N> {
        let [sigma_a, sigma_s] = match &self.paint {
            Paint::Coefficients { sigma_a, sigma_s } => {
                [sigma_a, sigma_s].map(|t| t.eval(entry, w).max(0.0) * self.scale)
            }
            Paint::Colour { reflectance, mfp, eta } => {
                let (r, mfp, eta) = (reflectance.eval(entry, w), mfp.eval(entry, w), eta.sample(w));
                let sigma_t = (mfp * self.scale).max(SHORTEST).map(|l| 1.0 / l);
                let albedo: Spectrum<N> =
                    Spectrum::from_fn(|k| albedo_of(r[k].into(), eta[k].into(), self.g.into()) as f32);
                [sigma_t * (Spectrum::ONE - albedo), sigma_t * albedo]
            }
        };
        MediumProperties { sigma_a, sigma_s, le: Spectrum::ZERO, phase: &self.phase }
    }
}

/// The albedo of a half-space that returns the fraction `r` of diffuse light, behind a boundary of index `eta`, by closed
/// forms: behind the boundary the body returns `R0 = R / (1 - F + F R)` of diffuse light, `F` being the boundary's internal
/// reflectance (Saunderson 1942; F after Egan & Hilgeman 1973), and a half-space does that with `s = sqrt((1 - w)/(1 - g w))`
/// where `R0 = (1 - s)(1 - 0.139 s)/(1 + 1.17 s)` (van de Hulst 1980), `w` its albedo.
pub fn albedo_of(r: f64, eta: f64, g: f64) -> f64 {
    let internal = if eta > 1.0 { -1.4399 / (eta * eta) + 0.7099 / eta + 0.6681 + 0.0636 * eta } else { 0.0 };
    let r = r.clamp(0.0, 1.0);
    let r0 = r / (1.0 - internal + internal * r);
    // 0.139 s^2 - (1.139 + 1.17 R0) s + 1 - R0 = 0, the root below 1
    let b = 1.139 + 1.17 * r0;
    let s = 2.0 * (1.0 - r0) / (b + (b * b - 4.0 * 0.139 * (1.0 - r0)).sqrt());
    (1.0 - s * s) / (1.0 - g * s * s)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// There and back through the closed forms, and against H-functions: a half-space of isotropic scatterers with
    /// albedo 0.9 has the spherical albedo 0.4777 (Chandrasekhar 1950; van de Hulst 1980, table 12).
    #[test]
    fn colours_are_inverted() {
        for (r, g) in [(0.0, 0.0), (0.3, 0.5), (0.8, -0.4), (1.0, 0.7)] {
            let w = albedo_of(r, 1.0, g);
            let s = ((1.0 - w) / (1.0 - g * w)).sqrt();
            let back = (1.0 - s) * (1.0 - 0.139 * s) / (1.0 + 1.17 * s);
            assert!((back - r).abs() < 1e-9 && (0.0..=1.0).contains(&w), "{r} {g}: {w} {back}");
        }
        assert!((albedo_of(0.4777, 1.0, 0.0) - 0.9).abs() < 2e-3, "{}", albedo_of(0.4777, 1.0, 0.0));
        // behind a boundary a darker skin needs a whiter body
        assert!(albedo_of(0.5, 1.4, 0.0) > albedo_of(0.5, 1.0, 0.0));
    }
}
