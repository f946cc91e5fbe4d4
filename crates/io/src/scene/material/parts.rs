//! Parameters that several materials share.

use crate::scene::{
    context::{Context, at, refuse},
    spectrum::{Purpose, float_or_curve},
    texture::Textures,
};
use tyndall_pbrt::{Error, ParamSet};
use tyndall_spectral::{Curve, named};
use tyndall_transport::{
    material::{ConductorMaterial, Metal, Roughness},
    texture::{FloatTexture, SpectrumTexture},
};

pub(super) fn albedo(
    p: &ParamSet,
    textures: &Textures<'_>,
    name: &str,
    default: f32,
) -> Result<SpectrumTexture, Error> {
    let default = SpectrumTexture::Constant(Curve::Constant(default));
    Ok(textures.spectrum(p, name, Purpose::Albedo)?.unwrap_or(default))
}

pub(super) fn conductor(
    p: &ParamSet,
    textures: &Textures<'_>,
    prefix: &str,
) -> Result<ConductorMaterial, Error> {
    let own = |name: &str| format!("{prefix}{name}");
    let eta = textures.spectrum(p, &own("eta"), Purpose::Unbounded)?;
    let k = textures.spectrum(p, &own("k"), Purpose::Unbounded)?;
    let reflectance = textures.spectrum(p, "reflectance", Purpose::Albedo)?;
    let copper =
        |name: &str| named::named_spectrum(name).ok_or_else(|| p.error(format!("no spectrum {name}")));
    let metal = match (reflectance, eta, k) {
        (Some(r), None, None) => Metal::Reflectance(r),
        (Some(_), _, _) => {
            return Err(at(p, "expected either \"reflectance\" or \"eta\" and \"k\", got both"));
        }
        (None, eta, k) => Metal::Index {
            eta: eta.map_or_else(|| copper("metal-Cu-eta").map(SpectrumTexture::Constant), Ok)?,
            k: k.map_or_else(|| copper("metal-Cu-k").map(SpectrumTexture::Constant), Ok)?,
        },
    };
    Ok(ConductorMaterial { metal, roughness: roughness(p, textures, prefix)? })
}

pub(super) fn eta(ctx: &Context<'_>, p: &ParamSet, name: &str, default: f32) -> Result<Curve, Error> {
    let eta = float_or_curve(ctx, p, name, Purpose::Unbounded)?.unwrap_or(Curve::Constant(default));
    let [low, high] = eta.bounds(ctx.range);
    if !(low > 0.0 && high.is_finite()) {
        let hint =
            "a table of indices must cover the whole range; \"string extrapolate\" \"hold\" keeps its ends";
        return Err(refuse(p, name, "must be > 0 at every wavelength of the film", low).hint(hint));
    }
    Ok(eta)
}

pub(super) fn roughness(p: &ParamSet, textures: &Textures<'_>, prefix: &str) -> Result<Roughness, Error> {
    let own = |name: &str| format!("{prefix}{name}");
    let both = textures.float(p, &own("roughness"))?.unwrap_or(FloatTexture::Constant(0.0));
    let one = |name: &str| Ok::<_, Error>(textures.float(p, name)?.unwrap_or_else(|| both.clone()));
    let (u, v) = (one(&own("uroughness"))?, one(&own("vroughness"))?);
    for (name, texture) in [("uroughness", &u), ("vroughness", &v)] {
        if let Some(value) = texture.constant().filter(|v| !(*v >= 0.0 && v.is_finite())) {
            let name = if p.contains(&own(name)) { own(name) } else { own("roughness") };
            return Err(refuse(p, &name, "must be finite and >= 0", value));
        }
    }
    Ok(Roughness { u, v, remap: p.bool("remaproughness", true)? })
}
