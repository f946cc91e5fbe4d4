//! The tree of a grid: a root, nodes of 32^3, nodes of 16^3, leaves of 8^3 voxels.

use super::{
    super::{Class, Piece},
    cursor::{Cursor, Mask},
    values::{self, Codec, Stored},
};
use crate::error::{FileError, Result};

/// Voxels along the edge of a leaf, of a lower and of an upper node.
const EDGE: [i32; 3] = [8, 128, 4096];
/// Children along the edge of a node, as a power of two, above leaves and above lower nodes.
const CHILDREN: [u32; 2] = [4, 5];
/// Upper nodes per axis are counted from here on: voxels beyond are refused.
const FARTHEST: i32 = 1 << 24;

/// A grid of numbers.
#[derive(Debug)]
pub struct Grid {
    class: Class,
    background: f32,
    index_box: [[i32; 3]; 2],
    to_world: [[f64; 4]; 3],
    leaves: Vec<([i32; 3], Box<[f32; 512]>)>,
    tiles: Vec<([i32; 3], u32, f32)>,
}

impl Grid {
    /// Reads the tree at the cursor, and the values of its leaves behind it.
    pub(super) fn read(
        cursor: &mut Cursor<'_>,
        stored: Stored,
        codec: Codec,
        class: Class,
        to_world: [[f64; 4]; 3],
    ) -> Result<Self> {
        let at = cursor.at();
        let buffers = cursor.u32()?;
        if buffers != 1 {
            return Err(cursor.bad(at, "one buffer a leaf", buffers));
        }
        let background = stored.value(cursor)?;
        let mut topology = Topology {
            stored,
            codec,
            background,
            origins: Vec::new(),
            tiles: Vec::new(),
            active: [[i32::MAX; 3], [i32::MIN; 3]],
        };
        topology.root(cursor)?;
        let mut leaves = Vec::new();
        for origin in topology.origins {
            let mask = cursor.mask(512)?;
            let values = values::read(cursor, 512, mask, background, stored, codec)?;
            let values: Box<[f32; 512]> = values
                .into_boxed_slice()
                .try_into()
                .map_err(|_| cursor.bad(cursor.at(), "512 values", "others"))?;
            leaves.push((origin, values));
        }
        let empty = topology.active[0][0] > topology.active[1][0];
        let index_box = if empty { [[0; 3]; 2] } else { topology.active };
        Ok(Self { class, background, index_box, to_world, leaves, tiles: topology.tiles })
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
    ///
    /// # Errors
    /// Those of `sink`.
    pub fn visit<E: From<FileError>>(
        &self,
        mut sink: impl FnMut([i32; 3], Piece<'_>) -> std::result::Result<(), E>,
    ) -> std::result::Result<(), E> {
        for (origin, edge, value) in &self.tiles {
            sink(*origin, Piece::Tile(*edge, *value))?;
        }
        for (origin, values) in &self.leaves {
            sink(*origin, Piece::Brick(values))?;
        }
        Ok(())
    }
}

/// What the first pass over the tree finds.
struct Topology {
    stored: Stored,
    codec: Codec,
    background: f32,
    origins: Vec<[i32; 3]>,
    tiles: Vec<([i32; 3], u32, f32)>,
    active: [[i32; 3]; 2],
}

impl Topology {
    fn root(&mut self, cursor: &mut Cursor<'_>) -> Result<()> {
        let [tiles, children] = [cursor.u32()?, cursor.u32()?];
        for _ in 0..tiles {
            let origin = self.origin(cursor)?;
            let value = self.stored.value(cursor)?;
            let active = cursor.u8()? != 0;
            self.tile(origin, 2, value, active);
        }
        for _ in 0..children {
            let origin = self.origin(cursor)?;
            self.node(cursor, origin, 1)?;
        }
        Ok(())
    }

    fn origin(&self, cursor: &mut Cursor<'_>) -> Result<[i32; 3]> {
        let at = cursor.at();
        let origin = cursor.origin()?;
        if origin.iter().any(|v| v % EDGE[2] != 0 || !(-FARTHEST..FARTHEST).contains(v)) {
            let expected = format!("a node at multiples of {} voxels, less than {FARTHEST} away", EDGE[2]);
            return Err(cursor.bad(at, expected, format!("{origin:?}")));
        }
        Ok(origin)
    }

    /// A node whose children have `EDGE[level]` voxels along an edge: masks, tiles, then its children.
    fn node(&mut self, cursor: &mut Cursor<'_>, origin: [i32; 3], level: usize) -> Result<()> {
        let log2 = CHILDREN[level];
        let count = 1 << (3 * log2);
        let (children, active) = (cursor.mask(count)?, cursor.mask(count)?);
        let values = values::read(cursor, count, active, self.background, self.stored, self.codec)?;
        let place = |i: usize| {
            let axis = |shift: u32| ((i >> shift) as i32 & ((1 << log2) - 1)) * EDGE[level];
            [origin[0] + axis(2 * log2), origin[1] + axis(log2), origin[2] + axis(0)]
        };
        for (i, value) in values.iter().enumerate() {
            if !children.has(i) {
                self.tile(place(i), level, *value, active.has(i));
            }
        }
        for i in (0..count).filter(|&i| children.has(i)) {
            if level == 0 {
                let mask = cursor.mask(512)?;
                self.leaf(place(i), mask);
            } else {
                self.node(cursor, place(i), level - 1)?;
            }
        }
        Ok(())
    }

    fn leaf(&mut self, origin: [i32; 3], mask: Mask<'_>) {
        self.origins.push(origin);
        for i in (0..512).filter(|&i| mask.has(i)) {
            let voxel =
                [origin[0] + (i >> 6) as i32, origin[1] + (i >> 3 & 7) as i32, origin[2] + (i & 7) as i32];
            self.holds(voxel, 1);
        }
    }

    fn tile(&mut self, origin: [i32; 3], level: usize, value: f32, active: bool) {
        if active {
            self.holds(origin, EDGE[level]);
        }
        if value != self.background {
            self.tiles.push((origin, EDGE[level] as u32, value));
        }
    }

    fn holds(&mut self, first: [i32; 3], edge: i32) {
        let [low, high] = &mut self.active;
        for k in 0..3 {
            low[k] = low[k].min(first[k]);
            high[k] = high[k].max(first[k] + edge - 1);
        }
    }
}
