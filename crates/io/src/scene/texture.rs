//! `Texture` directives, and parameters that may name one.

use super::{
    collect::{Collected, TextureRecord},
    color_space,
    context::{Context, at, refuse},
    spectrum::{self, Purpose},
};
use std::{cell::RefCell, collections::HashMap, sync::Arc};
use tyndall_files::image::{Encoding, read_encoded};
use tyndall_geometry::Transform;
use tyndall_pbrt::{Error, FloatOrTexture, ParamSet, SpectrumOrTexture, TextureValue};
use tyndall_spectral::Curve;
use tyndall_transport::texture::{
    FloatTexture, ImageMap, Lookup, Mapping, RgbKind, RgbRule, SpectrumTexture, Texels, Wrap,
};

/// Textures by name, made when first asked for.
pub struct Textures<'a> {
    ctx: Context<'a>,
    records: HashMap<(String, bool), &'a TextureRecord>,
    floats: RefCell<HashMap<String, FloatTexture>>,
    spectra: RefCell<HashMap<(String, RgbKindKey), SpectrumTexture>>,
    images: RefCell<HashMap<(std::path::PathBuf, String), Arc<Texels>>>,
    open: RefCell<Vec<String>>,
}

type RgbKindKey = u8;

impl<'a> Textures<'a> {
    /// All textures of a scene.
    pub fn new(ctx: Context<'a>, collected: &'a Collected) -> Self {
        let key = |t: &TextureRecord| (t.defines.as_str().to_owned(), t.value == TextureValue::Float);
        let records = collected.textures.iter().map(|t| (key(t), t)).collect();
        Self {
            ctx,
            records,
            floats: RefCell::default(),
            spectra: RefCell::default(),
            images: RefCell::default(),
            open: RefCell::default(),
        }
    }

    /// The float parameter `name`; `None` if absent.
    pub fn float(&self, params: &ParamSet, name: &str) -> Result<Option<FloatTexture>, Error> {
        match params.float_or_texture(name)? {
            None => Ok(None),
            Some(FloatOrTexture::Float(v)) => Ok(Some(FloatTexture::Constant(v as f32))),
            Some(FloatOrTexture::Texture(text)) => self.named_float(params, name, text.as_str()).map(Some),
        }
    }

    /// The spectrum parameter `name`; `None` if absent.
    pub fn spectrum(
        &self,
        params: &ParamSet,
        name: &str,
        purpose: Purpose,
    ) -> Result<Option<SpectrumTexture>, Error> {
        match params.spectrum_or_texture(name)? {
            None => Ok(None),
            Some(SpectrumOrTexture::Spectrum(value)) => {
                let light = spectrum::one(&self.ctx, params, name, &value, purpose)?;
                Ok(Some(SpectrumTexture::Constant(light.curve)))
            }
            Some(SpectrumOrTexture::Texture(text)) => {
                self.named_spectrum(params, name, text.as_str(), purpose).map(Some)
            }
        }
    }

    /// Makes the textures that nothing refers to, so that their mistakes show too.
    pub fn check_all(&self) -> Result<(), Error> {
        for (key, record) in &self.records {
            let params = &record.declared.params;
            match key.1 {
                true => drop(self.named_float(params, "", &key.0)?),
                false if !self.spectra.borrow().keys().any(|(name, _)| *name == key.0) => {
                    drop(self.named_spectrum(params, "", &key.0, Purpose::Albedo)?);
                }
                false => {}
            }
        }
        Ok(())
    }

    fn record(
        &self,
        params: &ParamSet,
        parameter: &str,
        name: &str,
        float: bool,
    ) -> Result<&'a TextureRecord, Error> {
        if let Some(record) = self.records.get(&(name.to_owned(), float)) {
            return Ok(record);
        }
        let kind = if float { "float" } else { "spectrum" };
        let candidates = self.records.keys().filter(|k| k.1 == float).map(|k| k.0.as_str());
        let e = params.error_at(
            parameter,
            &format!("must be a {kind} texture of the scene"),
            &format!("\"{name}\""),
        );
        Err(match tyndall_pbrt::did_you_mean(name, candidates) {
            Some(hint) => e.hint(hint),
            None => e,
        })
    }

    /// Runs `make` unless the texture is being made already.
    fn guarded<T>(
        &self,
        params: &ParamSet,
        name: &str,
        make: impl FnOnce() -> Result<T, Error>,
    ) -> Result<T, Error> {
        if self.open.borrow().iter().any(|n| n == name) {
            return Err(params.error(format!("texture \"{name}\" refers to itself")));
        }
        self.open.borrow_mut().push(name.to_owned());
        let made = make();
        self.open.borrow_mut().pop();
        made
    }

    fn named_float(&self, params: &ParamSet, parameter: &str, name: &str) -> Result<FloatTexture, Error> {
        if let Some(made) = self.floats.borrow().get(name) {
            return Ok(made.clone());
        }
        let record = self.record(params, parameter, name, true)?;
        let made = self.guarded(params, name, || self.make_float(record))?;
        self.floats.borrow_mut().insert(name.to_owned(), made.clone());
        Ok(made)
    }

    fn named_spectrum(
        &self,
        params: &ParamSet,
        parameter: &str,
        name: &str,
        purpose: Purpose,
    ) -> Result<SpectrumTexture, Error> {
        let key = (name.to_owned(), purpose as RgbKindKey);
        if let Some(made) = self.spectra.borrow().get(&key) {
            return Ok(made.clone());
        }
        let record = self.record(params, parameter, name, false)?;
        let made = self.guarded(params, name, || self.make_spectrum(record, purpose))?;
        self.spectra.borrow_mut().insert(key, made.clone());
        Ok(made)
    }

    fn make_float(&self, record: &TextureRecord) -> Result<FloatTexture, Error> {
        let p = &record.declared.params;
        let tex = |name: &str, default: f32| {
            Ok::<_, Error>(self.float(p, name)?.unwrap_or(FloatTexture::Constant(default)))
        };
        let made = match record.declared.name.as_str() {
            "constant" => FloatTexture::Constant(p.float("value", 1.0)?),
            "scale" => FloatTexture::Scale(Arc::new((tex("tex", 1.0)?, tex("scale", 1.0)?))),
            "mix" => FloatTexture::Mix(Arc::new((tex("tex1", 0.0)?, tex("tex2", 1.0)?, tex("amount", 0.5)?))),
            "imagemap" => FloatTexture::Image(self.image(record, Purpose::Unbounded)?),
            other => return Err(unknown(p, other)),
        };
        self.ctx.finish(p, &KNOWN);
        Ok(made)
    }

    fn make_spectrum(&self, record: &TextureRecord, purpose: Purpose) -> Result<SpectrumTexture, Error> {
        let p = &record.declared.params;
        let tex = |name: &str, default: Curve| {
            Ok::<_, Error>(self.spectrum(p, name, purpose)?.unwrap_or(SpectrumTexture::Constant(default)))
        };
        let number = |name: &str, default: f32| {
            Ok::<_, Error>(self.float(p, name)?.unwrap_or(FloatTexture::Constant(default)))
        };
        let made = match record.declared.name.as_str() {
            "constant" => tex("value", Curve::ONE)?,
            "scale" => SpectrumTexture::Scale(Arc::new((tex("tex", Curve::ONE)?, number("scale", 1.0)?))),
            "mix" => {
                let (a, b) = (tex("tex1", Curve::ZERO)?, tex("tex2", Curve::ONE)?);
                SpectrumTexture::Mix(Arc::new((a, b, number("amount", 0.5)?)))
            }
            "imagemap" => SpectrumTexture::Image(self.image(record, purpose)?),
            other => return Err(unknown(p, other)),
        };
        self.ctx.finish(p, &KNOWN);
        Ok(made)
    }

    fn image(&self, record: &TextureRecord, purpose: Purpose) -> Result<Arc<ImageMap>, Error> {
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
            mapping: mapping(p, &record.declared.ctm.start)?,
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
        let texels = Arc::new(super::image::texels(&pixels).map_err(|e| at(p, e))?);
        self.images.borrow_mut().insert(key, texels.clone());
        Ok(texels)
    }
}

const KNOWN: [&str; 27] = [
    "value",
    "tex",
    "scale",
    "tex1",
    "tex2",
    "amount",
    "filename",
    "encoding",
    "filter",
    "wrap",
    "invert",
    "mapping",
    "uscale",
    "vscale",
    "udelta",
    "vdelta",
    "v1",
    "v2",
    "maxanisotropy",
    "extrapolate",
    "interpolation",
    "dimension",
    "inside",
    "outside",
    "octaves",
    "roughness",
    "variation",
];

fn unknown(p: &ParamSet, class: &str) -> Error {
    p.error(format!("texture class \"{class}\" is not supported"))
        .hint("this version has constant, scale, mix and imagemap")
}

/// `mapping` and its parameters.
fn mapping(p: &ParamSet, to_world: &Transform) -> Result<Mapping, Error> {
    let to_texture = Box::new(to_world.inverse());
    Ok(match p.string("mapping", "uv")?.as_str() {
        "uv" => Mapping::Uv {
            scale: [p.float("uscale", 1.0)?, p.float("vscale", 1.0)?],
            delta: [p.float("udelta", 0.0)?, p.float("vdelta", 0.0)?],
        },
        "spherical" => Mapping::Spherical(to_texture),
        "cylindrical" => Mapping::Cylindrical(to_texture),
        "planar" => {
            let v = |name, default| {
                let v = p.vector3_opt(name)?.unwrap_or(default);
                Ok::<_, Error>(v.map(|x: f64| x as f32).into())
            };
            Mapping::Planar {
                to_texture,
                v: [v("v1", [1.0, 0.0, 0.0])?, v("v2", [0.0, 1.0, 0.0])?],
                delta: [p.float("udelta", 0.0)?, p.float("vdelta", 0.0)?],
            }
        }
        other => {
            let expected = "must be uv, spherical, cylindrical or planar";
            return Err(refuse(p, "mapping", expected, format!("\"{other}\"")));
        }
    })
}
