//! `normalmap` and `displacement` of any material.

use crate::scene::{
    collect::Declared,
    context::{Context, at},
    texture::Textures,
};
use std::sync::Arc;
use tyndall_files::image::{Encoding, read_encoded};
use tyndall_pbrt::Error;
use tyndall_spectral::SpaceName;
use tyndall_transport::{
    material::{MappedMaterial, Material, Relief},
    texture::{ImageMap, Lookup, Mapping, RgbKind, RgbRule, Wrap},
};

/// `material` with the relief that the parameters give it, if any.
pub(super) fn applied(
    ctx: &Context<'_>,
    declared: &Declared,
    textures: &Textures<'_>,
    material: Material,
) -> Result<Material, Error> {
    let p = &declared.params;
    let normals = p.string_opt("normalmap")?.filter(|name| !name.as_str().is_empty());
    let relief = match (textures.float(p, "displacement")?, normals) {
        (Some(_), Some(_)) => {
            return Err(p.error("expected \"displacement\" or \"normalmap\", got both"));
        }
        (Some(height), None) if height.constant().is_none() => Relief::Heights(height),
        (None, Some(name)) => {
            let path = ctx.file(p, "normalmap", name)?;
            // normals are numbers, whatever encoding colours would have
            let pixels = read_encoded(&path, Some(Encoding::Linear)).map_err(|e| at(p, e))?;
            let texels = crate::scene::image::texels(&pixels).map_err(|e| at(p, e))?;
            if texels.channels != 3 {
                return Err(p.error_at("normalmap", "must be an image with R, G and B", "one channel"));
            }
            Relief::Normals(ImageMap {
                texels: Arc::new(texels),
                mapping: Mapping::default(),
                wrap: Wrap::Repeat,
                lookup: Lookup::Bilinear,
                scale: 1.0,
                invert: false,
                rule: RgbRule { space: SpaceName::Srgb, kind: RgbKind::Unbounded },
            })
        }
        _ => return Ok(material),
    };
    Ok(Material::Mapped(Box::new(MappedMaterial { material, relief })))
}
