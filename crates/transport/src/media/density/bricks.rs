//! Sparse voxels: bricks of 8^3 values under nodes of 16^3 bricks, as OpenVDB and NanoVDB keep them.
//!
//! The grid's space is that of voxel indices: a voxel's value stands at its integer coordinates and is interpolated
//! linearly between them. The bounds run from the first active voxel to one beyond the last, as pbrt-v4 has them.

use super::{Cellwise, Density, Extrema, split, trilinear};
use crate::{TransportError, error::check, media::majorant::Cells};
use tyndall_base::{Vec3, vec::vec3};
use tyndall_geometry::Bounds3;

/// Voxels along the edge of a brick, as a power of two.
const BRICK: u32 = 3;
/// Voxels along the edge of a node, as a power of two.
const NODE: u32 = 7;
/// Bricks of a node.
const CHILDREN: usize = 1 << (3 * (NODE - BRICK));
/// Voxels of a brick.
const VOXELS: usize = 1 << (3 * BRICK);
/// Nodes at most: 2^24 of them span 256 x 256 x 256 times 128 voxels.
const MOST_NODES: usize = 1 << 24;
/// Bit of an entry that refers to what is below; others refer to a constant.
const BELOW: u32 = 1 << 31;

/// A piece of a sparse grid for [`Bricks::set`].
#[derive(Clone, Copy, Debug)]
pub enum Node<'v> {
    /// 8^3 values, z fastest, x slowest.
    Brick(&'v [f32; 512]),
    /// The same value over 8^3 voxels.
    Tile8(f32),
    /// The same value over 128^3 voxels.
    Tile128(f32),
}

/// See the module.
#[derive(Clone, Debug)]
pub struct Bricks {
    /// First and last active voxel.
    active: [[i32; 3]; 2],
    /// The first voxel of the first node.
    origin: [i32; 3],
    dims: [usize; 3],
    nodes: Vec<u32>,
    tables: Vec<u32>,
    bricks: Vec<f32>,
    extrema: Vec<Extrema>,
    constants: Vec<f32>,
}

impl Bricks {
    /// A grid of `background` whose active voxels lie from `first` to `last`.
    pub fn new(first: [i32; 3], last: [i32; 3], background: f32) -> Result<Self, TransportError> {
        check(
            background >= 0.0 && background.is_finite(),
            "background",
            "finite and >= 0",
            f64::from(background),
        )?;
        let unusable = |why: String| TransportError::Unusable { what: "sparse grid", why };
        const FAR: i32 = 1 << 24;
        if (0..3).any(|k| first[k] > last[k] || first[k] < -FAR || last[k] > FAR) {
            return Err(unusable(format!("its voxels run from {first:?} to {last:?}")));
        }
        let origin = first.map(|v| (v >> NODE) << NODE);
        // interpolation reads two voxels beyond the last
        let dims: [usize; 3] = std::array::from_fn(|k| (((last[k] + 2 - origin[k]) >> NODE) + 1) as usize);
        let count = dims.iter().try_fold(1usize, |n, &d| n.checked_mul(d)).filter(|&n| n <= MOST_NODES);
        let Some(count) = count else {
            return Err(unusable(format!("it spans {dims:?} nodes of 128^3 voxels, more than {MOST_NODES}")));
        };
        Ok(Self {
            active: [first, last],
            origin,
            dims,
            nodes: vec![0; count],
            tables: Vec::new(),
            bricks: Vec::new(),
            extrema: Vec::new(),
            constants: vec![background],
        })
    }

    /// Puts `node` at its first voxel `at`; what lies outside the grid is left out.
    ///
    /// # Errors
    /// Values that are negative or not finite.
    pub fn set(&mut self, at: [i32; 3], node: Node<'_>) -> Result<(), TransportError> {
        let ok =
            |v: f32| check(v >= 0.0 && v.is_finite(), "value of a grid", "finite and >= 0", f64::from(v));
        let Some(slot) = self.node_of(at) else { return Ok(()) };
        let entry = match node {
            Node::Tile128(v) => {
                ok(v)?;
                self.nodes[slot] = self.constant(v);
                return Ok(());
            }
            Node::Tile8(v) => {
                ok(v)?;
                self.constant(v)
            }
            Node::Brick(values) => {
                let mut e = Extrema::NONE;
                for &v in values {
                    ok(v)?;
                    e = e.with(v);
                }
                self.bricks.extend_from_slice(values);
                self.extrema.push(e);
                BELOW | (self.extrema.len() as u32 - 1)
            }
        };
        if self.nodes[slot] & BELOW == 0 {
            let table = (self.tables.len() / CHILDREN) as u32;
            self.tables.resize(self.tables.len() + CHILDREN, self.nodes[slot]);
            self.nodes[slot] = BELOW | table;
        }
        let table = (self.nodes[slot] & !BELOW) as usize * CHILDREN;
        self.tables[table + child_of(at)] = entry;
        Ok(())
    }

    fn constant(&mut self, v: f32) -> u32 {
        let known = self.constants.iter().rev().take(8).position(|c| c.to_bits() == v.to_bits());
        if let Some(back) = known {
            return (self.constants.len() - 1 - back) as u32;
        }
        self.constants.push(v);
        self.constants.len() as u32 - 1
    }

    /// First and last active voxel.
    pub fn active(&self) -> [[i32; 3]; 2] {
        self.active
    }

    /// Number of bricks that hold values.
    pub fn len(&self) -> usize {
        self.extrema.len()
    }

    /// True when all is constant.
    pub fn is_empty(&self) -> bool {
        self.extrema.is_empty()
    }

    #[inline(always)]
    fn node_of(&self, v: [i32; 3]) -> Option<usize> {
        let mut at = [0usize; 3];
        for k in 0..3 {
            let i = (v[k] - self.origin[k]) >> NODE;
            if i < 0 || i as usize >= self.dims[k] {
                return None;
            }
            at[k] = i as usize;
        }
        Some((at[2] * self.dims[1] + at[1]) * self.dims[0] + at[0])
    }

    /// The brick that holds voxel `v`, or the constant there.
    #[inline(always)]
    fn find(&self, v: [i32; 3]) -> Result<usize, f32> {
        let Some(slot) = self.node_of(v) else { return Err(self.constants[0]) };
        let node = self.nodes[slot];
        if node & BELOW == 0 {
            return Err(self.constants[node as usize]);
        }
        let entry = self.tables[(node & !BELOW) as usize * CHILDREN + child_of(v)];
        if entry & BELOW == 0 { Err(self.constants[entry as usize]) } else { Ok((entry & !BELOW) as usize) }
    }

    /// The value of voxel `v`.
    #[inline(always)]
    pub fn voxel(&self, v: [i32; 3]) -> f32 {
        match self.find(v) {
            Ok(brick) => self.bricks[brick * VOXELS + voxel_of(v)],
            Err(constant) => constant,
        }
    }
}

/// Place of the brick with voxel `v` in its node.
#[inline(always)]
fn child_of(v: [i32; 3]) -> usize {
    let c = v.map(|x| (x >> BRICK) as usize & 15);
    (c[0] << 8) | (c[1] << 4) | c[2]
}

/// Place of voxel `v` in its brick.
#[inline(always)]
fn voxel_of(v: [i32; 3]) -> usize {
    let c = v.map(|x| x as usize & 7);
    (c[0] << 6) | (c[1] << 3) | c[2]
}

impl Cellwise for Bricks {
    const PLANE: f32 = 0.0;

    #[inline(always)]
    fn cell(&self, [x, y, z]: [i32; 3]) -> [f32; 8] {
        if x & 7 < 7 && y & 7 < 7 && z & 7 < 7 {
            // all eight corners in one brick
            return match self.find([x, y, z]) {
                Err(constant) => [constant; 8],
                Ok(brick) => {
                    let i = brick * VOXELS + voxel_of([x, y, z]);
                    let v = &self.bricks[i..i + 74];
                    [v[0], v[64], v[8], v[72], v[1], v[65], v[9], v[73]]
                }
            };
        }
        let mut corners = [0.0; 8];
        for (i, c) in corners.iter_mut().enumerate() {
            let i = i as i32;
            *c = self.voxel([x + (i & 1), y + (i >> 1 & 1), z + (i >> 2)]);
        }
        corners
    }
}

impl Density for Bricks {
    #[inline(always)]
    fn at(&self, p: Vec3) -> f32 {
        let ((x, dx), (y, dy), (z, dz)) = (split(p.x), split(p.y), split(p.z));
        trilinear(self.cell([x, y, z]), [dx, dy, dz])
    }

    fn extrema(&self, b: Bounds3) -> Extrema {
        // nothing is asked outside the grid and its margin
        let [first, last] = self.active;
        let lo: [i32; 3] = std::array::from_fn(|k| (b.lo[k].floor() as i32).clamp(first[k] - 1, last[k] + 2));
        let hi: [i32; 3] = std::array::from_fn(|k| (b.hi[k].ceil() as i32).clamp(first[k] - 1, last[k] + 2));
        let bricks = |k: usize| (lo[k] >> BRICK)..=(hi[k] >> BRICK);
        let mut e = Extrema::NONE;
        for bx in bricks(0) {
            for by in bricks(1) {
                for bz in bricks(2) {
                    let corner = [bx, by, bz].map(|i| i << BRICK);
                    e = e.union(self.within(corner, lo, hi));
                }
            }
        }
        e
    }

    fn bounds(&self) -> Bounds3 {
        let [first, last] = self.active;
        let v = |v: [i32; 3]| vec3(v[0] as f32, v[1] as f32, v[2] as f32);
        Bounds3::new(v(first), v(last.map(|x| x + 1)))
    }

    fn cells(&self) -> Cells {
        let [first, last] = self.active;
        let origin = first.map(|x| (x >> BRICK) << BRICK);
        let dims = std::array::from_fn(|k| (((last[k] - origin[k]) >> BRICK) + 1) as usize);
        Cells {
            origin: vec3(origin[0] as f32, origin[1] as f32, origin[2] as f32),
            edge: Vec3::splat(8.0),
            dims,
        }
    }

    fn detail(&self) -> f32 {
        1.0
    }
}

impl Bricks {
    /// Extrema over the voxels from `lo` to `hi` of the brick at `corner`.
    fn within(&self, corner: [i32; 3], lo: [i32; 3], hi: [i32; 3]) -> Extrema {
        let brick = match self.find(corner) {
            Err(constant) => return Extrema { max: constant, min: constant },
            Ok(brick) => brick,
        };
        let from: [i32; 3] = std::array::from_fn(|k| lo[k].max(corner[k]));
        let to: [i32; 3] = std::array::from_fn(|k| hi[k].min(corner[k] + 7));
        if (0..3).all(|k| to[k] - from[k] == 7) {
            return self.extrema[brick];
        }
        let values = &self.bricks[brick * VOXELS..(brick + 1) * VOXELS];
        let mut e = Extrema::NONE;
        for x in from[0]..=to[0] {
            for y in from[1]..=to[1] {
                for z in from[2]..=to[2] {
                    e = e.with(values[voxel_of([x, y, z])]);
                }
            }
        }
        e
    }
}
