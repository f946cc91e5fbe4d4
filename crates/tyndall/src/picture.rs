//! An image as a picture for the eye: exposure, white point, colour space, one band, false colour, denoised.

mod source;

use crate::{Error, Image, false_colour, image::attribute};
use source::Source;
use tyndall_base::math::f64 as math;
use tyndall_files::image::{MetaValue, Pixels, PngOptions};
use tyndall_spectral::{
    ColourSpace, SpaceName,
    cie::LUMENS_PER_WATT,
    colour::{Matrix3, chromaticity, white_balance},
};

/// What a picture says of itself that was denoised.
pub const DENOISED: &str =
    "non-local means by the standard errors: for looking at, the numbers have no errors any more";

/// What a picture shows.
#[derive(Clone, Debug, Default)]
pub struct Look {
    /// Stops; `None` is the rule of [`auto_exposure`].
    pub exposure: Option<f64>,
    /// Chromaticity that shall look white.
    pub white: Option<[f64; 2]>,
    /// Show the band that holds this wavelength \[nm\].
    pub band: Option<f64>,
    /// Show luminance \[cd/m^2\] over this interval in false colour.
    pub false_colour: Option<[f64; 2]>,
    /// Denoise by the image's standard errors, on so many threads.
    pub denoise: Option<usize>,
}

/// Share of the pixels that an automatic exposure keeps below white.
const UNCLIPPED: f64 = 0.99;

/// A picture with what was done to it.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Linear R, G, B.
    pub pixels: Pixels,
    /// Stops that were chosen.
    pub exposure: f64,
    /// True when the exposure was chosen by [`auto_exposure`].
    pub automatic: bool,
    /// True when noise was taken out.
    pub denoised: bool,
}

impl Picture {
    /// Options for a PNG file.
    pub fn png(&self) -> PngOptions {
        // grain that is left hides the steps of 8 bits
        PngOptions { exposure: self.exposure as f32, dither: self.denoised, ..PngOptions::default() }
    }
}

/// Makes a picture in the colour space `space`.
///
/// # Errors
/// When the image lacks what the look asks for.
pub fn picture(image: &Image, look: &Look, space: SpaceName) -> Result<Picture, Error> {
    let source = Source::of(image, look)?;
    let mut picture = match look.false_colour {
        Some(range) => false_picture(image, &source, range)?,
        None => plain_picture(image, source, look, space)?,
    };
    picture.denoised = look.denoise.is_some();
    if picture.denoised {
        picture.pixels.set(attribute::DENOISED, DENOISED);
    }
    Ok(picture)
}

fn plain_picture(image: &Image, source: Source, look: &Look, space: SpaceName) -> Result<Picture, Error> {
    let automatic = look.exposure.is_none();
    let exposure = look.exposure.unwrap_or_else(|| automatic_stops(image, &source));
    let shown = match source {
        Source::Band(plane) => [plane.clone(), plane.clone(), plane],
        Source::Colour(rgb) => colour(image, rgb, look.white, space),
    };
    let mut pixels = blank(image, shown)?;
    let note = if automatic { "chosen" } else { "given" };
    pixels.set("tyndall:exposure", format!("{exposure} stops, {note}"));
    Ok(Picture { pixels, exposure, automatic, denoised: false })
}

/// 0 stops for images normalised by pbrt's rule, whose white is 1. Radiance in W m^-2 sr^-1 has no white: there the
/// exposure takes the 99th percentile of luminance to 1, rounded down to quarters of a stop.
fn automatic_stops(image: &Image, source: &Source) -> f64 {
    match source {
        Source::Colour(_) if !image.is_absolute() => 0.0,
        _ => auto_exposure(&source.luminance(image)),
    }
}

/// Stops that take the 99th percentile of the positive values to 1, rounded down to quarters; 0 for black images.
pub fn auto_exposure(y: &[f32]) -> f64 {
    let mut lit: Vec<f32> = y.iter().copied().filter(|v| v.is_finite() && *v > 0.0).collect();
    if lit.is_empty() {
        return 0.0;
    }
    let rank = ((UNCLIPPED * lit.len() as f64).ceil() as usize).clamp(1, lit.len()) - 1;
    let high = f64::from(*lit.select_nth_unstable_by(rank, f32::total_cmp).1);
    let stops = -math::ln(high) / std::f64::consts::LN_2;
    (4.0 * stops).floor() / 4.0
}

/// R, G, B in another space, balanced if asked.
fn colour(image: &Image, rgb: [Vec<f32>; 3], white: Option<[f64; 2]>, space: SpaceName) -> [Vec<f32>; 3] {
    let (from, to) = (ColourSpace::get(image.space()), ColourSpace::get(space));
    if from.name == to.name && white.is_none() {
        return rgb;
    }
    let source_white = white.unwrap_or_else(|| chromaticity(from.white));
    let balance = white_balance(source_white, chromaticity(to.white));
    // a change of space alone keeps colours, but for a white of another chromaticity
    let balance = if white.is_none() && from.white == to.white { Matrix3::IDENTITY } else { balance };
    let matrix = to.rgb_from_xyz.times(&balance).times(&from.xyz_from_rgb);
    converted(&rgb, &matrix)
}

fn converted([r, g, b]: &[Vec<f32>; 3], matrix: &Matrix3) -> [Vec<f32>; 3] {
    let mut out = [(); 3].map(|()| Vec::with_capacity(r.len()));
    for i in 0..r.len() {
        let v = matrix.apply([r[i], g[i], b[i]].map(f64::from));
        out.iter_mut().zip(v).for_each(|(plane, v)| plane.push(v as f32));
    }
    out
}

fn false_picture(image: &Image, source: &Source, [low, high]: [f64; 2]) -> Result<Picture, Error> {
    if !image.is_absolute() {
        return Err(Error::options(
            "--false-colour: the image has no absolute unit, so it has no luminance in cd/m2",
            Some("\"bool absolute\" true on the scene's lights gives one".into()),
        ));
    }
    let y = source.luminance(image);
    let mut planes = [(); 3].map(|()| Vec::with_capacity(y.len()));
    for v in &y {
        let rgb = false_colour::of(f64::from(LUMENS_PER_WATT) * f64::from(*v), low, high);
        planes.iter_mut().zip(rgb).for_each(|(plane, v)| plane.push(v as f32));
    }
    let mut pixels = blank(image, planes)?;
    pixels.set("tyndall:falseColour", format!("{low} to {high} cd/m2, logarithmic"));
    Ok(Picture { pixels, exposure: 0.0, automatic: false, denoised: false })
}

/// The planes in the image's frame, with what tells of its origin.
fn blank(image: &Image, [r, g, b]: [Vec<f32>; 3]) -> Result<Pixels, Error> {
    let mut pixels = Pixels::cropped(image.values.window(), image.values.display());
    for (name, plane) in [("R", r), ("G", g), ("B", b)] {
        pixels.push(name, plane)?;
    }
    for name in [attribute::JOB, attribute::SCENE, attribute::SEED, attribute::UNITS, "software"] {
        if let Some(MetaValue::Text(text)) = image.values.meta.get(name) {
            pixels.set(name, text.as_str());
        }
    }
    Ok(pixels)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exposure_takes_the_bright_to_white() {
        let y: Vec<f32> = (1..=1000).map(|i| i as f32).collect();
        let stops = auto_exposure(&y);
        let white = 990.0 * 2f64.powf(stops);
        assert!(white <= 1.0 && white > 0.8, "{stops}: {white}");
        assert_eq!(auto_exposure(&[0.0, f32::NAN, -1.0]), 0.0);
    }
}
