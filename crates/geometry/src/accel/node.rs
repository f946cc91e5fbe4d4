//! The tree's memory layout: 8-wide nodes of four cache lines, blocks of four triangles of three.

use super::store::Store;
use crate::Bounds3;
use bytemuck::{Pod, Zeroable};

/// Children of a node.
pub(crate) const WIDTH: usize = 8;
/// Triangles of a block.
pub(crate) const LANES: usize = 4;
/// Blocks or other primitives of one leaf, at most.
pub(crate) const LEAF_MAX: usize = 8;
/// Levels of inner nodes, at most; the builder balances by count before this could be reached.
pub(crate) const MAX_DEPTH: usize = 48;
/// A traversal leaves at most seven siblings behind on each level.
pub(crate) const STACK: usize = MAX_DEPTH * (WIDTH - 1) + 1;

/// Where a child slot leads: an inner node (its index), or a leaf.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(transparent)]
pub(crate) struct Child(pub u32);

impl Child {
    const LEAF: u32 = 1 << 31;
    const OTHER: u32 = 1 << 30;
    /// The node that a level begins with.
    pub const ROOT: Self = Self(0);
    /// No child; its box is empty, so a traversal never follows it.
    pub const NONE: Self = Self(u32::MAX);
    /// Indices that fit beside the two flags and the count.
    pub const INDEX_LIMIT: usize = 1 << 27;

    /// `n` blocks of triangles from `first`.
    pub fn triangles(first: usize, n: usize) -> Self {
        Self(Self::LEAF | ((first as u32) << 3) | (n as u32 - 1))
    }

    /// `n` other primitives from `first`.
    pub fn others(first: usize, n: usize) -> Self {
        Self(Self::LEAF | Self::OTHER | ((first as u32) << 3) | (n as u32 - 1))
    }

    #[inline(always)]
    pub fn is_leaf(self) -> bool {
        self.0 & Self::LEAF != 0
    }

    #[inline(always)]
    pub fn is_other(self) -> bool {
        self.0 & Self::OTHER != 0
    }

    /// First entry and count of a leaf.
    #[inline(always)]
    pub fn range(self) -> (usize, usize) {
        (((self.0 & !(Self::LEAF | Self::OTHER)) >> 3) as usize, (self.0 & 7) as usize + 1)
    }
}

/// Boxes of eight children in `f32`, by plane: low x, high x, low y, high y, low z, high z.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C, align(64))]
pub(crate) struct Node {
    pub planes: [[f32; WIDTH]; 6],
    pub child: [Child; WIDTH],
    /// By bit of the visibility masks: the slots that lead to a primitive with that bit.
    pub slots_with: [u32; WIDTH],
}

impl Node {
    pub const EMPTY: Self = Self {
        planes: {
            const LO: [f32; WIDTH] = [f32::INFINITY; WIDTH];
            const HI: [f32; WIDTH] = [f32::NEG_INFINITY; WIDTH];
            [LO, HI, LO, HI, LO, HI]
        },
        child: [Child::NONE; WIDTH],
        slots_with: [0; WIDTH],
    };

    /// Fills a slot with a child whose primitives have the bits `mask` among them.
    pub fn set(&mut self, slot: usize, b: Bounds3, child: Child, mask: u8) {
        for k in 0..3 {
            self.planes[2 * k][slot] = b.lo[k];
            self.planes[2 * k + 1][slot] = b.hi[k];
        }
        self.child[slot] = child;
        for (bit, slots) in self.slots_with.iter_mut().enumerate() {
            *slots |= u32::from(mask >> bit & 1) << slot;
        }
    }
}

/// Four triangles: coordinates by corner, axis and lane, and whose they are.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C, align(64))]
pub(crate) struct Block {
    pub corner: [[[f32; LANES]; 3]; 3],
    pub prim: [u32; LANES],
    pub shape: [u32; LANES],
    /// Visibility mask in the low byte (0: the lane is empty), [`Block::SECOND_HALF`] above.
    pub mask: [u32; LANES],
}

impl Block {
    /// The lane is the half p11, p01, p10 of a flat patch.
    pub const SECOND_HALF: u32 = 1 << 8;
    pub const EMPTY: Self =
        Self { corner: [[[0.0; LANES]; 3]; 3], prim: [0; LANES], shape: [0; LANES], mask: [0; LANES] };
}

/// A primitive that is not a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Other {
    /// Primitive `prim` of a shape group.
    Shape { shape: u32, prim: u32, mask: u8 },
    /// An instance.
    Instance(u32),
}

/// One level: nodes from the root at 0, and what the leaves refer to.
#[derive(Debug)]
pub(crate) struct Bvh {
    pub nodes: Store<Node>,
    pub blocks: Store<Block>,
    pub others: Vec<Other>,
    pub bounds: Bounds3,
}
