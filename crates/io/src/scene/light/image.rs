//! Images whose colours are emission: on area lights and in projectors.

use crate::scene::{
    color_space,
    context::{Context, at},
    emission::Units,
};
use std::sync::Arc;
use tyndall_files::image::read_image;
use tyndall_pbrt::{Error, ParamSet};
use tyndall_spectral::{ColourSpace, Emission, SpaceName, cie, upsample};
use tyndall_transport::texture::{ImageMap, Lookup, Mapping, RgbKind, RgbRule, Texels, Wrap};

/// The image of `filename` with the light's `scale` and pbrt's normalisation.
pub(super) struct EmissionImage {
    texels: Arc<Texels>,
    space: SpaceName,
    scale: f64,
    /// Mean emission over the image.
    pub mean: Emission,
    /// Its mean luminance in pbrt's units, `scale` included.
    pub luminance: f64,
}

impl EmissionImage {
    /// As a map over texture coordinates, `factor` times as bright.
    pub fn scaled(&self, factor: f64) -> ImageMap {
        ImageMap {
            texels: self.texels.clone(),
            mapping: Mapping::default(),
            wrap: Wrap::Clamp,
            lookup: Lookup::Bilinear,
            scale: (self.scale * factor) as f32,
            invert: false,
            rule: RgbRule { space: self.space, kind: RgbKind::Illuminant },
        }
    }

    /// The texels.
    pub fn texels(&self) -> &Texels {
        &self.texels
    }

    /// Luminance of a texel, relative to the image's scale.
    pub fn luminance_of(&self, x: usize, y: usize) -> f64 {
        let row = ColourSpace::get(self.space).xyz_from_rgb.0[1];
        let first = (y * self.texels.width + x) * 3;
        (0..3).map(|c| row[c] * f64::from(self.texels.data[first + c].max(0.0))).sum()
    }
}

/// Reads the image of a light.
pub(super) fn emission_image(
    ctx: &Context<'_>,
    p: &ParamSet,
    space: &str,
    units: &mut Units,
) -> Result<EmissionImage, Error> {
    let text = p.string_opt("filename")?.ok_or_else(|| p.missing("string", "filename"))?;
    let path = ctx.file(p, "filename", text)?;
    let pixels = read_image(&path).map_err(|e| at(p, e))?;
    let texels = coloured(crate::scene::image::texels(&pixels).map_err(|e| at(p, e))?);
    let white = &color_space::find(space).illuminant;
    let mut scale = p.float64("scale", 1.0)?;
    if p.bool("absolute", false)? {
        units.absolute = true;
    } else {
        units.normalised = true;
        scale /= cie::y_integral(white);
    }
    let space = color_space::name(space);
    let count = (texels.width * texels.height) as f64;
    let sum = texels
        .data
        .as_chunks::<3>()
        .0
        .iter()
        .fold([0.0f64; 3], |s, c| [0, 1, 2].map(|k| s[k] + f64::from(c[k].max(0.0))));
    if sum == [0.0; 3] {
        return Err(p.error("the image of the light is black"));
    }
    let rgb = sum.map(|v| (v / count) as f32);
    let row = ColourSpace::get(space).xyz_from_rgb.0[1];
    let luminance = (0..3).map(|c| row[c] * f64::from(rgb[c])).sum::<f64>() * p.float64("scale", 1.0)?;
    let mean = upsample::illuminant(space, rgb).map_err(|e| at(p, e))?.scaled(scale as f32);
    Ok(EmissionImage { texels: Arc::new(texels), space, scale, mean: mean.into(), luminance })
}

/// Grey images as colours: emission is white times a number, where a grey texture is the number alone.
fn coloured(texels: Texels) -> Texels {
    if texels.channels == 3 {
        return texels;
    }
    let data = texels.data.iter().flat_map(|v| [*v; 3]).collect();
    Texels { channels: 3, data, ..texels }
}

/// pbrt's `power` for an image: the target over what the light gives by its own values.
pub(super) fn factor(p: &ParamSet, name: &str, given: f64) -> Result<f64, Error> {
    let Some(target) = p.float64_opt(name)?.filter(|v| *v > 0.0) else { return Ok(1.0) };
    if p.bool("absolute", false)? {
        return Err(p.error_at(name, "must not be given with \"bool absolute\" true", &target.to_string()));
    }
    Ok(target / given)
}
