//! `coateddiffuse` and `coatedconductor`.

use super::parts::{self, albedo, eta, roughness};
use crate::scene::{
    context::{Context, refuse},
    texture::Textures,
};
use tyndall_pbrt::{Error, ParamSet};
use tyndall_transport::{
    material::{CoatedBase, CoatedMaterial, DiffuseMaterial},
    texture::FloatTexture,
};

pub(super) fn diffuse(
    ctx: &Context<'_>,
    p: &ParamSet,
    textures: &Textures<'_>,
) -> Result<CoatedMaterial, Error> {
    let reflectance = albedo(p, textures, "reflectance", 0.5)?;
    coated(ctx, p, textures, CoatedBase::Diffuse(DiffuseMaterial { reflectance }), "")
}

pub(super) fn conductor(
    ctx: &Context<'_>,
    p: &ParamSet,
    textures: &Textures<'_>,
) -> Result<CoatedMaterial, Error> {
    let base = CoatedBase::Conductor(parts::conductor(p, textures, "conductor.")?);
    coated(ctx, p, textures, base, "interface.")
}

/// Most events and walks: more would take forever at every visit.
const MOST: i32 = 10_000;

fn coated(
    ctx: &Context<'_>,
    p: &ParamSet,
    textures: &Textures<'_>,
    base: CoatedBase,
    prefix: &str,
) -> Result<CoatedMaterial, Error> {
    let number = |name: &str, default: f32| {
        Ok::<_, Error>(textures.float(p, name)?.unwrap_or(FloatTexture::Constant(default)))
    };
    let count = |name: &str, default: i32| {
        let n = p.integer(name, default)?;
        if (1..=MOST).contains(&n) {
            return Ok(n as u32);
        }
        Err(refuse(p, name, "must be between 1 and 10000", n))
    };
    let thickness = number("thickness", 0.01)?;
    if let Some(bad) = thickness.constant().filter(|t| !(*t >= 0.0 && t.is_finite())) {
        return Err(refuse(p, "thickness", "must be finite and >= 0", bad));
    }
    Ok(CoatedMaterial {
        base,
        eta: eta(ctx, p, &format!("{prefix}eta"), 1.5)?,
        roughness: roughness(p, textures, prefix)?,
        thickness,
        albedo: albedo(p, textures, "albedo", 0.0)?,
        g: number("g", 0.0)?,
        max_depth: count("maxdepth", 10)?,
        samples: count("nsamples", 1)?,
    })
}
