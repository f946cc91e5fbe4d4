//! `imagemap`: the file, how it is looked up, and what its colours mean.

use super::Textures;
use crate::scene::{
    collect::TextureRecord,
    color_space,
    context::{at, refuse},
    spectrum::Purpose,
};
use std::sync::Arc;
use tyndall_files::image::{Encoding, read_encoded};
use tyndall_pbrt::{Error, ParamSet};
use tyndall_transport::texture::{ImageMap, Lookup, RgbKind, RgbRule, Texels, Wrap};

impl Textures<'_> {
    pub(super) fn image(&self, record: &TextureRecord, purpose: Purpose) -> Result<Arc<ImageMap>, Error> {
        let p = &record.declared.params;
        let text = p.string_opt("filename")?.ok_or_else(|| p.missing("string", "filename"))?;
        let path = self.ctx.file(p, "filename", text)?;
        let encoding = p.string("encoding", "")?;
        let texels = self.texels(p, path, &encoding)?;
        p.ignore("maxanisotropy", "textures are filtered by the pixel's samples");
        let lookup = match p.string("filter", "bilinear")?.as_str() {
            "point" => Lookup::Point,
            "bilinear" => Lookup::Bilinear,
            "trilinear" | "ewa" | "EWA" => {
                p.ignore("filter", "bilinear: the pixel's samples do the filtering");
                Lookup::Bilinear
            }
            other => {
                return Err(refuse(
                    p,
                    "filter",
                    "must be point, bilinear, trilinear or ewa",
                    format!("\"{other}\""),
                ));
            }
        };
        let wrap = match p.string("wrap", "repeat")?.as_str() {
            "repeat" => Wrap::Repeat,
            "black" => Wrap::Black,
            "clamp" => Wrap::Clamp,
            "octahedralsphere" => Wrap::Octahedral,
            other => {
                let expected = "must be repeat, black, clamp or octahedralsphere";
                return Err(refuse(p, "wrap", expected, format!("\"{other}\"")));
            }
        };
        let kind = match purpose {
            Purpose::Illuminant => RgbKind::Illuminant,
            Purpose::Albedo => RgbKind::Albedo,
            Purpose::Unbounded => RgbKind::Unbounded,
        };
        Ok(Arc::new(ImageMap {
            texels,
            mapping: super::mapping::mapping(p, &record.declared.ctm.start)?,
            wrap,
            lookup,
            scale: p.float("scale", 1.0)?,
            invert: p.bool("invert", false)?,
            rule: RgbRule { space: color_space::name(&record.declared.color_space), kind },
        }))
    }

    fn texels(&self, p: &ParamSet, path: std::path::PathBuf, encoding: &str) -> Result<Arc<Texels>, Error> {
        let key = (path, encoding.to_owned());
        if let Some(known) = self.images.borrow().get(&key) {
            return Ok(known.clone());
        }
        let chosen = if encoding.is_empty() {
            None
        } else {
            let unknown =
                || refuse(p, "encoding", "must be sRGB, linear or \"gamma g\"", format!("\"{encoding}\""));
            Some(Encoding::from_words(encoding).ok_or_else(unknown)?)
        };
        let pixels = read_encoded(&key.0, chosen).map_err(|e| at(p, e))?;
        let texels = Arc::new(crate::scene::image::texels(&pixels).map_err(|e| at(p, e))?);
        self.images.borrow_mut().insert(key, texels.clone());
        Ok(texels)
    }
}
