//! Textures: numbers and spectra that vary over a surface.

mod imagemap;
mod mapping;
mod marble;
mod noise;
mod weight;

pub use imagemap::{ImageMap, Lookup, RgbKind, RgbRule, Texels, Wrap};
pub use mapping::{Mapping, TextureContext};
pub use marble::Marble;
pub use noise::{NoiseKind, NoiseTexture};
pub use weight::Weight;

use std::sync::Arc;
use tyndall_spectral::{Curve, Spectrum, Wavelengths};

/// A number over a surface.
#[derive(Clone, Debug)]
pub enum FloatTexture {
    /// The same everywhere.
    Constant(f32),
    /// Product of two.
    Scale(Arc<(Self, Self)>),
    /// `(1 - w) a + w b`, in the order `(a, b, w)`.
    Mix(Arc<(Self, Self, Weight)>),
    /// Sums of gradient noise.
    Noise(Arc<NoiseTexture>),
    /// First channel of an image.
    Image(Arc<ImageMap>),
}

impl FloatTexture {
    /// The value at `at`.
    pub fn eval(&self, at: &TextureContext) -> f32 {
        match self {
            Self::Constant(v) => *v,
            Self::Scale(t) => t.0.eval(at) * t.1.eval(at),
            Self::Mix(t) => match t.2.eval(at) {
                0.0 => t.0.eval(at),
                1.0 => t.1.eval(at),
                w => (1.0 - w) * t.0.eval(at) + w * t.1.eval(at),
            },
            Self::Noise(noise) => noise.eval(at),
            Self::Image(image) => image.float(at),
        }
    }

    /// The value when it is the same everywhere.
    pub fn constant(&self) -> Option<f32> {
        if let Self::Constant(v) = self { Some(*v) } else { None }
    }
}

/// A spectrum over a surface.
#[derive(Clone, Debug)]
pub enum SpectrumTexture {
    /// The same everywhere.
    Constant(Curve),
    /// A spectrum texture times a float texture.
    Scale(Arc<(Self, FloatTexture)>),
    /// `(1 - w) a + w b`, in the order `(a, b, w)`.
    Mix(Arc<(Self, Self, Weight)>),
    /// Veined stone.
    Marble(Arc<Marble>),
    /// An RGB image whose texels are turned into spectra.
    Image(Arc<ImageMap>),
}

impl SpectrumTexture {
    /// The value at `at` for the wavelengths `w`.
    #[inline]
    pub fn eval<const N: usize>(&self, at: &TextureContext, w: &Wavelengths<N>) -> Spectrum<N> {
        match self {
            Self::Constant(c) => c.sample(w),
            _ => self.eval_varying(at, w),
        }
    }

    fn eval_varying<const N: usize>(&self, at: &TextureContext, w: &Wavelengths<N>) -> Spectrum<N> {
        match self {
            Self::Constant(c) => c.sample(w),
            Self::Scale(t) => t.0.eval(at, w) * t.1.eval(at),
            Self::Mix(t) => match t.2.eval(at) {
                0.0 => t.0.eval(at, w),
                1.0 => t.1.eval(at, w),
                amount => t.0.eval(at, w) * (1.0 - amount) + t.1.eval(at, w) * amount,
            },
            Self::Marble(marble) => marble.eval(at, w),
            Self::Image(image) => image.spectrum(at, w),
        }
    }

    /// The curve when it is the same everywhere.
    pub fn constant(&self) -> Option<&Curve> {
        if let Self::Constant(c) = self { Some(c) } else { None }
    }
}
