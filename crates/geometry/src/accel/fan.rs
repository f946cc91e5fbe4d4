//! A fan: up to sixteen rays, about to one point, that ask together whether anything is in their way.
//!
//! One walk for all. A node's boxes are tested against the shaft around the rays; those that it enters are tested by each
//! ray for itself, side by side, and so are the triangles of a leaf. Where fewer than [`LEAST`] rays enter a node they go on
//! alone. Triangles are tested by the same operations as alone, the tests of boxes leave out none that a ray meets
//! (`slabs.rs`), and the shaft enters whatever a ray of it enters, so each answer is that of the ray's own query.

use super::bundle::{GROUP, Group, Plane, Shaft, grazes};
use super::hull::Hull;
use super::lanes::Portable;
#[cfg(target_arch = "x86_64")]
use super::lanes_avx2::Avx2;
use super::node::{Block, Bvh, Child, LANES, Node};
use super::notes::Notes;
use super::query::{Kernel, LocalRay, Query, any};
use super::traverse::{Stack, WORLD, prefetch};
use super::triangle::distance;
use super::{Accel, Isa};
use crate::{Hit, Ray};
use std::mem::MaybeUninit;

/// What lies on the rays of a fan; bit i is for ray i.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fan {
    /// Rays on which a primitive lies that blocks.
    pub blocked: u16,
    /// Where primitives lie on each ray that were to be noted; complete only for rays that are not blocked.
    pub noted: [Notes; MOST],
}

impl Default for Fan {
    fn default() -> Self {
        Self { blocked: 0, noted: [Notes::NONE; MOST] }
    }
}

/// Most rays of a fan.
const MOST: usize = 2 * GROUP;
/// Fewer rays go alone.
const LEAST: usize = 3;
/// Multiply-add in software costs more than a shared walk saves.
const PORTABLE_PAYS: bool = cfg!(any(target_arch = "aarch64", target_feature = "fma"));

impl Accel {
    /// For each of up to 16 rays of one time: whether a group whose mask shares a bit with `mask_blocking` lies on it, as
    /// [`Accel::occluded_masked`] tells, and whether one with a bit of `mask_noted` does. It is much faster than single
    /// queries where the rays are near each other along their whole way, and their ends are finite.
    ///
    /// # Panics
    /// With more than 16 rays.
    #[inline]
    pub fn occluded_fan(&self, rays: &[Ray], mask_blocking: u8, mask_noted: u8) -> Fan {
        assert!(rays.len() <= MOST, "a fan has at most {MOST} rays, not {}", rays.len());
        let ask = Ask { accel: self, rays, blocking: mask_blocking, noted: mask_noted };
        let mut fan = Fan::default();
        let open = if rays.len() < LEAST {
            ask.all()
        } else {
            match self.isa {
                Isa::Portable if !PORTABLE_PAYS => ask.all(),
                Isa::Portable => walk_portable(&ask, &mut fan),
                #[cfg(target_arch = "x86_64")]
                // SAFETY: the value exists only where the processor has these instructions.
                Isa::Avx2(l) => unsafe { walk_avx2(l, &ask, &mut fan) },
                #[cfg(target_arch = "x86_64")]
                // SAFETY: as above.
                Isa::Avx512(l) => unsafe { walk_avx2(l.narrow(), &ask, &mut fan) },
            }
        };
        ask.alone(open, &mut fan);
        fan
    }
}

/// What a fan asks.
struct Ask<'a> {
    accel: &'a Accel,
    rays: &'a [Ray],
    blocking: u8,
    noted: u8,
}

impl Ask<'_> {
    /// The rays' bits.
    #[inline(always)]
    fn all(&self) -> u32 {
        (1 << self.rays.len()) - 1
    }

    /// Whether the hit blocks, and notes it in `fan` for ray `i` if it was to be noted.
    #[inline(always)]
    fn blocks(&self, hit: &Hit, i: usize, fan: &mut Fan) -> bool {
        let mask = self.accel.groups[hit.shape as usize].mask;
        if mask & self.noted != 0 {
            fan.noted[i].push(*hit);
        }
        mask & self.blocking != 0
    }

    /// Asks for each ray of `open` by itself.
    #[inline]
    fn alone(&self, mut open: u32, fan: &mut Fan) {
        while open != 0 {
            let i = open.trailing_zeros() as usize;
            open &= open - 1;
            let ray = &self.rays[i];
            let blocked = if self.noted == 0 {
                any(self.accel, ray, self.blocking, |_| true)
            } else {
                any(self.accel, ray, self.blocking | self.noted, |hit| self.blocks(hit, i, fan))
            };
            fan.blocked |= u16::from(blocked) << i;
        }
    }

    /// Slots of a node behind which something of interest may be.
    #[inline(always)]
    fn slots(&self, node: &Node) -> u32 {
        let (mut bits, mut slots) = (u32::from(self.blocking | self.noted), 0);
        while bits != 0 {
            slots |= node.slots_with[bits.trailing_zeros() as usize & 7];
            bits &= bits - 1;
        }
        slots
    }
}

#[inline(never)]
fn walk_portable(ask: &Ask<'_>, fan: &mut Fan) -> u32 {
    walk(Portable, ask, fan)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
#[inline(never)]
fn walk_avx2(l: Avx2<false>, ask: &Ask<'_>, fan: &mut Fan) -> u32 {
    walk(l, ask, fan)
}

/// Answers for all rays but those returned, which had better go alone.
#[inline(always)]
fn walk<L: Kernel>(l: L, ask: &Ask<'_>, fan: &mut Fan) -> u32 {
    let all = ask.all();
    let Some(g) = Group::new(l, ask.rays, 0) else { return all };
    let mut groups = [g, g];
    if ask.rays.len() > GROUP {
        let Some(h) = Group::new(l, ask.rays, GROUP) else { return all };
        groups[1] = h;
    }
    let shaft = Shaft::new(l, [&groups[0], &groups[1]]);
    let hull = Hull::new(l, [&groups[0], &groups[1]]);
    let bvh = &ask.accel.world;
    let (nodes, blocks): (&[Node], &[Block]) = (&bvh.nodes, &bvh.blocks);
    let mut room = MaybeUninit::uninit();
    let mut stack = Stack { entries: &mut room, len: 0 };
    let (mut current, mut active) = (Child::ROOT, all);
    loop {
        // SAFETY: the builder writes only indices of nodes that exist; leaves are not pushed.
        let node = unsafe { nodes.get_unchecked(current.0 as usize) };
        let (near, mask) = shaft.test(l, node);
        let mut mask = mask & ask.slots(node);
        if mask != 0 {
            let near = l.store8(near);
            let low = stack.len;
            while mask != 0 {
                let slot = mask.trailing_zeros() as usize & 7;
                mask &= mask - 1;
                let entering = entering(l, &groups, node, slot, active & !u32::from(fan.blocked));
                if entering == 0 {
                    continue;
                }
                let child = node.child[slot];
                if child.is_leaf() {
                    leaf(l, ask, &groups, &hull, bvh, child, entering, fan);
                    if u32::from(fan.blocked) == all {
                        return 0;
                    }
                } else {
                    prefetch(l, nodes, blocks, child);
                    stack.push(entry(near[slot], entering, child));
                }
            }
            stack.sort_from(low);
        }
        loop {
            let Some(key) = stack.pop() else { return 0 };
            current = Child(key as u32);
            active = (key >> 32) as u32 & 0xffff & !u32::from(fan.blocked);
            if active.count_ones() >= LEAST as u32 {
                break;
            }
            if active != 0 {
                alone_from(l, ask, bvh, current, active, fan);
            }
        }
    }
}

/// A node to visit: entry distance in its upper bits, the rays that enter it, its index.
#[inline(always)]
fn entry(near: f32, rays: u32, child: Child) -> u64 {
    (u64::from(near.to_bits() & 0xffff_0000) << 32) | (u64::from(rays) << 32) | u64::from(child.0)
}

/// Those of `rays` that enter the box in `slot`.
#[inline(always)]
fn entering<L: Kernel>(l: L, groups: &[Group<L>; 2], node: &Node, slot: usize, rays: u32) -> u32 {
    let mut entering = 0;
    for g in 0..2 {
        if rays >> (GROUP * g) & 0xff != 0 {
            entering |= groups[g].enters(l, node, slot) << (GROUP * g);
        }
    }
    entering & rays
}

/// Visits a leaf with the rays that enter its box.
#[expect(clippy::too_many_arguments, reason = "the state of a walk")]
#[inline(always)]
fn leaf<L: Kernel>(
    l: L,
    ask: &Ask<'_>,
    groups: &[Group<L>; 2],
    hull: &Hull<L>,
    bvh: &Bvh,
    child: Child,
    active: u32,
    fan: &mut Fan,
) {
    if child.is_other() {
        alone_from(l, ask, bvh, child, active, fan);
        return;
    }
    let (first, n) = child.range();
    // SAFETY: leaves name ranges of blocks that exist.
    for block in unsafe { bvh.blocks.get_unchecked(first..first + n) } {
        let mut crossed = hull.crosses(l, block);
        while crossed != 0 {
            let i = crossed.trailing_zeros() as usize & (LANES - 1);
            crossed &= crossed - 1;
            triangle(l, ask, groups, block, i, active, fan);
        }
    }
}

/// Tests the rays of `active` that are open yet against triangle `i`.
#[inline(always)]
fn triangle<L: Kernel>(
    l: L,
    ask: &Ask<'_>,
    groups: &[Group<L>; 2],
    block: &Block,
    i: usize,
    active: u32,
    fan: &mut Fan,
) {
    let mask = block.mask[i] as u8;
    let (blocks, notes) = (mask & ask.blocking != 0, mask & ask.noted != 0);
    if !(blocks || notes) {
        return;
    }
    let open = active & !u32::from(fan.blocked);
    let halves = [open & 0xff, open >> GROUP];
    let (p, q) = (groups[0].passes(l, block, i, halves[0]), groups[1].passes(l, block, i, halves[1]));
    if p | q == 0 {
        return;
    }
    let plane = Plane::new(block, i);
    let (p, q) = (groups[0].reaches(l, &plane, p), groups[1].reaches(l, &plane, q));
    let (mut met, mut grazing) = (p.0 | q.0 << GROUP, p.1 | q.1 << GROUP);
    while grazing != 0 {
        let ray = grazing.trailing_zeros();
        grazing &= grazing - 1;
        met |= u32::from(grazes(block, i, &ask.rays[ray as usize])) << ray;
    }
    if blocks {
        fan.blocked |= met as u16;
    }
    while notes && met != 0 {
        let ray = met.trailing_zeros() as usize & (MOST - 1);
        met &= met - 1;
        if let Some(t) = distance(block, i, &LocalRay::new(&ask.rays[ray])) {
            let (shape, prim) = (block.shape[i], block.prim[i]);
            fan.noted[ray].push(Hit { t: t as f32, shape, prim, instance: WORLD, u: 0.0, v: 0.0 });
        }
    }
}

/// Visits what is below `from` with one ray of `open` after the other.
#[inline(never)]
fn alone_from<L: Kernel>(l: L, ask: &Ask<'_>, bvh: &Bvh, from: Child, mut open: u32, fan: &mut Fan) {
    while open != 0 {
        let i = open.trailing_zeros() as usize;
        open &= open - 1;
        let ray = &ask.rays[i];
        let local = LocalRay::new(ray);
        let blocked = if ask.noted == 0 {
            let mut query = Query::new(ask.accel, ray, ask.blocking, |_: &Hit| true);
            l.level::<true, _>(bvh, from, &local, &mut query, WORLD)
        } else {
            let mask = ask.blocking | ask.noted;
            let mut query = Query::new(ask.accel, ray, mask, |hit: &Hit| ask.blocks(hit, i, fan));
            l.level::<true, _>(bvh, from, &local, &mut query, WORLD)
        };
        fan.blocked |= u16::from(blocked) << i;
    }
}

#[cfg(test)]
mod tests;
