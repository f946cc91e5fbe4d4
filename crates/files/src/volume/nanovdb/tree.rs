//! One grid: its description and the walk through its tree.
//!
//! Root (a table of cubes of 4096^3 voxels), upper nodes (32^3 cubes of 128^3), lower nodes (16^3 cubes of 8^3), leaves
//! (8^3 voxels). A child is given by its distance in bytes from the node that names it.

use super::{Class, MAGIC_GRID, MAGIC_OLD, leaf::Kind, version};
use crate::{
    error::{FileError, Result},
    volume::{Piece, bytes::Bytes},
};
use std::{
    borrow::Cow,
    path::{Path, PathBuf},
};

/// Bytes of a grid's description; that of the tree follows.
pub const GRID_BYTES: u64 = 672;
/// Where the table of an upper and of a lower node begins.
const UPPER_TABLE: u64 = 8256;
const LOWER_TABLE: u64 = 1088;
/// Entries of the two tables.
const UPPER_ENTRIES: u64 = 32 * 32 * 32;
const LOWER_ENTRIES: u64 = 16 * 16 * 16;
/// Voxel indices beyond this are damage.
const FAR: i32 = 1 << 24;

/// A grid of numbers.
#[derive(Debug)]
pub struct Grid<'d> {
    path: PathBuf,
    data: Cow<'d, [u8]>,
    kind: Kind,
    class: Class,
    root: u64,
    table: [u64; 2],
    background: f32,
    index_box: [[i32; 3]; 2],
    to_world: [[f64; 4]; 3],
}

/// The name in a grid's own description.
pub(super) fn name(file: &Bytes<'_>, at: u64) -> Result<String> {
    let bytes = file.slice(at + 40, 256)?;
    let name = bytes.split(|b| *b == 0).next().unwrap_or_default();
    Ok(String::from_utf8_lossy(name).into_owned())
}

impl<'d> Grid<'d> {
    pub(super) fn new(path: &Path, data: Cow<'d, [u8]>) -> Result<Self> {
        let b = Bytes::new(path, &data);
        let magic = b.u64(0)?;
        if magic != MAGIC_OLD && magic != MAGIC_GRID {
            return Err(b.bad(0, "the mark of a NanoVDB grid", format!("{magic:#018x}")));
        }
        version(&b, 16)?;
        let number = b.u32(636)?;
        let kind = Kind::find(number).ok_or_else(|| FileError::Unsupported {
            path: path.into(),
            feature: format!("a NanoVDB grid of type {number}"),
            hint: "grids of type Float, Double, Fp4, Fp8, Fp16 and FpN are read".into(),
        })?;
        let class = match b.u32(632)? {
            0 => Class::Unknown,
            1 => Class::LevelSet,
            2 => Class::FogVolume,
            other => Class::Other(other),
        };
        let root = b.follow(GRID_BYTES, b.u64(GRID_BYTES + 24)? as i64)?;
        // the root's numbers: box, count of tiles, background, three more of its size, two of statistics
        let corner = |at: u64| Ok([b.i32(at)?, b.i32(at + 4)?, b.i32(at + 8)?]);
        let index_box = [corner(root)?, corner(root + 12)?];
        let size = kind.value_bytes();
        let background_at = if size == 8 { 32 } else { 28 };
        let table = root + if size == 8 { 96 } else { 64 };
        let tiles = u64::from(b.u32(root + 24)?);
        b.slice(table, tiles * 32)?;
        let background = kind.value(&b, root + background_at)?;
        let to_world = map(&b)?;
        let empty = tiles == 0;
        let far = index_box.iter().flatten().any(|v| v.abs() > FAR);
        if !empty && (far || (0..3).any(|k| index_box[0][k] > index_box[1][k])) {
            return Err(b.bad(root, "a box of voxel indices", format!("{index_box:?}")));
        }
        let index_box = if empty { [[0; 3]; 2] } else { index_box };
        let table = [table, tiles];
        Ok(Self { path: path.into(), kind, class, root, table, background, index_box, to_world, data })
    }

    /// What the grid says it is.
    pub fn class(&self) -> Class {
        self.class
    }

    /// Value where nothing is stored.
    pub fn background(&self) -> f32 {
        self.background
    }

    /// First and last active voxel.
    pub fn index_box(&self) -> [[i32; 3]; 2] {
        self.index_box
    }

    /// Rows of the affine map from voxel indices to the world of the file.
    pub fn to_world(&self) -> [[f64; 4]; 3] {
        self.to_world
    }

    /// Hands every stored piece to `sink`, with the index of its first voxel; what is not handed over is background.
    pub fn visit<E: From<FileError>>(
        &self,
        mut sink: impl FnMut([i32; 3], Piece<'_>) -> std::result::Result<(), E>,
    ) -> std::result::Result<(), E> {
        let mut walk = Walk::new(Bytes::new(&self.path, &self.data), self.kind, self.background);
        let [table, tiles] = self.table;
        for i in 0..tiles {
            let at = table + 32 * i;
            let key = walk.data.u64(at)?;
            let child = walk.data.u64(at + 8)? as i64;
            let axis = |shift: u32| ((key >> shift & 0x1f_ffff) << 12) as u32 as i32;
            let origin = [axis(42), axis(21), axis(0)];
            if child == 0 {
                let value_at = if self.kind.value_bytes() == 8 { 24 } else { 20 };
                let value = self.kind.value(&walk.data, at + value_at)?;
                walk.tile(origin, 4096, value, &mut sink)?;
            } else {
                let to = walk.data.follow(self.root, child)?;
                walk.upper(to, origin, &mut sink)?;
            }
        }
        Ok(())
    }
}

/// The map in double precision: 3x3 matrix at byte 296 + 88, translation behind its inverse.
fn map(b: &Bytes<'_>) -> Result<[[f64; 4]; 3]> {
    let matrix = 296 + 88;
    let mut rows = [[0.0; 4]; 3];
    for (r, row) in rows.iter_mut().enumerate() {
        for (c, v) in row.iter_mut().enumerate() {
            *v = if c < 3 {
                b.f64(matrix + 8 * (3 * r + c) as u64)?
            } else {
                b.f64(matrix + 144 + 8 * r as u64)?
            };
            if !v.is_finite() {
                return Err(b.bad(matrix, "a finite map to the world", *v));
            }
        }
    }
    Ok(rows)
}

/// The way down, which no file can make longer than itself.
struct Walk<'d> {
    data: Bytes<'d>,
    kind: Kind,
    background: f32,
    /// Nodes that the bytes have room for: upper, lower, leaves.
    room: [u64; 3],
    values: Box<[f32; 512]>,
}

impl<'d> Walk<'d> {
    fn new(data: Bytes<'d>, kind: Kind, background: f32) -> Self {
        let each = [UPPER_TABLE + 8 * UPPER_ENTRIES, LOWER_TABLE + 8 * LOWER_ENTRIES, kind.leaf_bytes()];
        Self { data, kind, background, room: each.map(|n| data.len() / n), values: Box::new([0.0; 512]) }
    }

    /// One node of a level more.
    fn count(&mut self, level: usize, at: u64) -> Result<()> {
        match self.room[level].checked_sub(1) {
            Some(left) => self.room[level] = left,
            None => {
                return Err(self.data.bad(at, "each node named once", "more nodes than the file can hold"));
            }
        }
        Ok(())
    }

    fn tile<E>(
        &self,
        origin: [i32; 3],
        edge: u32,
        value: f32,
        sink: &mut impl FnMut([i32; 3], Piece<'_>) -> std::result::Result<(), E>,
    ) -> std::result::Result<(), E> {
        if value.to_bits() == self.background.to_bits() {
            Ok(())
        } else {
            sink(origin, Piece::Tile(edge, value))
        }
    }

    fn upper<E: From<FileError>>(
        &mut self,
        at: u64,
        origin: [i32; 3],
        sink: &mut impl FnMut([i32; 3], Piece<'_>) -> std::result::Result<(), E>,
    ) -> std::result::Result<(), E> {
        self.count(0, at)?;
        let children = self.data.slice(at + 32 + 4096, 4096)?;
        for i in 0..UPPER_ENTRIES {
            let first = place(origin, i as i32, 5, 128);
            let entry = at + UPPER_TABLE + 8 * i;
            if children[i as usize / 8] >> (i % 8) & 1 == 1 {
                let to = self.data.follow(at, self.data.u64(entry)? as i64)?;
                self.lower(to, first, sink)?;
            } else {
                self.tile(first, 128, self.kind.value(&self.data, entry)?, sink)?;
            }
        }
        Ok(())
    }

    fn lower<E: From<FileError>>(
        &mut self,
        at: u64,
        origin: [i32; 3],
        sink: &mut impl FnMut([i32; 3], Piece<'_>) -> std::result::Result<(), E>,
    ) -> std::result::Result<(), E> {
        self.count(1, at)?;
        let children = self.data.slice(at + 32 + 512, 512)?;
        for i in 0..LOWER_ENTRIES {
            let first = place(origin, i as i32, 4, 8);
            let entry = at + LOWER_TABLE + 8 * i;
            if children[i as usize / 8] >> (i % 8) & 1 == 1 {
                let to = self.data.follow(at, self.data.u64(entry)? as i64)?;
                self.count(2, to)?;
                self.kind.leaf(&self.data, to, &mut self.values)?;
                sink(first, Piece::Brick(&self.values))?;
            } else {
                self.tile(first, 8, self.kind.value(&self.data, entry)?, sink)?;
            }
        }
        Ok(())
    }
}

/// First voxel of the `i`-th entry of a node with 2^`log` entries along an axis, each of `edge` voxels; x is slowest.
fn place(origin: [i32; 3], i: i32, log: u32, edge: i32) -> [i32; 3] {
    let mask = (1 << log) - 1;
    let step = [i >> (2 * log), i >> log & mask, i & mask];
    std::array::from_fn(|k| origin[k].wrapping_add(step[k] * edge))
}
