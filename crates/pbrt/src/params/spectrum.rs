//! Getters of spectra, and of values that may come from a texture.

use std::sync::Arc;

use super::{Param, ParamSet, ParamType, Values};
use crate::error::Error;
use crate::text::Text;

/// A spectrum as the scene gives it; what it means is the reader's business.
#[derive(Clone, Debug, PartialEq)]
pub enum SpectrumValue {
    /// `rgb`: three numbers in a colour space (none: the one in force, which only the reader knows).
    Rgb {
        /// Red, green, blue.
        rgb: [f64; 3],
        /// Name noted by [`ParamSet::set_color_space`].
        color_space: Option<Arc<str>>,
    },
    /// `blackbody`: temperature in kelvin.
    Blackbody(f64),
    /// `spectrum` as pairs: wavelengths in nm and values, in the order of the text.
    Samples {
        /// Wavelengths in nm.
        lambda: Vec<f64>,
        /// Values.
        values: Vec<f64>,
    },
    /// `spectrum` as a string: a named spectrum or, failing that, a file.
    Named(Text),
}

/// A number or the name of a texture.
#[derive(Clone, Debug, PartialEq)]
pub enum FloatOrTexture {
    /// `float`
    Float(f64),
    /// `texture`
    Texture(Text),
}

/// A spectrum or the name of a texture.
#[derive(Clone, Debug, PartialEq)]
pub enum SpectrumOrTexture {
    /// `rgb`, `blackbody` or `spectrum`
    Spectrum(SpectrumValue),
    /// `texture`
    Texture(Text),
}

const SPECTRA: [ParamType; 3] = [ParamType::Spectrum, ParamType::Rgb, ParamType::Blackbody];

impl ParamSet {
    /// `spectrum`, `rgb` or `blackbody`: one spectrum; none if absent.
    ///
    /// # Errors
    /// Another type, or not exactly one spectrum.
    pub fn spectrum(&self, name: &str) -> Result<Option<SpectrumValue>, Error> {
        let Some(mut all) = self.spectra(name)? else { return Ok(None) };
        match (all.pop(), all.len()) {
            (Some(one), 0) => Ok(Some(one)),
            (_, more) => Err(self.error_at(name, "must be one spectrum", &format!("{} of them", more + 1))),
        }
    }

    /// `spectrum`, `rgb` or `blackbody`: a list of spectra (all pairs of numbers make up one); none if absent.
    ///
    /// # Errors
    /// Another type, or no value in the list.
    pub fn spectra(&self, name: &str) -> Result<Option<Vec<SpectrumValue>>, Error> {
        Ok(self.lookup(name, &SPECTRA)?.map(spectra_of))
    }

    /// `float` or `texture`; none if absent.
    ///
    /// # Errors
    /// Another type, or not exactly one value.
    pub fn float_or_texture(&self, name: &str) -> Result<Option<FloatOrTexture>, Error> {
        match self.type_of(name) {
            Some(ParamType::Texture) => {
                Ok(self.texture_opt(name)?.map(|t| FloatOrTexture::Texture(t.clone())))
            }
            Some(kind) if kind != ParamType::Float => {
                self.lookup(name, &[ParamType::Float, ParamType::Texture]).map(|_| None)
            }
            _ => Ok(self.float64_opt(name)?.map(FloatOrTexture::Float)),
        }
    }

    /// `spectrum`, `rgb`, `blackbody` or `texture`; none if absent.
    ///
    /// # Errors
    /// Another type, or not exactly one value.
    pub fn spectrum_or_texture(&self, name: &str) -> Result<Option<SpectrumOrTexture>, Error> {
        match self.type_of(name) {
            Some(ParamType::Texture) => {
                Ok(self.texture_opt(name)?.map(|t| SpectrumOrTexture::Texture(t.clone())))
            }
            Some(kind) if !SPECTRA.contains(&kind) => {
                let [a, b, c] = SPECTRA;
                self.lookup(name, &[a, b, c, ParamType::Texture]).map(|_| None)
            }
            _ => Ok(self.spectrum(name)?.map(SpectrumOrTexture::Spectrum)),
        }
    }
}

fn spectra_of(param: &Param) -> Vec<SpectrumValue> {
    match &*param.values {
        Values::Strings(names) => names.iter().cloned().map(SpectrumValue::Named).collect(),
        Values::Numbers(numbers) => {
            let v = numbers.to_f64();
            match param.info.kind {
                ParamType::Rgb => v.as_chunks::<3>().0.iter().map(|&rgb| rgb_value(param, rgb)).collect(),
                ParamType::Blackbody => v.iter().copied().map(SpectrumValue::Blackbody).collect(),
                _ => vec![samples(&v)],
            }
        }
        Values::Integers(_) | Values::Bools(_) => Vec::new(),
    }
}

fn rgb_value(param: &Param, rgb: [f64; 3]) -> SpectrumValue {
    SpectrumValue::Rgb { rgb, color_space: param.color_space.clone() }
}

fn samples(pairs: &[f64]) -> SpectrumValue {
    let (lambda, values) = pairs.as_chunks::<2>().0.iter().map(|&[l, v]| (l, v)).unzip();
    SpectrumValue::Samples { lambda, values }
}
