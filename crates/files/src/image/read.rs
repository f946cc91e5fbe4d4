//! Reading an image of any known format.

use super::{Encoding, Pixels, decode_exr, decode_pfm, ldr::decode_ldr};
use crate::{FileError, Result};
use image::ImageFormat;
use std::{
    fs::File,
    io::{BufReader, Read, Seek},
    path::Path,
};

/// Reads an image: integer samples are taken as sRGB, float samples as linear.
///
/// # Errors
/// Those of [`read_encoded`].
pub fn read_image(path: &Path) -> Result<Pixels> {
    read_encoded(path, None)
}

/// Reads an image into linear planes; the format is known by the first bytes, for TGA by the name.
///
/// `encoding` is how integer samples (8 or 16 bits) encode linear values, sRGB if `None`. As in pbrt-v4, alpha
/// is always linear and `encoding` has no effect on formats of floats (EXR, PFM, HDR).
///
/// # Errors
/// [`FileError::Io`], [`FileError::Unsupported`] for an unknown format or feature, [`FileError::Malformed`] for
/// a damaged file, [`FileError::Oversized`] for one that announces more than it can hold.
pub fn read_encoded(path: &Path, encoding: Option<Encoding>) -> Result<Pixels> {
    let mut file = File::open(path).map_err(|e| FileError::io(path, "open", e))?;
    let meta = file.metadata().map_err(|e| FileError::io(path, "read the size", e))?;
    if meta.is_dir() {
        return Err(FileError::io(path, "read", std::io::ErrorKind::IsADirectory.into()));
    }
    let mut first = Vec::new();
    Read::by_ref(&mut file).take(16).read_to_end(&mut first).map_err(|e| FileError::io(path, "read", e))?;
    file.rewind().map_err(|e| FileError::io(path, "read", e))?;
    let stream = BufReader::new(file);
    match format_of(&first, path)? {
        Format::Exr => decode_exr(stream, meta.len(), path),
        Format::Pfm => decode_pfm(stream, meta.len(), path),
        Format::Other(format) => {
            decode_ldr(stream, format, meta.len(), path, encoding.unwrap_or(Encoding::Srgb))
        }
    }
}

enum Format {
    Exr,
    Pfm,
    Other(ImageFormat),
}

fn format_of(first: &[u8], path: &Path) -> Result<Format> {
    const EXR_MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];
    if first.starts_with(&EXR_MAGIC) {
        return Ok(Format::Exr);
    }
    if first.starts_with(b"PF") || first.starts_with(b"Pf") {
        return Ok(Format::Pfm);
    }
    let known = [ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::Hdr, ImageFormat::Bmp, ImageFormat::Qoi];
    match image::guess_format(first) {
        Ok(format) if known.contains(&format) => Ok(Format::Other(format)),
        _ if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("tga")) => {
            Ok(Format::Other(ImageFormat::Tga))
        }
        _ => Err(FileError::unsupported(
            path,
            "an image format that starts like this",
            "use OpenEXR, PFM, PNG, JPEG, Radiance HDR, BMP, QOI or TGA (named .tga)",
        )),
    }
}
