//! `Material` and `MakeNamedMaterial`: classes and their parameters.

use super::{
    Made, coated, hair, measured,
    parts::{albedo, conductor, eta, roughness},
    relief, subsurface,
};
use crate::scene::{collect::Declared, context::Context, texture::Textures};
use tyndall_pbrt::Error;
use tyndall_transport::material::{
    DielectricMaterial, DiffuseMaterial, DiffuseTransmissionMaterial, Material, ThinDielectricMaterial,
};

/// Parameters of any class, for hints.
pub(super) const KNOWN: [&str; 42] = [
    "type",
    "reflectance",
    "transmittance",
    "scale",
    "eta",
    "k",
    "roughness",
    "uroughness",
    "vroughness",
    "remaproughness",
    "displacement",
    "normalmap",
    "extrapolate",
    "interpolation",
    "materials",
    "amount",
    "thickness",
    "albedo",
    "g",
    "maxdepth",
    "nsamples",
    "interface.roughness",
    "interface.uroughness",
    "interface.vroughness",
    "interface.eta",
    "conductor.eta",
    "conductor.k",
    "conductor.roughness",
    "conductor.uroughness",
    "conductor.vroughness",
    "sigma_a",
    "sigma_s",
    "mfp",
    "name",
    "eumelanin",
    "pheomelanin",
    "color",
    "beta_m",
    "beta_n",
    "alpha",
    "filename",
    "coating",
];

/// The material of a directive; `None` within is the interface.
pub(super) fn material(
    ctx: &Context<'_>,
    class: &str,
    declared: &Declared,
    textures: &Textures<'_>,
) -> Result<Made, Error> {
    let p = &declared.params;
    let mut filling = None;
    let made = match class {
        "interface" | "" | "none" => None,
        "diffuse" => {
            Some(Material::Diffuse(DiffuseMaterial { reflectance: albedo(p, textures, "reflectance", 0.5)? }))
        }
        "diffusetransmission" => Some(Material::DiffuseTransmission(DiffuseTransmissionMaterial {
            reflectance: albedo(p, textures, "reflectance", 0.25)?,
            transmittance: albedo(p, textures, "transmittance", 0.25)?,
            scale: p.float("scale", 1.0)?,
        })),
        "conductor" => Some(Material::Conductor(conductor(p, textures, "")?)),
        "dielectric" => Some(Material::Dielectric(DielectricMaterial {
            eta: eta(ctx, p, "eta", 1.5)?,
            roughness: roughness(p, textures, "")?,
        })),
        "thindielectric" => {
            Some(Material::ThinDielectric(ThinDielectricMaterial { eta: eta(ctx, p, "eta", 1.5)? }))
        }
        "coateddiffuse" => Some(Material::Coated(Box::new(coated::diffuse(ctx, p, textures)?))),
        "coatedconductor" => Some(Material::Coated(Box::new(coated::conductor(ctx, p, textures)?))),
        "hair" => Some(Material::Hair(Box::new(hair::hair(ctx, p, textures)?))),
        "measured" => Some(Material::Measured(measured::material(ctx, p)?)),
        "subsurface" => {
            filling = Some(subsurface::medium(ctx, p, textures)?);
            let (eta, roughness) = (eta(ctx, p, "eta", 1.33)?, roughness(p, textures, "")?);
            Some(Material::Dielectric(DielectricMaterial { eta, roughness }))
        }
        other => {
            let hint = "known are diffuse, diffusetransmission, conductor, dielectric, thindielectric, coateddiffuse, coatedconductor, subsurface, hair, measured, mix and interface";
            return Err(p.error(format!("material \"{other}\" is not supported")).hint(hint));
        }
    };
    let made = made.map(|m| relief::applied(ctx, declared, textures, m)).transpose()?;
    ctx.finish(p, &KNOWN);
    Ok(Made { material: made, filling })
}
