//! OpenVDB files (`.vdb`), format versions 222 to 225: grids of floats and doubles, also stored as halves; plain, zip or blosc.
//!
//! Source of the layout: Museth 2013, *VDB: High-resolution sparse volumes with dynamic topology*, and the public format of
//! OpenVDB. A file is a header, its metadata, and the grids, each with a descriptor in front that says where it lies. A
//! grid is its compression, metadata, the map of its voxels to the world, then the tree twice over: masks and tiles of all
//! nodes, and behind them the values of all leaves.
//!
//! Own code: the crate vdb-rs ends the program on maps it does not know and takes sizes from the file unchecked.

mod cursor;
mod map;
mod tree;
mod values;

pub use tree::Grid;

use super::Class;
use crate::error::{FileError, Result};
use cursor::Cursor;
use std::{collections::BTreeMap, fs::File, path::Path, path::PathBuf};

/// The first eight bytes.
pub(super) const MAGIC: u64 = 0x5644_4220;
/// Versions that are read: masks of nodes are compressed from the first on.
const VERSIONS: std::ops::RangeInclusive<u32> = 222..=225;
/// What ends the name of a type whose values are stored in 16 bits.
const HALF: &str = "_HalfFloat";

/// An opened file.
#[derive(Debug)]
pub struct OpenVdb {
    path: PathBuf,
    data: memmap2::Mmap,
    grids: Vec<Entry>,
}

/// Where a grid lies, and what it holds.
#[derive(Clone, Debug)]
struct Entry {
    name: String,
    kind: String,
    parent: String,
    at: u64,
}

impl OpenVdb {
    /// Maps the file and reads its table of grids.
    ///
    /// # Errors
    /// [`FileError::Io`], [`FileError::Malformed`], or [`FileError::Unsupported`] for versions that are not read.
    pub fn open(path: &Path) -> Result<Self> {
        let file = File::open(path).map_err(|e| FileError::io(path, "open", e))?;
        // SAFETY: as for NanoVDB: the map is read only and private, and no reference type depends on its values.
        #[allow(unsafe_code)]
        let data = unsafe { memmap2::Mmap::map(&file) }.map_err(|e| FileError::io(path, "map", e))?;
        let grids = table(&mut Cursor::new(path, &data, 0))?;
        Ok(Self { path: path.into(), data, grids })
    }

    /// Names of the grids in the order of the file.
    pub fn names(&self) -> Vec<&str> {
        self.grids.iter().map(|g| g.name.as_str()).collect()
    }

    /// The first grid called `name`; `None` where there is none.
    ///
    /// # Errors
    /// [`FileError::Malformed`], or [`FileError::Unsupported`] for other values than floats, instances and maps that are not
    /// affine.
    pub fn grid(&self, name: &str) -> Result<Option<Grid>> {
        let Some(entry) = self.grids.iter().find(|g| g.name == name) else { return Ok(None) };
        let (kind, half) = match entry.kind.strip_suffix(HALF) {
            Some(kind) => (kind, true),
            None => (entry.kind.as_str(), false),
        };
        let stored = match kind {
            "Tree_float_5_4_3" => values::Stored { double: false, half },
            "Tree_double_5_4_3" => values::Stored { double: true, half },
            other => {
                let what = format!("grid \"{name}\" of type {other}");
                let hint = "grids of floats or doubles are read";
                return Err(FileError::unsupported(&self.path, what, hint));
            }
        };
        if !entry.parent.is_empty() {
            let what = format!("grid \"{name}\", an instance of \"{}\"", entry.parent);
            return Err(FileError::unsupported(&self.path, what, "write the grid out on its own"));
        }
        let mut cursor = Cursor::new(&self.path, &self.data, entry.at);
        let codec = values::Codec::read(&mut cursor)?;
        let metadata = metadata(&mut cursor)?;
        let to_world = map::affine(&mut cursor)?;
        Grid::read(&mut cursor, stored, codec, class(&metadata), to_world).map(Some)
    }
}

/// The class that metadata claim.
fn class(metadata: &BTreeMap<String, Vec<u8>>) -> Class {
    match metadata.get("class").map(Vec::as_slice) {
        Some(b"fog volume") => Class::FogVolume,
        Some(b"level set") => Class::LevelSet,
        None | Some(b"" | b"unknown") => Class::Unknown,
        Some(b"staggered") => Class::Other(3),
        Some(_) => Class::Other(0),
    }
}

/// Header and descriptors.
fn table(cursor: &mut Cursor<'_>) -> Result<Vec<Entry>> {
    let magic = cursor.u64()?;
    if magic != MAGIC {
        return Err(cursor.bad(0, "the mark of an OpenVDB file", format!("{magic:#018x}")));
    }
    let version = cursor.u32()?;
    if !VERSIONS.contains(&version) {
        let what = format!("version {version} of the format");
        let hint =
            "versions 222 to 225 are read (OpenVDB 2 and later): write the file again with a current program";
        return Err(FileError::unsupported(cursor.path(), what, hint));
    }
    let _library = [cursor.u32()?, cursor.u32()?];
    let has_offsets = cursor.u8()? != 0;
    let _uuid = cursor.take(36)?;
    metadata(cursor)?;
    if !has_offsets {
        let what = "a file without offsets of its grids, as streams have";
        return Err(FileError::unsupported(cursor.path(), what, "write it to a file, not to a pipe"));
    }
    let count = cursor.u32()?;
    let mut grids = Vec::new();
    for _ in 0..count {
        let name = cursor.text()?;
        // a second grid of a name has its number behind a record separator
        let name = name.split('\u{1e}').next().unwrap_or_default().to_string();
        let (kind, parent) = (cursor.text()?, cursor.text()?);
        // the values of leaves follow the tree; some writers give another place for them, which OpenVDB does not look at
        let [at, _leaves, end] = [cursor.u64()?, cursor.u64()?, cursor.u64()?];
        grids.push(Entry { name, kind, parent, at });
        cursor.seek(end)?;
    }
    Ok(grids)
}

/// Names and the bytes of their values.
fn metadata(cursor: &mut Cursor<'_>) -> Result<BTreeMap<String, Vec<u8>>> {
    let count = cursor.u32()?;
    let mut all = BTreeMap::new();
    for _ in 0..count {
        let (name, _kind) = (cursor.text()?, cursor.text()?);
        let length = cursor.u32()?;
        all.insert(name, cursor.take(length.into())?.to_vec());
    }
    Ok(all)
}
