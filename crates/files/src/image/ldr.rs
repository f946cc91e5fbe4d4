//! PNG, JPEG, TGA, BMP, QOI and Radiance HDR through the crate `image`, into linear float planes.

use super::{Encoding, Pixels, guard::guarded};
use crate::{
    FileError, Place, Result,
    limits::{DEFLATE_RATIO, justify},
};
use image::{DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader, Limits};
use std::{
    io::{BufRead, Seek},
    path::Path,
};

/// Reads an image of `file_bytes` bytes; integer colour samples go through `encoding`, alpha and float samples
/// are linear as they stand.
pub(super) fn decode_ldr<R: BufRead + Seek>(
    stream: R,
    format: ImageFormat,
    file_bytes: u64,
    path: &Path,
    encoding: Encoding,
) -> Result<Pixels> {
    guarded(path, "an image", || {
        let image = decode(stream, format, file_bytes, path).map_err(|e| match e {
            Failure::Ours(error) => error,
            Failure::Theirs(error) => image_error(path, error),
        })?;
        planes(&image, encoding)
    })
}

enum Failure {
    Ours(FileError),
    Theirs(ImageError),
}

impl From<ImageError> for Failure {
    fn from(error: ImageError) -> Self {
        Failure::Theirs(error)
    }
}

impl From<FileError> for Failure {
    fn from(error: FileError) -> Self {
        Failure::Ours(error)
    }
}

fn decode<R: BufRead + Seek>(
    stream: R,
    format: ImageFormat,
    file_bytes: u64,
    path: &Path,
) -> std::result::Result<DynamicImage, Failure> {
    let ratio = best_ratio(format);
    let mut reader = ImageReader::with_format(stream, format);
    let mut limits = Limits::default();
    limits.max_alloc = Some(file_bytes.saturating_mul(ratio).max(1 << 24));
    reader.limits(limits);
    let decoder = reader.into_decoder()?;
    justify(path, "samples", u128::from(decoder.total_bytes()), file_bytes, ratio)?;
    Ok(DynamicImage::from_decoder(decoder)?)
}

/// The largest expansion of each format, generously.
fn best_ratio(format: ImageFormat) -> u64 {
    match format {
        ImageFormat::Qoi => 62 * 4,   // a run byte stands for 62 pixels
        ImageFormat::Tga => 128,      // 128 pixels of four bytes in five
        ImageFormat::Bmp => 512,      // a run of 255 pixels in two bytes
        ImageFormat::Hdr => 127 * 12, // a run of 127 bytes in two, four become three floats
        // a block of 64 coefficients can take two bits, and progressive scans can skip runs of blocks
        ImageFormat::Jpeg => 4096,
        _ => DEFLATE_RATIO * 8, // palettes and bits expand to bytes
    }
}

fn image_error(path: &Path, error: ImageError) -> FileError {
    match error {
        ImageError::IoError(e) if e.kind() != std::io::ErrorKind::UnexpectedEof => {
            FileError::io(path, "read", e)
        }
        ImageError::Unsupported(e) => {
            FileError::unsupported(path, e.to_string(), "convert it to PNG, OpenEXR or PFM")
        }
        ImageError::Limits(_) => FileError::malformed(
            path,
            Place::File,
            "an image whose size the file can hold",
            "one that is far larger",
            "the header is corrupt; copy or export the file again",
        ),
        other => FileError::malformed(
            path,
            Place::File,
            "an image of the format that its name or first bytes promise",
            other.to_string(),
            "the file is truncated or damaged; copy or export it again",
        ),
    }
}

fn planes(image: &DynamicImage, encoding: Encoding) -> Result<Pixels> {
    let size = (image.width() as usize, image.height() as usize);
    let byte = |b: u8| f64::from(b) / 255.0;
    let word = |w: u16| f64::from(w) / 65535.0;
    let bytes: Vec<f32> = (0..=255).map(|b| encoding.decode(byte(b)) as f32).collect();
    let (of_u8, alpha_u8) = (|b: u8| bytes[usize::from(b)], |b: u8| byte(b) as f32);
    let (of_u16, alpha_u16) = (|w: u16| encoding.decode(word(w)) as f32, |w: u16| word(w) as f32);
    let same = |v: f32| v;
    match image {
        DynamicImage::ImageLuma8(i) => split(size, i.as_raw(), &["Y"], of_u8, alpha_u8),
        DynamicImage::ImageLumaA8(i) => split(size, i.as_raw(), &["Y", "A"], of_u8, alpha_u8),
        DynamicImage::ImageRgb8(i) => split(size, i.as_raw(), &["R", "G", "B"], of_u8, alpha_u8),
        DynamicImage::ImageRgba8(i) => split(size, i.as_raw(), &["R", "G", "B", "A"], of_u8, alpha_u8),
        DynamicImage::ImageLuma16(i) => split(size, i.as_raw(), &["Y"], of_u16, alpha_u16),
        DynamicImage::ImageLumaA16(i) => split(size, i.as_raw(), &["Y", "A"], of_u16, alpha_u16),
        DynamicImage::ImageRgb16(i) => split(size, i.as_raw(), &["R", "G", "B"], of_u16, alpha_u16),
        DynamicImage::ImageRgba16(i) => split(size, i.as_raw(), &["R", "G", "B", "A"], of_u16, alpha_u16),
        DynamicImage::ImageRgb32F(i) => split(size, i.as_raw(), &["R", "G", "B"], same, same),
        other => split(size, other.to_rgba32f().as_raw(), &["R", "G", "B", "A"], same, same),
    }
}

/// Interleaved samples to planes.
fn split<T: Copy>(
    (width, height): (usize, usize),
    samples: &[T],
    names: &[&str],
    colour: impl Fn(T) -> f32,
    alpha: impl Fn(T) -> f32,
) -> Result<Pixels> {
    let mut pixels = Pixels::new(width, height);
    for (c, name) in names.iter().enumerate() {
        let of_channel = samples.iter().skip(c).step_by(names.len()).copied();
        let plane =
            if *name == "A" { of_channel.map(&alpha).collect() } else { of_channel.map(&colour).collect() };
        pixels.push(*name, plane)?;
    }
    Ok(pixels)
}
