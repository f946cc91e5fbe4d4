//! Volumes: sparse grids of numbers.

pub mod nanovdb;

/// A piece of a sparse grid, with the index of its first voxel.
#[derive(Clone, Copy, Debug)]
pub enum Piece<'v> {
    /// 8^3 values, z fastest, x slowest.
    Brick(&'v [f32; 512]),
    /// The same value over a cube of this many voxels along its edge: 8, 128 or 4096.
    Tile(u32, f32),
}
