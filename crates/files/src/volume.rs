//! Volumes: sparse grids of numbers.

mod blosc;
mod bytes;
pub mod nanovdb;
pub mod openvdb;

use crate::error::{FileError, Result};
use nanovdb::NanoVdb;
use openvdb::OpenVdb;
use std::{fs::File, io::Read, path::Path};

/// A piece of a sparse grid, with the index of its first voxel.
#[derive(Clone, Copy, Debug)]
pub enum Piece<'v> {
    /// 8^3 values, z fastest, x slowest.
    Brick(&'v [f32; 512]),
    /// The same value over a cube of this many voxels along its edge: 8, 128 or 4096.
    Tile(u32, f32),
}

/// What a grid says it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// Nothing.
    Unknown,
    /// Distances to a surface.
    LevelSet,
    /// Densities.
    FogVolume,
    /// Something else, by NanoVDB's number.
    Other(u32),
}

/// A file of grids, whichever of the two formats it has.
#[derive(Debug)]
pub enum Volume {
    /// `.nvdb`
    Nano(NanoVdb),
    /// `.vdb`
    Open(OpenVdb),
}

/// A grid of such a file.
#[derive(Debug)]
pub enum Grid<'d> {
    /// Read where it lies in the file.
    Nano(nanovdb::Grid<'d>),
    /// Unpacked.
    Open(openvdb::Grid),
}

impl Volume {
    /// Opens a file; its first bytes tell the format.
    ///
    /// # Errors
    /// Those of [`NanoVdb::open`] and [`OpenVdb::open`].
    pub fn open(path: &Path) -> Result<Self> {
        let mut magic = [0; 8];
        let mut file = File::open(path).map_err(|e| FileError::io(path, "open", e))?;
        // a file without eight bytes is neither; NanoVDB's reader says so
        let is_open = file.read_exact(&mut magic).is_ok() && u64::from_le_bytes(magic) == openvdb::MAGIC;
        if is_open { OpenVdb::open(path).map(Self::Open) } else { NanoVdb::open(path).map(Self::Nano) }
    }

    /// Names of the grids in the order of the file.
    pub fn names(&self) -> Vec<&str> {
        match self {
            Self::Nano(v) => v.names(),
            Self::Open(v) => v.names(),
        }
    }

    /// The first grid called `name`; `None` where there is none.
    ///
    /// # Errors
    /// Those of [`NanoVdb::grid`] and [`OpenVdb::grid`].
    pub fn grid(&self, name: &str) -> Result<Option<Grid<'_>>> {
        Ok(match self {
            Self::Nano(v) => v.grid(name)?.map(Grid::Nano),
            Self::Open(v) => v.grid(name)?.map(Grid::Open),
        })
    }
}

impl Grid<'_> {
    /// What the grid says it is.
    pub fn class(&self) -> Class {
        match self {
            Self::Nano(g) => g.class(),
            Self::Open(g) => g.class(),
        }
    }

    /// Value where nothing is stored.
    pub fn background(&self) -> f32 {
        match self {
            Self::Nano(g) => g.background(),
            Self::Open(g) => g.background(),
        }
    }

    /// First and last active voxel.
    pub fn index_box(&self) -> [[i32; 3]; 2] {
        match self {
            Self::Nano(g) => g.index_box(),
            Self::Open(g) => g.index_box(),
        }
    }

    /// Rows of the affine map from voxel indices to the world of the file.
    pub fn to_world(&self) -> [[f64; 4]; 3] {
        match self {
            Self::Nano(g) => g.to_world(),
            Self::Open(g) => g.to_world(),
        }
    }

    /// Hands every stored piece to `sink`, with the index of its first voxel; what is not handed over is background.
    ///
    /// # Errors
    /// Those of `sink`, and those of [`nanovdb::Grid::visit`].
    pub fn visit<E: From<FileError>>(
        &self,
        sink: impl FnMut([i32; 3], Piece<'_>) -> std::result::Result<(), E>,
    ) -> std::result::Result<(), E> {
        match self {
            Self::Nano(g) => g.visit(sink),
            Self::Open(g) => g.visit(sink),
        }
    }
}
