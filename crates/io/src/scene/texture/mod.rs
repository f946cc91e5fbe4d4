//! `Texture` directives, and parameters that may name one.

mod float;
mod imagemap;
mod mapping;
mod spectrum;
mod weight;

use super::{
    collect::{Collected, TextureRecord},
    context::Context,
    spectrum::{self as spectra, Purpose},
};
use std::{cell::RefCell, collections::HashMap, sync::Arc};
use tyndall_pbrt::{Error, FloatOrTexture, ParamSet, SpectrumOrTexture, TextureValue};
use tyndall_transport::texture::{FloatTexture, SpectrumTexture, Texels};

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
                let light = spectra::one(&self.ctx, params, name, &value, purpose)?;
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
                // a use decides what the spectrum is for; without one, the least strict rule does
                false if !self.spectra.borrow().keys().any(|(name, _)| *name == key.0) => {
                    drop(self.named_spectrum(params, "", &key.0, Purpose::Unbounded)?);
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
}

/// Parameters of any texture class, for hints.
const KNOWN: [&str; 36] = [
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
    "dir",
    "v00",
    "v01",
    "v10",
    "v11",
    "faces",
    "gamma",
    "trilinear",
    "type",
];

/// The error of a class that no texture of this kind has.
fn unknown(p: &ParamSet, class: &str, kind: &str, classes: &str) -> Error {
    if class == "ptex" {
        let hint = "per-face textures (Ptex) are not read; bake the texture to an image with uv coordinates";
        return p.error("texture class \"ptex\" is not supported").hint(hint);
    }
    p.error(format!("{kind} texture class \"{class}\" is not known")).hint(format!("known are {classes}"))
}
