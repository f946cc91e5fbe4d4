//! `Material` and `MakeNamedMaterial`.

use super::{
    collect::{Collected, Declared},
    context::{Context, at, refuse},
    spectrum::{Purpose, float_or_curve},
    state::MaterialRef,
    texture::Textures,
};
use std::collections::HashMap;
use tyndall_pbrt::{Error, ParamSet};
use tyndall_spectral::{Curve, named};
use tyndall_transport::{
    MaterialId,
    material::{
        ConductorMaterial, DielectricMaterial, DiffuseMaterial, DiffuseTransmissionMaterial, Material, Metal,
        Roughness, ThinDielectricMaterial,
    },
    texture::{FloatTexture, SpectrumTexture},
};

/// The scene's materials: inline ones in order, then named ones, then pbrt's default.
pub struct Materials {
    /// The table of the scene.
    pub table: Vec<Material>,
    inline: Vec<MaterialId>,
    named: HashMap<String, MaterialId>,
    default: MaterialId,
}

impl Materials {
    /// Makes all materials.
    pub fn new(ctx: &Context<'_>, collected: &Collected, textures: &Textures<'_>) -> Result<Self, Error> {
        let mut table = Vec::new();
        let mut add = |material: Option<Material>| match material {
            None => MaterialId::INTERFACE,
            Some(material) => {
                table.push(material);
                MaterialId(table.len() as u32 - 1)
            }
        };
        let mut inline = Vec::new();
        for declared in &collected.materials {
            inline.push(add(material(ctx, declared.name.as_str(), declared, textures)?));
        }
        let mut named = HashMap::new();
        let mut sorted: Vec<_> = collected.named_materials.iter().collect();
        sorted.sort_by(|a, b| a.0.cmp(b.0));
        for (name, declared) in sorted {
            let class = declared.params.string("type", "")?;
            if class.is_empty() {
                return Err(declared.params.missing("string", "type"));
            }
            named.insert(name.clone(), add(material(ctx, &class, declared, textures)?));
        }
        let grey = SpectrumTexture::Constant(Curve::Constant(0.5));
        let default = add(Some(Material::Diffuse(DiffuseMaterial { reflectance: grey })));
        Ok(Self { table, inline, named, default })
    }

    /// The material that a shape refers to.
    pub fn find(&self, reference: &MaterialRef, shape: &ParamSet) -> Result<MaterialId, Error> {
        match reference {
            MaterialRef::Default => Ok(self.default),
            MaterialRef::Inline(n) => Ok(self.inline[*n]),
            MaterialRef::Named(name) => self.named.get(name.as_str()).copied().ok_or_else(|| {
                let e = shape.error(format!("no material is named \"{}\"", name.as_str()));
                match tyndall_pbrt::did_you_mean(name.as_str(), self.named.keys().map(String::as_str)) {
                    Some(hint) => e.hint(hint),
                    None => e,
                }
            }),
        }
    }
}

const KNOWN: [&str; 14] = [
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
];

/// `None` is the interface material.
fn material(
    ctx: &Context<'_>,
    class: &str,
    declared: &Declared,
    textures: &Textures<'_>,
) -> Result<Option<Material>, Error> {
    let p = &declared.params;
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
        "conductor" => Some(Material::Conductor(conductor(p, textures)?)),
        "dielectric" => Some(Material::Dielectric(DielectricMaterial {
            eta: eta(ctx, p)?,
            roughness: roughness(p, textures)?,
        })),
        "thindielectric" => Some(Material::ThinDielectric(ThinDielectricMaterial { eta: eta(ctx, p)? })),
        other => {
            let hint = "this version has diffuse, diffusetransmission, conductor, dielectric, thindielectric and interface";
            return Err(p.error(format!("material \"{other}\" is not supported")).hint(hint));
        }
    };
    for name in ["displacement", "normalmap"] {
        if p.contains(name) {
            p.unsupported(name, "bump and normal maps are not supported in this version");
            p.warn_at(
                name,
                format!("{name}: not supported in this version; the surface stays smooth"),
                ctx.warnings,
            );
        }
    }
    ctx.finish(p, &KNOWN);
    Ok(made)
}

fn albedo(p: &ParamSet, textures: &Textures<'_>, name: &str, default: f32) -> Result<SpectrumTexture, Error> {
    let default = SpectrumTexture::Constant(Curve::Constant(default));
    Ok(textures.spectrum(p, name, Purpose::Albedo)?.unwrap_or(default))
}

fn conductor(p: &ParamSet, textures: &Textures<'_>) -> Result<ConductorMaterial, Error> {
    let eta = textures.spectrum(p, "eta", Purpose::Unbounded)?;
    let k = textures.spectrum(p, "k", Purpose::Unbounded)?;
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
    Ok(ConductorMaterial { metal, roughness: roughness(p, textures)? })
}

fn eta(ctx: &Context<'_>, p: &ParamSet) -> Result<Curve, Error> {
    let eta = float_or_curve(ctx, p, "eta", Purpose::Unbounded)?.unwrap_or(Curve::Constant(1.5));
    let [low, high] = eta.bounds(ctx.range);
    if !(low > 0.0 && high.is_finite()) {
        let hint =
            "a table of indices must cover the whole range; \"string extrapolate\" \"hold\" keeps its ends";
        return Err(refuse(p, "eta", "must be > 0 at every wavelength of the film", low).hint(hint));
    }
    Ok(eta)
}

fn roughness(p: &ParamSet, textures: &Textures<'_>) -> Result<Roughness, Error> {
    let both = textures.float(p, "roughness")?.unwrap_or(FloatTexture::Constant(0.0));
    let one = |name: &str| Ok::<_, Error>(textures.float(p, name)?.unwrap_or_else(|| both.clone()));
    let (u, v) = (one("uroughness")?, one("vroughness")?);
    for (name, texture) in [("uroughness", &u), ("vroughness", &v)] {
        if let Some(value) = texture.constant().filter(|v| !(*v >= 0.0 && v.is_finite())) {
            let name = if p.contains(name) { name } else { "roughness" };
            return Err(refuse(p, name, "must be finite and >= 0", value));
        }
    }
    Ok(Roughness { u, v, remap: p.bool("remaproughness", true)? })
}
