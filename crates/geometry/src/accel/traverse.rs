//! The walk through one level of the tree, generic over the instruction set.
//!
//! Boxes are conservative (`slabs.rs`): what is met does not depend on them.

use super::lanes::Lanes;
use super::node::{Block, Bvh, Child, Node, STACK, WIDTH};
use super::query::{Kernel, LocalRay, Query, others};
use super::slabs::Slabs;
use super::triangle::{Shear, triangles};
use crate::{Hit, NO_INSTANCE};
use std::mem::MaybeUninit;

/// Children yet to visit, nearest on top: entry distance in the high half (non-negative floats order like their bits).
///
/// It borrows its room: a room within, beside the constant length, would be cleared for every ray.
pub(super) struct Stack<'a> {
    pub entries: &'a mut MaybeUninit<[u64; STACK]>,
    pub len: usize,
}

impl Stack<'_> {
    #[inline(always)]
    pub fn push(&mut self, key: u64) {
        debug_assert!(self.len < STACK);
        // SAFETY: an inner node leaves at most WIDTH - 1 entries behind and the builder admits at most MAX_DEPTH
        // levels, so there are never more than STACK.
        unsafe { self.entries.as_mut_ptr().cast::<u64>().add(self.len).write(key) };
        self.len += 1;
    }

    #[inline(always)]
    pub fn pop(&mut self) -> Option<u64> {
        if self.len == 0 {
            return None;
        }
        self.len -= 1;
        // SAFETY: entries below the old length were written by `push`.
        Some(unsafe { self.entries.as_ptr().cast::<u64>().add(self.len).read() })
    }

    /// Sorts the entries from `low` on, farthest first.
    #[inline(always)]
    pub fn sort_from(&mut self, low: usize) {
        // SAFETY: as for `pop`: everything below `len` has been written.
        let top: &mut [u64] = unsafe {
            std::slice::from_raw_parts_mut(self.entries.as_mut_ptr().cast::<u64>().add(low), self.len - low)
        };
        for i in 1..top.len() {
            let key = top[i];
            let mut k = i;
            while k > 0 && top[k - 1] < key {
                top[k] = top[k - 1];
                k -= 1;
            }
            top[k] = key;
        }
    }
}

/// Visits `bvh` from the node `from` on; in `ANY` mode returns at the first accepted hit, else leaves the nearest in `query`.
#[inline(always)]
pub(crate) fn walk<L: Kernel, const ANY: bool, F: FnMut(&Hit) -> bool>(
    l: L,
    bvh: &Bvh,
    from: Child,
    ray: &LocalRay,
    query: &mut Query<'_, F>,
    instance: u32,
) -> bool {
    let (nodes, blocks): (&[Node], &[Block]) = (&bvh.nodes, &bvh.blocks);
    let slabs = Slabs::new(l, ray);
    let shear = Shear::new(l, ray);
    let mut room = MaybeUninit::uninit();
    let mut stack = Stack { entries: &mut room, len: 0 };
    let mut t_max = l.splat8(query.t_max());
    let mut found = false;
    let mut current = from;
    loop {
        if !current.is_leaf() {
            // SAFETY: the builder writes only indices of nodes that exist, and empty slots have empty boxes.
            let node = unsafe { nodes.get_unchecked(current.0 as usize) };
            let (near, mask) = slabs.test(l, node, t_max);
            let mask = mask & query.slots(node);
            if mask != 0 {
                current = descend::<L, ANY>(l, nodes, blocks, node, near, mask, &mut stack);
                continue;
            }
        } else {
            let (first, n) = current.range();
            let hit = if current.is_other() {
                others::<L, ANY, F>(l, bvh, first..first + n, ray, query, instance)
            } else {
                // SAFETY: leaves name ranges of blocks that exist.
                let blocks = unsafe { blocks.get_unchecked(first..first + n) };
                triangles::<L, ANY, F>(l, blocks, ray, &shear, query, instance)
            };
            if hit {
                if ANY {
                    return true;
                }
                found = true;
                t_max = l.splat8(query.t_max());
            }
        }
        loop {
            let Some(key) = stack.pop() else { return found };
            if f32::from_bits((key >> 32) as u32) <= query.t_max() {
                current = Child(key as u32);
                break;
            }
        }
    }
}

/// Chooses the nearest of the children hit and pushes the others.
#[inline(always)]
fn descend<L: Lanes, const ANY: bool>(
    l: L,
    nodes: &[Node],
    blocks: &[Block],
    node: &Node,
    near: L::F8,
    mut mask: u32,
    stack: &mut Stack<'_>,
) -> Child {
    let mut next = || {
        let i = mask.trailing_zeros() as usize & (WIDTH - 1);
        mask &= mask - 1;
        (i, mask == 0)
    };
    let (i0, last) = next();
    if last {
        return node.child[i0];
    }
    let near = l.store8(near);
    let key = |i: usize| {
        prefetch(l, nodes, blocks, node.child[i]);
        (u64::from(near[i].to_bits()) << 32) | u64::from(node.child[i].0)
    };
    let (i1, last) = next();
    let (k0, k1) = (key(i0), key(i1));
    let (a, b) = (k0.max(k1), k0.min(k1));
    if last {
        stack.push(a);
        return Child(b as u32);
    }
    let (i2, last) = next();
    let k2 = key(i2);
    let (b, c) = (b.max(k2), b.min(k2));
    let (a, b) = (a.max(b), a.min(b));
    let low = stack.len;
    stack.push(a);
    stack.push(b);
    if last {
        return Child(c as u32);
    }
    stack.push(c);
    loop {
        let (i, last) = next();
        stack.push(key(i));
        if last {
            break;
        }
    }
    // any hit ends a shadow ray: its order matters little
    if !ANY {
        stack.sort_from(low);
    }
    Child(stack.pop().map_or(u32::MAX, |k| k as u32))
}

/// Asks for the child's cache lines: four of a node, three of a block.
#[inline(always)]
pub(super) fn prefetch<L: Lanes>(l: L, nodes: &[Node], blocks: &[Block], child: Child) {
    let (start, lines) = if child.is_leaf() {
        (blocks.as_ptr().wrapping_add(child.range().0).cast::<[u8; 64]>(), 3)
    } else {
        (nodes.as_ptr().wrapping_add(child.0 as usize).cast::<[u8; 64]>(), 4)
    };
    for k in 0..lines {
        l.prefetch(start.wrapping_add(k));
    }
}

/// What a hit outside every instance carries.
pub(crate) const WORLD: u32 = NO_INSTANCE;
