//! The voxels of a regular grid around a point, whatever they hold. The grid's space has voxels of edge 1 from 0 to n.

use super::{Edge, split};
use crate::media::majorant::Cells;
use tyndall_base::{Vec3, vec::vec3};
use tyndall_geometry::Bounds3;

/// Weight and index of each of the eight voxels around a point; no index where the value is zero.
pub(crate) type Corners = [(f32, Option<usize>); 8];

/// A grid's size and what lies beyond its outermost centres.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lattice {
    /// Voxels along each axis.
    pub dims: [usize; 3],
    /// Beyond the outermost centres.
    pub edge: Edge,
}

impl Lattice {
    /// Index of a voxel, x fastest; `v` counts a margin of one voxel, which is `None` where the grid fades to zero.
    #[inline(always)]
    pub fn voxel(self, v: [i32; 3]) -> Option<usize> {
        let mut at = [0usize; 3];
        for k in 0..3 {
            let n = self.dims[k] as i32;
            let i = v[k] - 1;
            at[k] = match self.edge {
                Edge::Clamp => i.clamp(0, n - 1) as usize,
                Edge::Fade if i < 0 || i >= n => return None,
                Edge::Fade => i as usize,
            };
        }
        Some((at[2] * self.dims[1] + at[1]) * self.dims[0] + at[0])
    }

    /// What linear interpolation at `p` reads.
    #[inline(always)]
    pub fn corners(self, p: Vec3) -> Corners {
        let [(x, dx), (y, dy), (z, dz)] = [split(p.x + 0.5), split(p.y + 0.5), split(p.z + 0.5)];
        let mut corners = [(0.0, None); 8];
        for (i, c) in corners.iter_mut().enumerate() {
            let i = i as i32;
            let pick = |bit: i32, d: f32| if i >> bit & 1 == 1 { d } else { 1.0 - d };
            let weight = pick(0, dx) * pick(1, dy) * pick(2, dz);
            *c = (weight, self.voxel([x + (i & 1), y + (i >> 1 & 1), z + (i >> 2)]));
        }
        corners
    }
}

/// The whole of a grid in its own space.
pub(crate) fn bounds_of(dims: [usize; 3]) -> Bounds3 {
    let [x, y, z] = dims.map(|n| n as f32);
    Bounds3::new(Vec3::ZERO, vec3(x, y, z))
}

/// Cells of 2^k voxels, at least 16 of them along the longest axis where there are so many voxels, and k at most 3.
pub(crate) fn cells_of(dims: [usize; 3]) -> Cells {
    let longest = dims.iter().copied().max().unwrap_or(1);
    let edge = [8usize, 4, 2].into_iter().find(|e| longest / e >= 16).unwrap_or(1);
    Cells { origin: Vec3::ZERO, edge: Vec3::splat(edge as f32), dims: dims.map(|n| n.div_ceil(edge)) }
}

/// Indices (with the margin) of the voxels that interpolation in `b` reads.
pub(crate) fn reach(b: Bounds3, dims: [usize; 3]) -> impl Iterator<Item = [usize; 3]> {
    let axis = |lo: f32, hi: f32, n: usize| {
        let at = |x: f32| (x + 0.5).floor().clamp(0.0, (n + 1) as f32) as usize;
        at(lo)..=(at(hi) + 1).min(n + 1)
    };
    let xs = axis(b.lo.x, b.hi.x, dims[0]);
    let ys = axis(b.lo.y, b.hi.y, dims[1]);
    let zs = axis(b.lo.z, b.hi.z, dims[2]);
    zs.flat_map(move |z| {
        let xs = xs.clone();
        ys.clone().flat_map(move |y| xs.clone().map(move |x| [x, y, z]))
    })
}
