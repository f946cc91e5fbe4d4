//! Portable float maps: `PF` (RGB) or `Pf` (grey), size, scale, then f32 rows from the bottom up.
//!
//! The sign of the scale gives the byte order (negative: little-endian), its magnitude multiplies the samples
//! (P. Debevec's format; pbrt reads it so). A scale of 0 is refused.

use super::Pixels;
use crate::{FileError, Place, Result, atomic::write_atomic, limits::justify};
use std::{
    fs::File,
    io::{self, BufRead, BufReader, Read, Write},
    path::Path,
};

/// Reads a PFM file into channels `R`, `G`, `B` or `Y`.
///
/// # Errors
/// [`FileError::Io`], [`FileError::Malformed`] with what was expected, and [`FileError::Oversized`] when the
/// header announces more than the file holds.
pub fn read_pfm(path: &Path) -> Result<Pixels> {
    let file = File::open(path).map_err(|e| FileError::io(path, "open", e))?;
    let bytes = file.metadata().map_err(|e| FileError::io(path, "read the size", e))?.len();
    decode_pfm(BufReader::new(file), bytes, path)
}

/// Reads a PFM image of `file_bytes` bytes from a stream; `path` is for messages.
///
/// # Errors
/// Those of [`read_pfm`].
pub fn decode_pfm(mut stream: impl BufRead, file_bytes: u64, path: &Path) -> Result<Pixels> {
    let header = Header::read(&mut stream, path)?;
    let samples = header.width * header.height * header.channels;
    // the header takes at least nine bytes
    justify(path, "samples", samples as u128 * 4, file_bytes, 1)?;
    let mut bytes = Vec::new();
    (&mut stream)
        .take(samples as u64 * 4)
        .read_to_end(&mut bytes)
        .map_err(|e| FileError::io(path, "read", e))?;
    if bytes.len() != samples * 4 {
        return Err(FileError::malformed(
            path,
            Place::File,
            format!("{} bytes of samples", samples * 4),
            format!("{}", bytes.len()),
            "the file is truncated; copy or export it again",
        ));
    }
    header.planes(&bytes)
}

/// Writes the planes R, G, B, or Y alone, as a little-endian PFM, whole or not at all.
///
/// # Errors
/// [`FileError::BadImage`] without such planes, [`FileError::Io`] when writing fails.
pub fn write_pfm(path: &Path, pixels: &Pixels) -> Result<()> {
    let planes = planes_of(pixels)?;
    write_atomic(path, |sink| encode(pixels, &planes, sink))
}

/// Writes a PFM to a stream.
///
/// # Errors
/// Those of [`write_pfm`].
pub fn encode_pfm(pixels: &Pixels, out: impl Write) -> Result<()> {
    let planes = planes_of(pixels)?;
    encode(pixels, &planes, out).map_err(|e| FileError::io(Path::new("<stream>"), "write", e))
}

fn planes_of(pixels: &Pixels) -> Result<Vec<&[f32]>> {
    let grey = pixels.channel("R").is_none().then(|| pixels.channel("Y")).flatten();
    match (grey, pixels.rgb()) {
        (Some(y), _) => Ok(vec![y]),
        (None, Some(rgb)) => Ok(rgb.to_vec()),
        (None, None) => Err(FileError::bad_image(
            "channels R, G, B or Y",
            format!("{:?}", pixels.channels().iter().map(|c| &c.name).collect::<Vec<_>>()),
            "write other channels as EXR",
        )),
    }
}

fn encode(pixels: &Pixels, planes: &[&[f32]], mut out: impl Write) -> io::Result<()> {
    let (width, height) = (pixels.width(), pixels.height());
    let magic = if planes.len() == 1 { "Pf" } else { "PF" };
    write!(out, "{magic}\n{width} {height}\n-1.0\n")?;
    for row in (0..height).rev() {
        for i in row * width..(row + 1) * width {
            for plane in planes {
                out.write_all(&plane[i].to_le_bytes())?;
            }
        }
    }
    out.flush()
}

struct Header {
    width: usize,
    height: usize,
    channels: usize,
    scale: f32,
}

impl Header {
    fn read(stream: &mut impl BufRead, path: &Path) -> Result<Self> {
        let bad = |expected: &str, got: &str| {
            FileError::malformed(path, Place::File, expected, format!("`{got}`"), "is this a PFM file?")
        };
        let magic = word(stream, path)?;
        let channels = match magic.as_str() {
            "PF" => 3,
            "Pf" => 1,
            other => return Err(bad("`PF` (RGB) or `Pf` (grey)", other)),
        };
        let size = |stream: &mut _| {
            let text = word(stream, path)?;
            let in_range = |n: &usize| (1..=1 << 20).contains(n);
            text.parse().ok().filter(in_range).ok_or_else(|| bad("a size from 1 to 1048576", &text))
        };
        let (width, height) = (size(stream)?, size(stream)?);
        let text = word(stream, path)?;
        let usable = |s: &f32| s.is_finite() && *s != 0.0;
        let scale =
            text.parse().ok().filter(usable).ok_or_else(|| bad("a finite scale other than 0", &text))?;
        Ok(Header { width, height, channels, scale })
    }

    fn planes(&self, bytes: &[u8]) -> Result<Pixels> {
        let mut pixels = Pixels::new(self.width, self.height);
        let names: &[&str] = if self.channels == 1 { &["Y"] } else { &["R", "G", "B"] };
        for (c, name) in names.iter().enumerate() {
            let rows_from_top = (0..self.height).rev();
            let plane = rows_from_top
                .flat_map(|row| (0..self.width).map(move |x| (row, x)))
                .map(|(row, x)| self.sample(bytes, (row * self.width + x) * self.channels + c));
            pixels.push(*name, plane.collect())?;
        }
        Ok(pixels)
    }

    fn sample(&self, bytes: &[u8], index: usize) -> f32 {
        let raw = [0, 1, 2, 3].map(|b| bytes[index * 4 + b]);
        let value = if self.scale < 0.0 { f32::from_le_bytes(raw) } else { f32::from_be_bytes(raw) };
        value * self.scale.abs()
    }
}

/// The next word of the header; takes exactly one white-space byte behind it, as the format asks.
fn word(stream: &mut impl BufRead, path: &Path) -> Result<String> {
    const LONGEST: usize = 64;
    let mut text = Vec::new();
    for byte in stream.bytes() {
        let byte = byte.map_err(|e| FileError::io(path, "read", e))?;
        match (byte.is_ascii_whitespace(), text.is_empty()) {
            (true, true) => {}
            (true, false) => break,
            (false, _) if text.len() == LONGEST => break,
            (false, _) => text.push(byte),
        }
    }
    Ok(String::from_utf8_lossy(&text).escape_debug().to_string())
}
