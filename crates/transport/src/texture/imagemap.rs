//! `imagemap`: texels of an image, nearest or bilinear.
//!
//! pbrt's `trilinear` and `ewa` filters need ray differentials; here they are bilinear, and the pixel's many samples
//! do the filtering. (0, 0) of texture space is the lower left corner of the image.

use super::{Mapping, TextureContext};
use std::sync::Arc;
use tyndall_base::Vec2;
use tyndall_spectral::{
    Spectrum, Wavelengths,
    colour::{ColourSpace, SpaceName},
    upsample::RgbTable,
};

/// What the spectrum of a colour is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RgbKind {
    /// Reflectance: colours are clamped to \[0, 1\].
    Albedo,
    /// Coefficient: twice the greatest component times a reflectance.
    Unbounded,
    /// Emission: likewise times the white of the colour space.
    Illuminant,
}

/// How a colour becomes a spectrum.
#[derive(Clone, Copy, Debug)]
pub struct RgbRule {
    /// The space that the colours are in.
    pub space: SpaceName,
    /// What the spectrum is for.
    pub kind: RgbKind,
}

impl RgbRule {
    /// The spectrum of `rgb` (components >= 0) at the wavelengths `w` (Jakob & Hanika 2019).
    pub fn sample<const N: usize>(&self, rgb: [f32; 3], w: &Wavelengths<N>) -> Spectrum<N> {
        let table = RgbTable::get(self.space);
        if self.kind == RgbKind::Albedo {
            let sigmoid = table.coefficients(rgb);
            return Spectrum::from_fn(|k| sigmoid.eval(w.lambda[k]));
        }
        let scale = 2.0 * rgb[0].max(rgb[1]).max(rgb[2]);
        if scale == 0.0 {
            return Spectrum::ZERO;
        }
        let sigmoid = table.coefficients(rgb.map(|c| c / scale));
        let unbounded = Spectrum::from_fn(|k| scale * sigmoid.eval(w.lambda[k]));
        match self.kind {
            RgbKind::Illuminant => unbounded * ColourSpace::get(self.space).illuminant.sample(w),
            _ => unbounded,
        }
    }
}

/// What lies beyond the image's edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// The image again.
    #[default]
    Repeat,
    /// Zero.
    Black,
    /// The edge's texel.
    Clamp,
    /// The octahedral neighbour of an environment map.
    Octahedral,
}

/// How texels are combined.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Lookup {
    /// The texel that holds the point.
    Point,
    /// Bilinear between the four nearest texel centres.
    #[default]
    Bilinear,
}

/// Linear values, row by row from the top.
#[derive(Clone, Debug)]
pub struct Texels {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// 1 (grey) or 3 (RGB) values a texel.
    pub channels: usize,
    /// `width * height * channels` values.
    pub data: Vec<f32>,
}

/// Parameters: see pbrt's `imagemap`.
#[derive(Clone, Debug)]
pub struct ImageMap {
    /// The texels, shared by all maps of one file.
    pub texels: Arc<Texels>,
    /// Surface to texture coordinates.
    pub mapping: Mapping,
    /// Rule at the edge.
    pub wrap: Wrap,
    /// Filter.
    pub lookup: Lookup,
    /// Factor on every value.
    pub scale: f32,
    /// Use `1 - value`.
    pub invert: bool,
    /// How RGB becomes a spectrum.
    pub rule: RgbRule,
}

impl ImageMap {
    /// The first channel at `at` (the mean of RGB when the image has colour, as pbrt's float lookup).
    pub fn float(&self, at: &TextureContext) -> f32 {
        let v = self.filtered(at);
        let v = self.scale * if self.texels.channels == 1 { v[0] } else { (v[0] + v[1] + v[2]) / 3.0 };
        if self.invert { (1.0 - v).max(0.0) } else { v }
    }

    /// The spectrum at `at` for the wavelengths `w`.
    pub fn spectrum<const N: usize>(&self, at: &TextureContext, w: &Wavelengths<N>) -> Spectrum<N> {
        let rgb = self.filtered(at).map(|v| {
            let v = self.scale * v;
            (if self.invert { 1.0 - v } else { v }).max(0.0)
        });
        if self.texels.channels == 1 {
            return Spectrum::splat(rgb[0]);
        }
        self.rule.sample(rgb, w)
    }

    /// Three channels at `at` as they are.
    pub fn vector(&self, at: &TextureContext) -> [f32; 3] {
        self.filtered(at)
    }

    fn filtered(&self, at: &TextureContext) -> [f32; 3] {
        let st = self.mapping.st(at);
        let (x, y) = (st.x * self.texels.width as f32, (1.0 - st.y) * self.texels.height as f32);
        match self.lookup {
            Lookup::Point => self.texel(floor(x), floor(y)),
            Lookup::Bilinear => self.bilinear(Vec2 { x: x - 0.5, y: y - 0.5 }),
        }
    }

    fn bilinear(&self, p: Vec2) -> [f32; 3] {
        let (x, y) = (floor(p.x), floor(p.y));
        let (fx, fy) = (p.x - x as f32, p.y - y as f32);
        let [a, b] = [self.texel(x, y), self.texel(x + 1, y)];
        let [c, d] = [self.texel(x, y + 1), self.texel(x + 1, y + 1)];
        std::array::from_fn(|k| {
            (1.0 - fy) * ((1.0 - fx) * a[k] + fx * b[k]) + fy * ((1.0 - fx) * c[k] + fx * d[k])
        })
    }

    fn texel(&self, x: i64, y: i64) -> [f32; 3] {
        let (w, h) = (self.texels.width as i64, self.texels.height as i64);
        let Some((x, y)) = self.wrapped(x, y, w, h) else { return [0.0; 3] };
        let first = (y * w + x) as usize * self.texels.channels;
        let data = &self.texels.data[first..];
        if self.texels.channels == 1 { [data[0]; 3] } else { [data[0], data[1], data[2]] }
    }

    fn wrapped(&self, x: i64, y: i64, w: i64, h: i64) -> Option<(i64, i64)> {
        let inside = (0..w).contains(&x) && (0..h).contains(&y);
        match self.wrap {
            _ if inside => Some((x, y)),
            Wrap::Repeat => Some((x.rem_euclid(w), y.rem_euclid(h))),
            Wrap::Black => None,
            Wrap::Clamp => Some((x.clamp(0, w - 1), y.clamp(0, h - 1))),
            Wrap::Octahedral => {
                // across a vertical edge the row is mirrored, across a horizontal edge the column
                let (mut x, mut y) = (x, y);
                if !(0..w).contains(&x) {
                    x = if x < 0 { -1 - x } else { 2 * w - 1 - x };
                    y = h - 1 - y;
                }
                if !(0..h).contains(&y) {
                    y = if y < 0 { -1 - y } else { 2 * h - 1 - y };
                    x = w - 1 - x;
                }
                Some((x.clamp(0, w - 1), y.clamp(0, h - 1)))
            }
        }
    }
}

/// The integer below, saturating far outside any image.
fn floor(v: f32) -> i64 {
    v.floor().clamp(-1e9, 1e9) as i64
}
