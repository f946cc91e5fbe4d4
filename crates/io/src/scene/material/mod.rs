//! `Material` and `MakeNamedMaterial`.

mod class;
mod coated;
mod hair;
mod measured;
mod parts;
mod relief;
mod subsurface;

use super::{
    collect::{Collected, Declared},
    context::{Context, refuse},
    state::MaterialRef,
    texture::Textures,
};
use std::collections::HashMap;
use tyndall_pbrt::{Error, ParamSet, Text};
use tyndall_spectral::Curve;
use tyndall_transport::{
    MaterialId,
    material::{DiffuseMaterial, Material, MixMaterial},
    media::Medium,
    texture::{FloatTexture, SpectrumTexture},
};

/// The scene's materials: inline ones in order, then named ones, then pbrt's default.
pub struct Materials {
    /// The table of the scene.
    pub table: Vec<Material>,
    inline: Vec<MaterialId>,
    named: HashMap<String, MaterialId>,
    default: MaterialId,
    /// Media that materials are filled with (`subsurface`).
    pub fillings: HashMap<u32, Medium>,
}

/// A material and what it is filled with.
struct Made {
    /// `None` for the interface.
    material: Option<Material>,
    filling: Option<Medium>,
}

/// The state of making all materials; mixes refer to named ones, whatever their order.
struct Maker<'a, 'c> {
    ctx: &'a Context<'c>,
    collected: &'a Collected,
    textures: &'a Textures<'a>,
    table: Vec<Material>,
    named: HashMap<String, MaterialId>,
    fillings: HashMap<u32, Medium>,
    /// Names of the mixes that are being made.
    open: Vec<String>,
}

impl Materials {
    /// Makes all materials.
    pub fn new(ctx: &Context<'_>, collected: &Collected, textures: &Textures<'_>) -> Result<Self, Error> {
        let mut maker = Maker {
            ctx,
            collected,
            textures,
            table: Vec::new(),
            named: HashMap::new(),
            fillings: HashMap::new(),
            open: Vec::new(),
        };
        let mut inline = Vec::new();
        for declared in &collected.materials {
            inline.push(maker.make(declared.name.as_str(), declared)?);
        }
        let mut sorted: Vec<_> = collected.named_materials.keys().collect();
        sorted.sort();
        for name in sorted {
            maker.named(name)?;
        }
        let grey = SpectrumTexture::Constant(Curve::Constant(0.5));
        let default = maker.add(Made {
            material: Some(Material::Diffuse(DiffuseMaterial { reflectance: grey })),
            filling: None,
        });
        let Maker { table, named, fillings, .. } = maker;
        Ok(Self { table, inline, named, default, fillings })
    }

    /// The material that a shape refers to.
    pub fn find(&self, reference: &MaterialRef, shape: &ParamSet) -> Result<MaterialId, Error> {
        match reference {
            MaterialRef::Default => Ok(self.default),
            MaterialRef::Inline(n) => Ok(self.inline[*n]),
            MaterialRef::Named(name) => {
                let names = self.named.keys().map(String::as_str);
                self.named.get(name.as_str()).copied().ok_or_else(|| unknown(shape, name.as_str(), names))
            }
        }
    }
}

fn unknown<'n>(params: &ParamSet, name: &str, known: impl Iterator<Item = &'n str>) -> Error {
    let e = params.error(format!("no material is named \"{name}\""));
    match tyndall_pbrt::did_you_mean(name, known) {
        Some(hint) => e.hint(hint),
        None => e,
    }
}

impl Maker<'_, '_> {
    fn add(&mut self, made: Made) -> MaterialId {
        let Some(material) = made.material else { return MaterialId::INTERFACE };
        let id = self.table.len() as u32;
        self.table.push(material);
        self.fillings.extend(made.filling.map(|medium| (id, medium)));
        MaterialId(id)
    }

    fn make(&mut self, class: &str, declared: &Declared) -> Result<MaterialId, Error> {
        let made = if class == "mix" {
            let material = self.mix(&declared.params)?;
            self.ctx.finish(&declared.params, &class::KNOWN);
            Made { material: Some(material), filling: None }
        } else {
            class::material(self.ctx, class, declared, self.textures)?
        };
        Ok(self.add(made))
    }

    /// The material of a name, made when first asked for.
    fn named(&mut self, name: &str) -> Result<MaterialId, Error> {
        if let Some(id) = self.named.get(name) {
            return Ok(*id);
        }
        let declared = &self.collected.named_materials[name];
        let params = &declared.params;
        if self.open.iter().any(|n| n == name) {
            return Err(params.error(format!("material \"{name}\" is a mix of itself")));
        }
        let class = params.string("type", "")?;
        if class.is_empty() {
            return Err(params.missing("string", "type"));
        }
        self.open.push(name.to_owned());
        let id = self.make(&class, declared)?;
        self.open.pop();
        self.named.insert(name.to_owned(), id);
        Ok(id)
    }

    fn mix(&mut self, p: &ParamSet) -> Result<Material, Error> {
        let names = p.strings("materials")?.ok_or_else(|| p.missing("string", "materials"))?;
        let [first, second] = names else {
            return Err(refuse(p, "materials", "must be the names of 2 materials", names.len()));
        };
        let materials = [self.part(p, first)?, self.part(p, second)?];
        let amount = self.textures.float(p, "amount")?.unwrap_or(FloatTexture::Constant(0.5));
        Ok(Material::Mix(Box::new(MixMaterial { materials, amount })))
    }

    /// A material of a mix; one with a filling would fill the shape where the other was chosen.
    fn part(&mut self, p: &ParamSet, name: &Text) -> Result<MaterialId, Error> {
        let name = name.as_str();
        if matches!(name, "interface" | "none" | "") && !self.collected.named_materials.contains_key(name) {
            return Ok(MaterialId::INTERFACE);
        }
        if !self.collected.named_materials.contains_key(name) {
            return Err(unknown(p, name, self.collected.named_materials.keys().map(String::as_str)));
        }
        let id = self.named(name)?;
        if !id.is_interface() && self.fillings.contains_key(&id.0) {
            let expected = "must be surfaces: \"subsurface\" fills its shape and cannot be mixed";
            return Err(refuse(p, "materials", expected, format!("\"{name}\"")));
        }
        Ok(id)
    }
}
