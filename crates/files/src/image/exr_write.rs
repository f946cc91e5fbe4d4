//! Writing OpenEXR: float32 scan lines, ZIP, channels and attributes sorted, the same bytes for the same image.

use super::{Pixels, Window, exr_attributes};
use crate::{FileError, Result, atomic::write_atomic};
use exr::{
    block::{BlockIndex, UncompressedBlock, writer::ChunksWriter},
    meta::{BlockDescription, Headers, MetaData, header::Header},
    prelude::{ChannelDescription, Compression, IntegerBounds, LineOrder, SampleType, SmallVec, Vec2},
};
use std::{
    io::{self, Seek, SeekFrom, Write},
    path::Path,
};

/// How the samples are packed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ExrCompression {
    /// Deflate in blocks of 16 lines, lossless.
    #[default]
    Zip,
    /// As they are: fastest to write, for intermediate results.
    None,
}

/// Choices for writing an EXR file; neither changes a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExrOptions {
    /// How the samples are packed.
    pub compression: ExrCompression,
    /// Compress on all processors; the bytes do not depend on it.
    pub parallel: bool,
}

impl Default for ExrOptions {
    fn default() -> Self {
        ExrOptions { compression: ExrCompression::Zip, parallel: true }
    }
}

/// Magic number and version with flags come before the first attribute.
const HEADER_START: u64 = 8;

/// Writes an image to `path`, whole or not at all.
///
/// # Errors
/// [`FileError::BadImage`] when the image has no channel or pixel, too large a window, or an attribute that
/// OpenEXR cannot hold; [`FileError::Io`] when writing fails.
pub fn write_exr(path: &Path, pixels: &Pixels, options: &ExrOptions) -> Result<()> {
    let header = header_of(pixels, options)?;
    write_atomic(path, |sink| encode(pixels, header, options, sink).map_err(io_error))
}

/// Writes an image to a stream, from its current position 0.
///
/// # Errors
/// Those of [`write_exr`]; [`FileError::Io`] names the path `<stream>`.
pub fn encode_exr(pixels: &Pixels, options: &ExrOptions, out: impl Write + Seek) -> Result<()> {
    let header = header_of(pixels, options)?;
    encode(pixels, header, options, out)
        .map_err(|e| FileError::io(Path::new("<stream>"), "write", io_error(e)))
}

fn io_error(error: exr::error::Error) -> io::Error {
    match error {
        exr::error::Error::Io(error) => error,
        other => io::Error::other(other.to_string()),
    }
}

fn encode(
    pixels: &Pixels,
    header: Header,
    options: &ExrOptions,
    mut out: impl Write + Seek,
) -> exr::error::UnitResult {
    let planes = sorted_planes(pixels);
    let sorted_attributes = exr_attributes::sorted_bytes(&header)?;
    let headers = Headers::from_iter([header]);
    exr::block::write(&mut out, headers, true, |meta, chunks| {
        let blocks = meta.collect_ordered_blocks(|index| block_of(&planes, pixels.width(), index));
        write_blocks(&meta, chunks.on_progress(|_| {}), blocks, options.parallel)
    })?;
    out.seek(SeekFrom::Start(HEADER_START))?;
    out.write_all(&sorted_attributes)?;
    Ok(out.flush()?)
}

fn write_blocks(
    meta: &MetaData,
    chunks: impl ChunksWriter,
    blocks: impl Iterator<Item = (usize, UncompressedBlock)>,
    parallel: bool,
) -> exr::error::UnitResult {
    if parallel {
        chunks.compress_all_blocks_parallel(meta, blocks)
    } else {
        chunks.compress_all_blocks_sequential(meta, blocks)
    }
}

/// The samples of a block of lines: line by line, in each line channel by channel, native endian.
fn block_of(planes: &[&[f32]], width: usize, index: BlockIndex) -> UncompressedBlock {
    let rows = index.pixel_position.y()..index.pixel_position.y() + index.pixel_size.height();
    let mut data = Vec::with_capacity(rows.len() * width * planes.len() * 4);
    for row in rows {
        for plane in planes {
            data.extend_from_slice(bytemuck::cast_slice(&plane[row * width..(row + 1) * width]));
        }
    }
    UncompressedBlock { index, data }
}

fn sorted_planes(pixels: &Pixels) -> Vec<&[f32]> {
    let mut channels: Vec<_> = pixels.channels().iter().collect();
    channels.sort_by(|a, b| a.name.as_bytes().cmp(b.name.as_bytes()));
    channels.into_iter().map(|c| c.data.as_slice()).collect()
}

fn header_of(pixels: &Pixels, options: &ExrOptions) -> Result<Header> {
    check_image(pixels)?;
    let mut names: Vec<_> = pixels.channels().iter().map(|c| c.name.as_str()).collect();
    names.sort_by(|a, b| a.as_bytes().cmp(b.as_bytes()));
    let channels: SmallVec<[ChannelDescription; 5]> = names
        .iter()
        .map(|name| ChannelDescription::new(exr_attributes::text(name), SampleType::F32, false))
        .collect();
    let window = pixels.window();
    let compression = match options.compression {
        ExrCompression::Zip => Compression::ZIP16,
        ExrCompression::None => Compression::Uncompressed,
    };
    let mut header = Header::new(exr_attributes::text(""), Vec2(window.width, window.height), channels)
        .with_encoding(compression, BlockDescription::ScanLines, LineOrder::Increasing)
        .with_shared_attributes(exr_attributes::shared(bounds(pixels.display())))
        .with_position(Vec2(window.x0, window.y0));
    header.own_attributes.layer_name = None;
    exr_attributes::store(pixels, &mut header)?;
    Ok(header)
}

fn bounds(window: Window) -> IntegerBounds {
    IntegerBounds { position: Vec2(window.x0, window.y0), size: Vec2(window.width, window.height) }
}

/// The reader and writer of the crate assert these; a user gets a message instead.
fn check_image(pixels: &Pixels) -> Result<()> {
    const LIMIT: i64 = 1 << 30;
    for window in [pixels.window(), pixels.display()] {
        let ends = [i64::from(window.x0) + window.width as i64, i64::from(window.y0) + window.height as i64];
        let starts = [i64::from(window.x0), i64::from(window.y0)];
        if window.area() == 0 || ends.iter().chain(&starts).any(|c| c.abs() >= LIMIT) {
            return Err(FileError::bad_image(
                "a window of at least one pixel within +-2^30",
                format!("{window:?}"),
                "check resolution and crop",
            ));
        }
    }
    if pixels.channels().is_empty() {
        return Err(FileError::bad_image("at least one channel", "none", "add the planes before writing"));
    }
    if let Some(long) = pixels.channels().iter().find(|c| c.name.len() > 255 || c.name.contains('\0')) {
        return Err(FileError::bad_image(
            "channel names of at most 255 bytes without NUL",
            format!("`{}`", long.name),
            "shorten the name",
        ));
    }
    Ok(())
}
