//! Reading OpenEXR: any flat file with f16, f32 or u32 channels, scan lines or tiles, every compression of
//! the crate `exr`; of several parts or resolution levels the first and largest.

use super::{Pixels, Window, exr_attributes, exr_chunk::check_chunk, guard::guarded};
use crate::{
    FileError, Place, Result,
    limits::{DEFLATE_RATIO, justify},
};
use exr::{
    block::{BlockIndex, UncompressedBlock, reader::ChunksReader, reader::Reader},
    meta::{BlockDescription, header::Header},
    prelude::{Compression, SampleType, Vec2},
};
use half::f16;
use std::{
    collections::HashSet,
    fs::File,
    io::{BufReader, Read, Seek},
    path::Path,
};

/// What the header of an EXR file says.
#[derive(Clone, Debug, PartialEq)]
pub struct ExrInfo {
    /// Windows and attributes, without channels.
    pub frame: Pixels,
    /// Names of the channels.
    pub channels: Vec<String>,
}

impl ExrInfo {
    /// Bytes that [`read_exr`] will need for the samples.
    pub fn sample_bytes(&self) -> u128 {
        self.frame.window().area() as u128 * self.channels.len() as u128 * 4
    }
}

/// Reads an EXR file; samples become f32, channels and attributes keep their names.
///
/// # Errors
/// [`FileError::Io`] when the file cannot be read, [`FileError::Malformed`] when it is damaged,
/// [`FileError::Unsupported`] for deep data, subsampled channels and newer features, and
/// [`FileError::Oversized`] when it announces more than its size can hold.
pub fn read_exr(path: &Path) -> Result<Pixels> {
    let (file, bytes) = open(path)?;
    decode_exr(file, bytes, path)
}

/// Reads only the header of an EXR file.
///
/// # Errors
/// Those of [`read_exr`].
pub fn probe_exr(path: &Path) -> Result<ExrInfo> {
    let (file, bytes) = open(path)?;
    guarded(path, "an OpenEXR image", || {
        let reader = read_header(file, bytes, path)?;
        let header = &reader.headers()[0];
        let channels = header.channels.list.iter().map(|c| exr_attributes::string(&c.name)).collect();
        Ok(ExrInfo { frame: frame_of(header), channels })
    })
}

/// Reads an EXR image of `file_bytes` bytes from a stream at its start; `path` is for messages.
///
/// # Errors
/// Those of [`read_exr`].
pub fn decode_exr(stream: impl Read + Seek, file_bytes: u64, path: &Path) -> Result<Pixels> {
    guarded(path, "an OpenEXR image", || decode(stream, file_bytes, path))
}

fn open(path: &Path) -> Result<(BufReader<File>, u64)> {
    let file = File::open(path).map_err(|e| FileError::io(path, "open", e))?;
    let bytes = file.metadata().map_err(|e| FileError::io(path, "read the size", e))?.len();
    Ok((BufReader::new(file), bytes))
}

fn exr_error(path: &Path, error: exr::error::Error) -> FileError {
    use exr::error::Error;
    match error {
        Error::Io(source) => FileError::io(path, "read", source),
        Error::NotSupported(feature) => FileError::unsupported(
            path,
            feature,
            "convert it to flat scan lines without subsampling, for example with OpenEXR's exrstdattr or oiiotool",
        ),
        Error::Invalid(what) => FileError::malformed(
            path,
            Place::File,
            "an OpenEXR image",
            format!("invalid data: {what}"),
            "the file is truncated or damaged; copy or export it again",
        ),
        Error::Aborted => unreachable!("no callback of ours aborts"),
    }
}

fn decode<R: Read + Seek>(stream: R, file_bytes: u64, path: &Path) -> Result<Pixels> {
    let reader = read_header(stream, file_bytes, path)?;
    let first_and_largest = |block: BlockIndex| block.layer == 0 && block.level == Vec2(0, 0);
    let chunks = reader
        .filter_chunks(false, |_, _, block| first_and_largest(block))
        .map_err(|e| exr_error(path, e))?;
    let header = chunks.headers()[0].clone();
    let meta = chunks.meta_data().clone();
    let mut planes = Planes::new(&header, path)?;
    for chunk in chunks {
        let chunk = chunk.map_err(|e| exr_error(path, e))?;
        check_chunk(&header, &chunk, path)?;
        let block =
            UncompressedBlock::decompress_chunk(chunk, &meta, false).map_err(|e| exr_error(path, e))?;
        if first_and_largest(block.index) {
            planes.insert(&block)?;
        }
    }
    planes.finish(&header)
}

fn read_header<R: Read + Seek>(stream: R, file_bytes: u64, path: &Path) -> Result<Reader<R>> {
    let reader = exr::block::read(stream, false).map_err(|e| exr_error(path, e))?;
    for header in reader.headers() {
        check_size(header, file_bytes, path)?;
    }
    Ok(reader)
}

/// Refuses what the file's size cannot justify: the offset table with a header for each chunk, and samples at
/// the best ratio of the compression.
fn check_size(header: &Header, file_bytes: u64, path: &Path) -> Result<()> {
    const CHUNK_BYTES: u128 = 16; // offset, line number, size
    const MOST_CHANNELS: usize = 1 << 14;
    let channels = header.channels.list.len();
    if channels > MOST_CHANNELS {
        return Err(FileError::unsupported(
            path,
            format!("an image of {channels} channels"),
            "store at most 16384 channels in a file",
        ));
    }
    justify(path, "chunks", header.chunk_count as u128 * CHUNK_BYTES, file_bytes, 1)?;
    if let BlockDescription::Tiles(tiles) = header.blocks
        && tiles.tile_size.0.max(tiles.tile_size.1) > 1 << 16
    {
        return Err(FileError::unsupported(
            path,
            format!("a tile size of {} x {}", tiles.tile_size.0, tiles.tile_size.1),
            "store the image in tiles of at most 65536 pixels a side, or in scan lines",
        ));
    }
    let pixels = header.layer_size.0 as u128 * header.layer_size.1 as u128;
    let samples = pixels * header.channels.bytes_per_pixel as u128;
    justify(path, "samples", samples, file_bytes, best_ratio(header.compression))
}

/// The largest expansion of each compression.
fn best_ratio(compression: Compression) -> u64 {
    match compression {
        Compression::Uncompressed => 1,
        Compression::RLE => 64,                     // 128 equal bytes in two
        Compression::B44 | Compression::B44A => 11, // 32 bytes in 3
        // three deflated bytes stand for one float
        Compression::PXR24 => DEFLATE_RATIO * 4 / 3 + 1,
        // an 8x8 block of zeros is one deflated run code, the DC terms deflate by themselves
        Compression::DWAA(_) | Compression::DWAB(_) => DEFLATE_RATIO * 64,
        // PIZ: 255 half floats in a run of nine bits or more
        _ => DEFLATE_RATIO,
    }
}

fn frame_of(header: &Header) -> Pixels {
    let display = header.shared_attributes.display_window;
    let position = header.own_attributes.layer_position;
    let Vec2(width, height) = header.layer_size;
    let mut frame = Pixels::cropped(
        Window { x0: position.0, y0: position.1, width, height },
        Window {
            x0: display.position.0,
            y0: display.position.1,
            width: display.size.0,
            height: display.size.1,
        },
    );
    exr_attributes::load(header, &mut frame);
    frame
}

/// The planes of an image while its blocks arrive.
struct Planes<'a> {
    path: &'a Path,
    width: usize,
    height: usize,
    types: Vec<SampleType>,
    planes: Vec<Vec<f32>>,
    seen: HashSet<(usize, usize)>,
    covered: usize,
}

impl<'a> Planes<'a> {
    fn new(header: &Header, path: &'a Path) -> Result<Self> {
        let Vec2(width, height) = header.layer_size;
        let types: Vec<_> = header.channels.list.iter().map(|c| c.sample_type).collect();
        let planes = types.iter().map(|_| zeros(width * height, path)).collect::<Result<_>>()?;
        Ok(Planes { path, width, height, types, planes, seen: HashSet::new(), covered: 0 })
    }

    fn insert(&mut self, block: &UncompressedBlock) -> Result<()> {
        let Vec2(x, y) = block.index.pixel_position;
        let Vec2(columns, rows) = block.index.pixel_size;
        let line_bytes: usize = self.types.iter().map(|t| t.bytes_per_sample() * columns).sum();
        if x + columns > self.width || y + rows > self.height || block.data.len() != line_bytes * rows {
            return Err(self.damaged("a block that does not fit into the data window"));
        }
        if !self.seen.insert((x, y)) {
            return Err(self.damaged("the same block twice"));
        }
        self.covered += columns * rows;
        let mut bytes = block.data.as_slice();
        for row in y..y + rows {
            for (plane, kind) in self.planes.iter_mut().zip(&self.types) {
                let (line, rest) = bytes.split_at(columns * kind.bytes_per_sample());
                let start = row * self.width + x;
                convert_line(line, *kind, &mut plane[start..start + columns]);
                bytes = rest;
            }
        }
        Ok(())
    }

    fn finish(self, header: &Header) -> Result<Pixels> {
        if self.covered != self.width * self.height {
            let missing = self.width * self.height - self.covered;
            return Err(self.damaged(&format!("{missing} pixels without data")));
        }
        let mut pixels = frame_of(header);
        for (channel, plane) in header.channels.list.iter().zip(self.planes) {
            let name = exr_attributes::string(&channel.name);
            pixels.push(name, plane).map_err(|e| {
                FileError::malformed(
                    self.path,
                    Place::File,
                    "channels with different names",
                    e.to_string(),
                    "the file is damaged",
                )
            })?;
        }
        Ok(pixels)
    }

    fn damaged(&self, got: &str) -> FileError {
        FileError::malformed(
            self.path,
            Place::File,
            "every pixel of the data window exactly once",
            got,
            "the file is truncated or damaged; copy or export it again",
        )
    }
}

/// A plane of zeros, or an error where the memory is not to be had.
fn zeros(length: usize, path: &Path) -> Result<Vec<f32>> {
    let mut plane = Vec::new();
    plane
        .try_reserve_exact(length)
        .map_err(|_| FileError::io(path, "hold the image", std::io::ErrorKind::OutOfMemory.into()))?;
    plane.resize(length, 0.0);
    Ok(plane)
}

/// Native-endian samples of a line to f32; u32 beyond 2^24 rounds.
fn convert_line(bytes: &[u8], kind: SampleType, out: &mut [f32]) {
    match kind {
        SampleType::F32 => convert::<4>(bytes, out, f32::from_ne_bytes),
        SampleType::F16 => convert::<2>(bytes, out, |b| f16::from_ne_bytes(b).to_f32()),
        SampleType::U32 => convert::<4>(bytes, out, |b| u32::from_ne_bytes(b) as f32),
    }
}

fn convert<const B: usize>(bytes: &[u8], out: &mut [f32], sample: impl Fn([u8; B]) -> f32) {
    let (samples, _) = bytes.as_chunks::<B>();
    for (to, from) in out.iter_mut().zip(samples) {
        *to = sample(*from);
    }
}
