//! The walk through one level of the tree, generic over the instruction set.
//!
//! **No hit is lost at shared edges and corners** (Woop, Benthin & Wald 2013, "Watertight Ray/Triangle Intersection").
//! Corners are sheared so that the ray is the z axis; a corner's rounded image is the same for all triangles that share
//! it. The side on which the ray passes an edge is the sign of a difference of two products, each rounded once: that
//! sign is right or zero, and zero counts as inside, so the images cover the ray as exactly as the rounded corners do.
//! A corner's image is off by at most `5 * 2^-24 (t + L)`, with `t` the distance and `L` the triangle's extent; boxes
//! are wider by `2^-20 L` when built and by `2^-20 t` during the walk (as a drift of the direction), so a triangle that
//! the edge test would accept is never culled.
//!
//! **The distance is exact to `f64`.** Whoever passes the edge test has its `t` worked out in double precision from
//! the `f32` corners, so two surfaces a millimetre apart are met in the right order from kilometres away.

use super::lanes::Lanes;
use super::node::{Block, Bvh, Child, LANES, Node, STACK, WIDTH};
use super::query::{Kernel, LocalRay, Query, others};
use crate::dvec::{DVec3, dvec3};
use crate::{Hit, NO_INSTANCE};
use std::mem::MaybeUninit;

/// Widening of boxes, relative to distance and size: 16 half-ulps.
pub(crate) const SLACK: f32 = 16.0 / (1u32 << 24) as f32;

/// The ray as the box test wants it.
struct Slabs<L: Lanes> {
    /// Index into `Node::planes` of the near plane per axis.
    near_plane: [usize; 3],
    o: [L::F8; 3],
    /// Reciprocals of the directions that arrive earliest and leave latest.
    near: [L::F8; 3],
    far: [L::F8; 3],
}

impl<L: Lanes> Slabs<L> {
    #[inline(always)]
    fn new(l: L, ray: &LocalRay) -> Self {
        let size = ray.d[0].abs() + ray.d[1].abs() + ray.d[2].abs();
        let (drift, least) = (size * SLACK, size * 1e-18);
        let axis = |k: usize| {
            let d = ray.d[k].abs();
            // the far reciprocal is finite even across the axis: 1e18 / size times any coordinate fits an f32
            let slow = if d - drift > least { d - drift } else { least };
            let (near, far) = (1.0 / (d + drift), 1.0 / slow);
            if ray.d[k] < 0.0 { (-near, -far) } else { (near, far) }
        };
        let (x, y, z) = (axis(0), axis(1), axis(2));
        let behind = |k: usize| 2 * k + usize::from(ray.d[k] < 0.0);
        Self {
            near_plane: [behind(0), behind(1), behind(2)],
            o: ray.o.map(|o| l.splat8(o)),
            near: [l.splat8(x.0), l.splat8(y.0), l.splat8(z.0)],
            far: [l.splat8(x.1), l.splat8(y.1), l.splat8(z.1)],
        }
    }

    /// Entry distances, and which boxes are entered before `t_max`.
    #[inline(always)]
    fn test(&self, l: L, node: &Node, t_max: L::F8) -> (L::F8, u32) {
        // the indices are 0/1, 2/3, 4/5 by construction; the masks let the compiler see that they are in range
        let plane = |k: usize, flip: usize| l.load8(&node.planes[((self.near_plane[k] ^ flip) & 1) + 2 * k]);
        let t = |k: usize, flip: usize, r: L::F8| l.mul8(l.sub8(plane(k, flip), self.o[k]), r);
        let near = l.max8(t(0, 0, self.near[0]), l.max8(t(1, 0, self.near[1]), t(2, 0, self.near[2])));
        let far = l.min8(t(0, 1, self.far[0]), l.min8(t(1, 1, self.far[1]), t(2, 1, self.far[2])));
        let near = l.max8(near, l.splat8(0.0));
        (near, l.le8(near, l.min8(far, t_max)))
    }
}

/// Children yet to visit, nearest on top: entry distance in the high half (non-negative floats order like their bits).
///
/// It borrows its room: a room within, beside the constant length, would be cleared for every ray.
struct Stack<'a> {
    entries: &'a mut MaybeUninit<[u64; STACK]>,
    len: usize,
}

impl Stack<'_> {
    #[inline(always)]
    fn push(&mut self, key: u64) {
        debug_assert!(self.len < STACK);
        // SAFETY: an inner node leaves at most WIDTH - 1 entries behind and the builder admits at most MAX_DEPTH
        // levels, so there are never more than STACK.
        unsafe { self.entries.as_mut_ptr().cast::<u64>().add(self.len).write(key) };
        self.len += 1;
    }

    #[inline(always)]
    fn pop(&mut self) -> Option<u64> {
        if self.len == 0 {
            return None;
        }
        self.len -= 1;
        // SAFETY: entries below the old length were written by `push`.
        Some(unsafe { self.entries.as_ptr().cast::<u64>().add(self.len).read() })
    }

    /// Sorts the entries from `low` on, farthest first.
    #[inline(always)]
    fn sort_from(&mut self, low: usize) {
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

/// Visits `bvh`; in `ANY` mode returns at the first accepted hit, else leaves the nearest in `query`.
#[inline(always)]
pub(crate) fn walk<L: Kernel, const ANY: bool, F: FnMut(&Hit) -> bool>(
    l: L,
    bvh: &Bvh,
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
    let mut current = Child(0);
    loop {
        if !current.is_leaf() {
            // SAFETY: the builder writes only indices of nodes that exist, and empty slots have empty boxes.
            let node = unsafe { nodes.get_unchecked(current.0 as usize) };
            let (near, mask) = slabs.test(l, node, t_max);
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
fn prefetch<L: Lanes>(l: L, nodes: &[Node], blocks: &[Block], child: Child) {
    let (start, lines) = if child.is_leaf() {
        (blocks.as_ptr().wrapping_add(child.range().0).cast::<[u8; 64]>(), 3)
    } else {
        (nodes.as_ptr().wrapping_add(child.0 as usize).cast::<[u8; 64]>(), 4)
    };
    for k in 0..lines {
        l.prefetch(start.wrapping_add(k));
    }
}

/// The ray as the edge test wants it: its longest axis is z, and a shear lays it along that axis.
struct Shear<L: Lanes> {
    /// The axes that play x, y and z.
    axis: [usize; 3],
    o: [L::F4; 3],
    /// `d.x / d.z`, `d.y / d.z`.
    slope: [L::F4; 2],
}

impl<L: Lanes> Shear<L> {
    #[inline(always)]
    fn new(l: L, ray: &LocalRay) -> Self {
        let [x, y, z] = ray.d.map(f32::abs);
        let long = if x > y && x > z {
            0
        } else if y > z {
            1
        } else {
            2
        };
        let axis = [[1, 2, 0], [2, 0, 1], [0, 1, 2]][long];
        let along = ray.d[axis[2]];
        let slope = |k: usize| l.splat4(ray.d[axis[k]] / along);
        Self { axis, o: axis.map(|k| l.splat4(ray.o[k])), slope: [slope(0), slope(1)] }
    }

    /// Corner `k` of the four triangles, as the ray sees it: the ray passes through (0, 0).
    #[inline(always)]
    fn corner(&self, l: L, block: &Block, k: usize) -> [L::F4; 2] {
        // the axes are 0, 1, 2 by construction
        let x = |i: usize| l.sub4(l.load4(&block.corner[k][self.axis[i].min(2)]), self.o[i]);
        let z = x(2);
        [l.fnmadd4(self.slope[0], z, x(0)), l.fnmadd4(self.slope[1], z, x(1))]
    }

    /// Lanes whose triangle the line passes through, and the weights of the corners b and c with their common divisor.
    #[inline(always)]
    fn test(&self, l: L, block: &Block) -> (u32, L::F4, L::F4, L::F4) {
        let (a, b, c) = (self.corner(l, block, 0), self.corner(l, block, 1), self.corner(l, block, 2));
        // no fused multiply-add here: two rounded products compare like the exact ones or are equal
        let side = |p: [L::F4; 2], q: [L::F4; 2]| l.sub4(l.mul4(p[0], q[1]), l.mul4(p[1], q[0]));
        let (u, v, w) = (side(c, a), side(a, b), side(b, c));
        let zero = l.splat4(0.0);
        let front = l.le4(zero, l.min4(u, l.min4(v, w)));
        let back = l.le4(l.max4(u, l.max4(v, w)), zero);
        (front | back, u, v, l.add4(l.add4(u, v), w))
    }
}

#[inline(always)]
fn triangles<L: Lanes, const ANY: bool, F: FnMut(&Hit) -> bool>(
    l: L,
    blocks: &[Block],
    ray: &LocalRay,
    shear: &Shear<L>,
    query: &mut Query<'_, F>,
    instance: u32,
) -> bool {
    let mut found = false;
    for block in blocks {
        let (mut lanes, u, v, sum) = shear.test(l, block);
        if lanes == 0 {
            continue;
        }
        let (u, v, sum) = (l.store4(u), l.store4(v), l.store4(sum));
        while lanes != 0 {
            let i = lanes.trailing_zeros() as usize & (LANES - 1);
            lanes &= lanes - 1;
            let Some(t) = query.candidate(block.mask[i]).then(|| distance(block, i, ray)).flatten() else {
                continue;
            };
            let scale = 1.0 / sum[i];
            let (mut u, mut v) = (u[i] * scale, v[i] * scale);
            if block.mask[i] & Block::SECOND_HALF != 0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            let hit = Hit { t: t as f32, shape: block.shape[i], prim: block.prim[i], instance, u, v };
            if query.offer(t, hit) {
                if ANY {
                    return true;
                }
                found = true;
            }
        }
    }
    found
}

/// The distance to lane `i`'s plane in `f64`; `None` where the ray runs within it.
#[inline(always)]
fn distance(block: &Block, i: usize, ray: &LocalRay) -> Option<f64> {
    let corner = |k: usize| {
        let x = |j: usize| f64::from(block.corner[k][j][i]);
        dvec3(x(0), x(1), x(2))
    };
    let (a, b, c) = (corner(0), corner(1), corner(2));
    let n = (b - a).cross(c - a);
    let facing = n.dot(ray.d64);
    let t = n.dot(a - ray.o64) / facing;
    let magnitude = (n.x * ray.d64.x).abs() + (n.y * ray.d64.y).abs() + (n.z * ray.d64.z).abs();
    // where the ray nearly runs within the plane it may meet that far from the triangle it passed through
    if facing.abs() <= magnitude * (1.0 / 1024.0) { at_triangle(t, a, b, c, ray) } else { Some(t) }
}

/// `t` moved to where the ray is in the triangle's box, up to the error of the edge test. A hit in front stays one, so
/// a ray cannot leave a closed mesh here; one behind stays behind, so a ray that leaves a surface is not caught by it.
#[cold]
#[inline(never)]
fn at_triangle(t: f64, a: DVec3, b: DVec3, c: DVec3, ray: &LocalRay) -> Option<f64> {
    if !(t > 0.0) {
        return None;
    }
    let (lo, hi) = (a.min(b).min(c).to_array(), a.max(b).max(c).to_array());
    let (o, d) = (ray.o64.to_array(), ray.d64.to_array());
    let largest = |f: &dyn Fn(usize) -> f64| f(0).max(f(1)).max(f(2));
    let reach = largest(&|k| (lo[k] - o[k]).abs().max((hi[k] - o[k]).abs()));
    let pad = f64::from(SLACK) * (reach + largest(&|k| hi[k] - lo[k]));
    let (mut near, mut far) = (0.0f64, f64::INFINITY);
    for k in 0..3 {
        let (x0, x1) = ((lo[k] - pad - o[k]) / d[k], (hi[k] + pad - o[k]) / d[k]);
        // a NaN (0 / 0) cannot arise: the pad keeps the planes off the origin unless it is beyond them
        (near, far) = (near.max(x0.min(x1)), far.min(x0.max(x1)));
    }
    (near <= far).then(|| t.clamp(near, far))
}

/// What a hit outside every instance carries.
pub(crate) const WORLD: u32 = NO_INSTANCE;
