//! `hair`.

use crate::scene::{
    context::{Context, at},
    spectrum::Purpose,
    texture::Textures,
};
use tyndall_pbrt::{Error, ParamSet};
use tyndall_spectral::{Curve, colour::SpaceName, upsample};
use tyndall_transport::{
    material::{HairColour, HairMaterial},
    texture::FloatTexture,
};

/// Absorption of a unit of eumelanin and of pheomelanin in linear sRGB (d'Eon et al. 2011).
const PIGMENTS: [[f32; 3]; 2] = [[0.419, 0.697, 1.37], [0.187, 0.4, 1.05]];

pub(super) fn hair(ctx: &Context<'_>, p: &ParamSet, textures: &Textures<'_>) -> Result<HairMaterial, Error> {
    let number = |name: &str, default: f32| {
        Ok::<_, Error>(textures.float(p, name)?.unwrap_or(FloatTexture::Constant(default)))
    };
    Ok(HairMaterial {
        colour: colour(ctx, p, textures)?,
        eta: number("eta", 1.55)?,
        beta_m: number("beta_m", 0.3)?,
        beta_n: number("beta_n", 0.3)?,
        alpha: number("alpha", 2.0)?,
    })
}

/// pbrt's order: `sigma_a`, then a colour, then pigments; without any, brown hair.
fn colour(ctx: &Context<'_>, p: &ParamSet, textures: &Textures<'_>) -> Result<HairColour, Error> {
    let sigma_a = textures.spectrum(p, "sigma_a", Purpose::Unbounded)?;
    let name = if p.contains("reflectance") { "reflectance" } else { "color" };
    let reflectance = textures.spectrum(p, name, Purpose::Albedo)?;
    let (eumelanin, pheomelanin) = (textures.float(p, "eumelanin")?, textures.float(p, "pheomelanin")?);
    let over = |given: bool, by: &str| {
        if given {
            ctx.warnings.warn(p.place(), format!("hair: \"{by}\" counts, the other colours are ignored"));
        }
    };
    let pigments = eumelanin.is_some() || pheomelanin.is_some();
    match (sigma_a, reflectance) {
        (Some(sigma_a), other) => {
            over(other.is_some() || pigments, "sigma_a");
            Ok(HairColour::SigmaA(sigma_a))
        }
        (None, Some(colour)) => {
            over(pigments, name);
            Ok(HairColour::Reflectance(colour))
        }
        (None, None) => {
            let unit = |rgb| upsample::unbounded(SpaceName::Srgb, rgb).map_err(|e| at(p, e));
            let default = if pigments { 0.0 } else { 1.3 };
            let zero = FloatTexture::Constant(0.0);
            let sigma_a: Box<[Curve; 2]> = Box::new([unit(PIGMENTS[0])?, unit(PIGMENTS[1])?]);
            let eumelanin = eumelanin.unwrap_or(FloatTexture::Constant(default));
            Ok(HairColour::Pigments { eumelanin, pheomelanin: pheomelanin.unwrap_or(zero), sigma_a })
        }
    }
}
