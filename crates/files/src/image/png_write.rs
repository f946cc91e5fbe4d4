//! PNG: sRGB with 8 or 16 bits from linear sRGB, exposure in stops; what could not be shown is counted.

use super::{Encoding, MetaValue, Pixels, png_text::with_texts};
use crate::{FileError, Result, atomic::write_atomic};
use image::{ExtendedColorType, ImageEncoder, codecs::png::PngEncoder};
use std::{
    io::{self, Write},
    path::Path,
};
use tyndall_base::{
    hash::{hash3, to_unit_f32},
    math::f64::pow,
};

/// Bits a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BitDepth {
    /// 8 bits.
    #[default]
    Eight,
    /// 16 bits.
    Sixteen,
}

/// How linear values become a PNG.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PngOptions {
    /// Values are multiplied by `2^exposure` first.
    pub exposure: f32,
    /// Bits a sample.
    pub depth: BitDepth,
    /// Rounds at random, by a hash of the place, instead of to the nearest: slow changes without noise of their own get no steps.
    pub dither: bool,
}

/// What a PNG could not show, in pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PngReport {
    /// Pixels in the image.
    pub pixels: usize,
    /// With a component under 0: outside of the sRGB gamut, clamped.
    pub below: usize,
    /// With a component over 1: brighter than white, clamped.
    pub above: usize,
    /// With a component that is infinite or not a number: shown in magenta.
    pub non_finite: usize,
}

/// Writes the planes R, G, B (linear, with the primaries and white of sRGB) of an image as a PNG, whole or not
/// at all; of a crop only the data window. Attributes that are texts go along.
///
/// # Errors
/// [`FileError::BadImage`] without R, G, B (or Y) or with a size that PNG cannot hold, [`FileError::Io`] when
/// writing fails.
pub fn write_png(path: &Path, pixels: &Pixels, options: &PngOptions) -> Result<PngReport> {
    let (samples, report) = quantise(pixels, options)?;
    write_atomic(path, |sink| encode(pixels, &samples, options.depth, sink))?;
    Ok(report)
}

/// Writes a PNG as [`write_png`] does, to a stream.
///
/// # Errors
/// Those of [`write_png`].
pub fn encode_png(pixels: &Pixels, options: &PngOptions, out: impl Write) -> Result<PngReport> {
    let (samples, report) = quantise(pixels, options)?;
    encode(pixels, &samples, options.depth, out)
        .map_err(|e| FileError::io(Path::new("<stream>"), "write", e))?;
    Ok(report)
}

/// Painted where a component is infinite or not a number: no surface looks like it.
const NON_FINITE_COLOUR: [f64; 3] = [1.0, 0.0, 1.0];

fn quantise(pixels: &Pixels, options: &PngOptions) -> Result<(Vec<u8>, PngReport)> {
    let [r, g, b] = pixels.rgb().ok_or_else(|| {
        FileError::bad_image(
            "channels R, G, B or Y",
            "an image without them",
            "develop the image to RGB first",
        )
    })?;
    if pixels.window().area() == 0 || pixels.width().max(pixels.height()) > i32::MAX as usize {
        return Err(FileError::bad_image(
            "a size from 1 to 2^31 - 1",
            format!("{} x {}", pixels.width(), pixels.height()),
            "check the resolution",
        ));
    }
    let gain = pow(2.0, f64::from(options.exposure));
    let mut report = PngReport { pixels: r.len(), ..PngReport::default() };
    let mut samples = Vec::with_capacity(r.len() * 3 * bytes_per_sample(options.depth));
    for (place, ((r, g), b)) in r.iter().zip(g).zip(b).enumerate() {
        for (c, v) in shown([*r, *g, *b].map(|v| f64::from(v) * gain), &mut report).into_iter().enumerate() {
            let threshold = if options.dither { threshold(place, c) } else { 0.5 };
            push_sample(Encoding::Srgb.encode(v), options.depth, threshold, &mut samples);
        }
    }
    Ok((samples, report))
}

/// The colour that a pixel can show, and the count of why it is not its own.
fn shown(rgb: [f64; 3], report: &mut PngReport) -> [f64; 3] {
    if !rgb.iter().all(|v| v.is_finite()) {
        report.non_finite += 1;
        return NON_FINITE_COLOUR;
    }
    report.below += usize::from(rgb.iter().any(|v| *v < 0.0));
    report.above += usize::from(rgb.iter().any(|v| *v > 1.0));
    rgb.map(|v| v.clamp(0.0, 1.0))
}

const fn bytes_per_sample(depth: BitDepth) -> usize {
    match depth {
        BitDepth::Eight => 1,
        BitDepth::Sixteen => 2,
    }
}

/// Where a component is rounded up, in [0, 1): 0 and 1 stay what they are.
fn threshold(place: usize, component: usize) -> f64 {
    f64::from(to_unit_f32(hash3(place as u32, (place >> 32) as u32, component as u32)))
}

fn push_sample(value: f64, depth: BitDepth, threshold: f64, samples: &mut Vec<u8>) {
    match depth {
        BitDepth::Eight => samples.push((value * 255.0 + threshold).floor() as u8),
        BitDepth::Sixteen => {
            // the encoder takes native-endian words
            samples.extend_from_slice(&((value * 65535.0 + threshold).floor() as u16).to_ne_bytes());
        }
    }
}

fn encode(pixels: &Pixels, samples: &[u8], depth: BitDepth, mut out: impl Write) -> io::Result<()> {
    let colour = match depth {
        BitDepth::Eight => ExtendedColorType::Rgb8,
        BitDepth::Sixteen => ExtendedColorType::Rgb16,
    };
    let mut png = Vec::new();
    PngEncoder::new(&mut png)
        .write_image(samples, pixels.width() as u32, pixels.height() as u32, colour)
        .map_err(|e| match e {
            image::ImageError::IoError(e) => e,
            other => io::Error::other(other.to_string()),
        })?;
    let texts: Vec<(&str, &str)> =
        pixels.meta.iter().filter_map(|(k, v)| Some((k.as_str(), text(v)?))).collect();
    out.write_all(&with_texts(&png, &texts))?;
    out.flush()
}

fn text(value: &MetaValue) -> Option<&str> {
    if let MetaValue::Text(text) = value { Some(text) } else { None }
}
