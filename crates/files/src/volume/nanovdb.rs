//! NanoVDB files (`.nvdb`), format version 32: float, double and quantised grids, plain, zip or blosc.
//!
//! Source of the layout: Museth 2021, *NanoVDB: a GPU-friendly and portable VDB data structure for real-time rendering
//! and simulation*, and the public format of OpenVDB's NanoVDB, major version 32. A file is a row of segments: a header
//! of 16 bytes, 176 bytes and a name for each grid, then the grids, each compressed on its own. A file may also be a row of
//! bare grids. The file is mapped, not read; every offset in it is checked before it is followed.

mod leaf;
mod tree;

pub use super::Class;
pub use tree::Grid;

use super::{blosc, bytes::Bytes};
use crate::error::{FileError, Place, Result};
use std::{borrow::Cow, fs::File, io::Read, path::Path, path::PathBuf};

const MAGIC_OLD: u64 = 0x3042_4456_6f6e_614e;
const MAGIC_GRID: u64 = 0x3142_4456_6f6e_614e;
const MAGIC_FILE: u64 = 0x3242_4456_6f6e_614e;
/// The major version that is read.
const MAJOR: u32 = 32;
/// What compression gains at most: deflate reaches 1032, LZ4 255.
const MOST_GAIN: u64 = 1032;

/// An opened file.
#[derive(Debug)]
pub struct NanoVdb {
    path: PathBuf,
    data: memmap2::Mmap,
    grids: Vec<Entry>,
}

/// Where a grid lies in the file.
#[derive(Clone, Debug)]
struct Entry {
    name: String,
    codec: Codec,
    at: u64,
    stored: u64,
    size: u64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Codec {
    None,
    Zip,
    Blosc,
}

impl NanoVdb {
    /// Maps the file and reads its table of grids.
    pub fn open(path: &Path) -> Result<Self> {
        let file = File::open(path).map_err(|e| FileError::io(path, "open", e))?;
        // SAFETY: the map is read only and private to this value. Should another process shorten or change the file, reads
        // see other bytes or a signal ends the program, as with every mapped file; no reference type depends on its values.
        #[allow(unsafe_code)]
        let data = unsafe { memmap2::Mmap::map(&file) }.map_err(|e| FileError::io(path, "map", e))?;
        let grids = table(&Bytes::new(path, &data))?;
        Ok(Self { path: path.into(), data, grids })
    }

    /// Names of the grids in the order of the file.
    pub fn names(&self) -> Vec<&str> {
        self.grids.iter().map(|g| g.name.as_str()).collect()
    }

    /// The first grid called `name`; `None` where there is none.
    pub fn grid(&self, name: &str) -> Result<Option<Grid<'_>>> {
        let Some(entry) = self.grids.iter().find(|g| g.name == name) else { return Ok(None) };
        let file = Bytes::new(&self.path, &self.data);
        let stored = file.slice(entry.at, entry.stored)?;
        let gain = if entry.codec == Codec::None { 1 } else { MOST_GAIN };
        if entry.size > entry.stored.saturating_mul(gain) {
            return Err(FileError::Oversized {
                path: self.path.clone(),
                what: "a grid",
                announced: entry.size.into(),
                justified: entry.stored.saturating_mul(gain).into(),
                file_bytes: self.data.len() as u64,
            });
        }
        let bytes = match entry.codec {
            Codec::None => Cow::Borrowed(stored),
            Codec::Zip => Cow::Owned(unzip(&file, entry, stored)?),
            Codec::Blosc => Cow::Owned(blosc::chunks(&file, entry.at, stored, entry.size)?),
        };
        Grid::new(&self.path, bytes).map(Some)
    }
}

/// A compressed grid: its length, then a zlib stream.
fn unzip(file: &Bytes<'_>, entry: &Entry, stored: &[u8]) -> Result<Vec<u8>> {
    let length = file.u64(entry.at)?;
    let packed = file.slice(entry.at + 8, length)?;
    if length > stored.len() as u64 {
        return Err(file.bad(entry.at, format!("at most {} compressed bytes", stored.len()), length));
    }
    let mut out = Vec::new();
    flate2::read::ZlibDecoder::new(packed)
        .take(entry.size.saturating_add(1))
        .read_to_end(&mut out)
        .map_err(|e| file.bad(entry.at, "a zlib stream", e))?;
    if out.len() as u64 != entry.size {
        return Err(file.bad(entry.at, format!("{} bytes after decompression", entry.size), out.len()));
    }
    Ok(out)
}

/// All segments, or bare grids.
fn table(file: &Bytes<'_>) -> Result<Vec<Entry>> {
    if file.u64(0)? == MAGIC_GRID {
        return bare(file);
    }
    let mut grids = Vec::new();
    let mut at = 0;
    while at < file.len() {
        let magic = file.u64(at)?;
        if magic != MAGIC_OLD && magic != MAGIC_FILE {
            return Err(file.bad(at, "the mark of a NanoVDB file", foreign(magic)));
        }
        version(file, at + 8)?;
        let (count, codec) = (file.u16(at + 12)?, file.u16(at + 14)?);
        at += 16;
        let first = grids.len();
        for _ in 0..count {
            let (size, stored) = (file.u64(at)?, file.u64(at + 8)?);
            let length = file.u32(at + 136)?;
            let codec = match file.u16(at + 168)?.max(codec) {
                0 => Codec::None,
                1 => Codec::Zip,
                2 => Codec::Blosc,
                other => return Err(file.bad(at + 168, "compression 0 (none), 1 (zip) or 2 (blosc)", other)),
            };
            let name = file.slice(at + 176, length.into())?;
            let name = name.split(|b| *b == 0).next().unwrap_or_default();
            let name = String::from_utf8_lossy(name).into_owned();
            at += 176 + u64::from(length);
            grids.push(Entry { name, codec, at: 0, stored, size });
        }
        for grid in &mut grids[first..] {
            file.slice(at, grid.stored)?;
            grid.at = at;
            at += grid.stored;
        }
    }
    Ok(grids)
}

/// Grids without a table, one behind the other.
fn bare(file: &Bytes<'_>) -> Result<Vec<Entry>> {
    let mut grids = Vec::new();
    let mut at = 0;
    while at < file.len() {
        let size = file.u64(at + 32)?;
        if size < tree::GRID_BYTES || file.slice(at, size).is_err() {
            return Err(file.bad(at + 32, "the size of a grid within the file", size));
        }
        let name = tree::name(file, at)?;
        grids.push(Entry { name, codec: Codec::None, at, stored: size, size });
        at += size;
    }
    Ok(grids)
}

/// Refuses layouts of another major version.
fn version(file: &Bytes<'_>, at: u64) -> Result<()> {
    let v = file.u32(at)?;
    if v >> 21 == MAJOR {
        return Ok(());
    }
    let found = format!("{}.{}.{}", v >> 21, v >> 10 & 0x7ff, v & 0x3ff);
    Err(FileError::Malformed {
        path: file.path().into(),
        place: Place::Byte(at),
        expected: format!("NanoVDB version {MAJOR}"),
        got: found,
        hint: "convert the volume again with a current nanovdb_convert".into(),
    })
}

fn foreign(magic: u64) -> String {
    let swapped = [MAGIC_OLD, MAGIC_FILE, MAGIC_GRID].contains(&magic.swap_bytes());
    if swapped {
        return "one with bytes in reverse order".into();
    }
    if magic == super::openvdb::MAGIC {
        return "an OpenVDB file".into();
    }
    format!("{magic:#018x}")
}
