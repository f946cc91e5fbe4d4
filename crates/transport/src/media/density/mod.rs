//! Densities: a number at every point of a grid's own space, by which the spectra of a medium are multiplied.

mod bricks;
mod cloud;
mod dense;
mod lattice;

pub use bricks::{Bricks, Node};
pub use cloud::Cloud;
pub use dense::{Dense, Edge};
pub(crate) use lattice::{Corners, Lattice, bounds_of, cells_of, reach};

use super::majorant::Cells;
use tyndall_base::Vec3;
use tyndall_geometry::Bounds3;

/// Greatest and least value over a region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extrema {
    /// Greatest value.
    pub max: f32,
    /// Least value.
    pub min: f32,
}

impl Extrema {
    /// Of no values at all.
    pub const NONE: Self = Self { max: 0.0, min: f32::INFINITY };

    /// Of both regions.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { max: self.max.max(other.max), min: self.min.min(other.min) }
    }

    /// With one more value.
    #[must_use]
    pub fn with(self, v: f32) -> Self {
        Self { max: self.max.max(v), min: self.min.min(v) }
    }
}

/// A density over space. Never negative, zero outside its bounds.
pub trait Density: Send + Sync + std::fmt::Debug {
    /// The density at `p`, a point inside the bounds.
    fn at(&self, p: Vec3) -> f32;
    /// Bounds of the density over a box.
    fn extrema(&self, b: Bounds3) -> Extrema;
    /// Where it may differ from zero.
    fn bounds(&self) -> Bounds3;
    /// The cells that majorants are kept for.
    fn cells(&self) -> Cells;
    /// Length over which it varies: the edge of a voxel.
    fn detail(&self) -> f32;
}

/// A density that is trilinear between planes one unit apart along each axis.
pub trait Cellwise: Density {
    /// Where the planes lie: at this plus whole numbers.
    const PLANE: f32;
    /// The values at the corners of the cell from `PLANE + cell` on, x fastest; of a cell in the bounds.
    fn cell(&self, cell: [i32; 3]) -> [f32; 8];
}

/// Index below `x` and how far beyond it `x` lies.
#[inline(always)]
pub(crate) fn split(x: f32) -> (i32, f32) {
    let truncated = x as i32;
    let below = if truncated as f32 > x { truncated - 1 } else { truncated };
    (below, x - below as f32)
}

/// Interpolates the eight values at the corners of a voxel, x fastest.
#[inline(always)]
pub(crate) fn trilinear(v: [f32; 8], d: [f32; 3]) -> f32 {
    let mix = |a: f32, b: f32, t: f32| (1.0 - t) * a + t * b;
    let x = |i: usize| mix(v[i], v[i + 1], d[0]);
    mix(mix(x(0), x(2), d[1]), mix(x(4), x(6), d[1]), d[2])
}

#[cfg(test)]
mod tests;
