//! Rays side by side, eight to a group: what one ray's walk computes, for all of them in step, and the shaft around them.
//!
//! **The shaft** holds every ray. A ray enters a box where the greatest of its `(p_k - o_k) r_k` over the near planes `p` and
//! axes k, and 0, is at most the least over the far ones and `t_max`, with the reciprocals of `slabs.rs`. With `o_k` and
//! `r_k` from intervals each product has its bounds at the intervals' ends; rounding is monotone, so the shaft enters each box that a ray of it
//! enters, to the last bit. Where the rays' directions differ in sign along an axis, the box has to overlap the hull of the
//! segments there. Source: Wald, Slusallek, Benthin & Wagner 2001 (groups of rays); Boulos, Wald & Shirley 2006, "Geometric
//! and arithmetic culling methods for entire ray packets".

use super::lanes::Lanes;
use super::node::{Block, Node};
use super::query::LocalRay;
use super::slabs::SLACK;
use super::triangle::{AXES, distance};
use crate::Ray;
use crate::dvec::{DVec3, dvec3};

/// Rays of a group.
pub(super) const GROUP: usize = 8;

/// Up to eight rays; lanes without a ray repeat the last.
#[derive(Clone, Copy)]
pub(super) struct Group<L: Lanes> {
    o: [L::F8; 3],
    d: [L::F8; 3],
    t_max: L::F8,
    /// `|d|_1`.
    size: L::F8,
    /// Reciprocals of the directions that arrive earliest and leave latest.
    near: [L::F8; 3],
    far: [L::F8; 3],
    /// By axis: the rays for which it is the longest, and the slopes of all against it.
    long: [u32; 3],
    slope: [[L::F8; 2]; 3],
}

impl<L: Lanes> Group<L> {
    /// The rays from number `first` on; `None` where numbers are so great or small that they might overflow.
    #[inline(always)]
    pub fn new(l: L, rays: &[Ray], first: usize) -> Option<Self> {
        let mut columns = [[0.0; GROUP]; 7];
        for i in 0..GROUP {
            let Ray { o, d, t_max, .. } = &rays[(first + i).min(rays.len() - 1)];
            let row = [o.x, o.y, o.z, d.x, d.y, d.z, *t_max];
            for k in 0..7 {
                columns[k][i] = row[k];
            }
        }
        let c = |k: usize| l.load8(&columns[k]);
        let (o, d, t_max) = ([c(0), c(1), c(2)], [c(3), c(4), c(5)], c(6));
        let a = [l.abs8(d[0]), l.abs8(d[1]), l.abs8(d[2])];
        let size = l.add8(l.add8(a[0], a[1]), a[2]);
        let within = |lo: f32, x: L::F8, hi: f32| l.le8(l.splat8(lo), x) & l.le8(x, l.splat8(hi));
        let farthest = l.max8(l.abs8(o[0]), l.max8(l.abs8(o[1]), l.abs8(o[2])));
        // NaN fails each comparison, but may hide in the maximum
        let origin = within(-1e18, o[0], 1e18) & within(-1e18, o[1], 1e18) & within(0.0, farthest, 1e18);
        if within(0.5, size, 4.0) & within(1e-18, t_max, 1e18) & origin != 0xff {
            return None;
        }
        let (near, far) = reciprocals(l, d, a, size);
        let (long, slope) = slopes(l, d, a);
        Some(Self { o, d, t_max, size, near, far, long, slope })
    }

    /// Where the rays start.
    #[inline(always)]
    pub fn starts(&self) -> [L::F8; 3] {
        self.o
    }

    /// Where the rays end, rounded.
    #[inline(always)]
    pub fn ends(&self, l: L) -> [L::F8; 3] {
        let end = |k: usize| l.add8(self.o[k], l.mul8(self.d[k], self.t_max));
        [end(0), end(1), end(2)]
    }

    /// The rays that enter the box in `slot`.
    #[inline(always)]
    pub fn enters(&self, l: L, node: &Node, slot: usize) -> u32 {
        let slot = slot & (GROUP - 1);
        let (mut near, mut far) = (l.splat8(0.0), self.t_max);
        for k in 0..3 {
            let (lo, hi) = (l.splat8(node.planes[2 * k][slot]), l.splat8(node.planes[2 * k + 1][slot]));
            let d = self.d[k];
            let (first, last) = (l.blend8(d, lo, hi), l.blend8(d, hi, lo));
            near = l.max8(near, l.mul8(l.sub8(first, self.o[k]), self.near[k]));
            far = l.min8(far, l.mul8(l.sub8(last, self.o[k]), self.far[k]));
        }
        l.le8(near, far)
    }

    /// Those of `rays` whose line passes through triangle `i`: the operations of `Shear::test`.
    #[inline(always)]
    pub fn passes(&self, l: L, block: &Block, i: usize, rays: u32) -> u32 {
        let [x, y, z] = [rays & self.long[0], rays & self.long[1], rays & self.long[2]];
        let mut passed = 0;
        if x != 0 {
            passed |= x & self.side::<0>(l, block, i);
        }
        if y != 0 {
            passed |= y & self.side::<1>(l, block, i);
        }
        if z != 0 {
            passed |= z & self.side::<2>(l, block, i);
        }
        passed
    }

    /// The edge test with `LONG` as the longest axis.
    #[inline(always)]
    fn side<const LONG: usize>(&self, l: L, block: &Block, i: usize) -> u32 {
        let a = self.corner::<LONG>(l, block, i, 0);
        let b = self.corner::<LONG>(l, block, i, 1);
        let c = self.corner::<LONG>(l, block, i, 2);
        let side = |p: [L::F8; 2], q: [L::F8; 2]| l.sub8(l.mul8(p[0], q[1]), l.mul8(p[1], q[0]));
        let (u, v, w) = (side(c, a), side(a, b), side(b, c));
        let zero = l.splat8(0.0);
        let front = l.le8(zero, l.min8(u, l.min8(v, w)));
        let back = l.le8(l.max8(u, l.max8(v, w)), zero);
        front | back
    }

    /// Corner `k` as the rays see it: they pass through (0, 0).
    #[inline(always)]
    fn corner<const LONG: usize>(&self, l: L, block: &Block, i: usize, k: usize) -> [L::F8; 2] {
        // no closures here: they are too long to be inlined
        let ([x, y, z], slope, corner) = (AXES[LONG], &self.slope[LONG], &block.corner[k]);
        let z = l.sub8(l.splat8(corner[z][i]), self.o[z]);
        let x = l.sub8(l.splat8(corner[x][i]), self.o[x]);
        let y = l.sub8(l.splat8(corner[y][i]), self.o[y]);
        [l.fnmadd8(slope[0], z, x), l.fnmadd8(slope[1], z, y)]
    }

    /// Those of `rays` that meet `plane` before their end, and among all those whose angle with it is too small to tell:
    /// the operations of `distance`.
    #[inline(always)]
    pub fn reaches(&self, l: L, plane: &Plane, rays: u32) -> (u32, u32) {
        let (mut met, mut grazing) = (0, 0);
        if rays & 0xf != 0 {
            (met, grazing) = self.before_end(l, false, plane);
        }
        if rays & 0xf0 != 0 {
            let (m, g) = self.before_end(l, true, plane);
            (met, grazing) = (met | m << 4, grazing | g << 4);
        }
        (met & rays & !grazing, grazing & rays)
    }

    /// Four rays: who meets the plane before the end, and whose angle is too small to tell.
    #[inline(always)]
    fn before_end(&self, l: L, half: bool, plane: &Plane) -> (u32, u32) {
        let wide = |x: L::F8| l.widen4(l.half8(x, half));
        let (a, n) = (plane.a.to_array(), plane.n.to_array());
        let n = [l.splat4d(n[0]), l.splat4d(n[1]), l.splat4d(n[2])];
        let sum = |x: [L::D4; 3]| l.add4d(l.add4d(x[0], x[1]), x[2]);
        let p = |k: usize| l.mul4d(n[k], wide(self.d[k]));
        let along = [p(0), p(1), p(2)];
        let h = |k: usize| l.mul4d(n[k], l.sub4d(l.splat4d(a[k]), wide(self.o[k])));
        let (facing, height) = (sum(along), sum([h(0), h(1), h(2)]));
        let magnitude = sum([l.abs4d(along[0]), l.abs4d(along[1]), l.abs4d(along[2])]);
        let t = l.div4d(height, facing);
        let met = l.lt4d(l.splat4d(0.0), t) & l.le4d(t, wide(self.t_max));
        (met, l.le4d(l.abs4d(facing), l.mul4d(magnitude, l.splat4d(1.0 / 1024.0))))
    }
}

/// The plane of a triangle: a corner and the normal as `distance` works it out.
pub(super) struct Plane {
    a: DVec3,
    n: DVec3,
}

impl Plane {
    /// That of triangle `i`.
    #[inline(always)]
    pub fn new(block: &Block, i: usize) -> Self {
        let corner = |k: usize| {
            let x = |j: usize| f64::from(block.corner[k][j][i]);
            dvec3(x(0), x(1), x(2))
        };
        let a = corner(0);
        Self { a, n: (corner(1) - a).cross(corner(2) - a) }
    }
}

/// Whether one ray that nearly runs within triangle `i`'s plane meets it.
#[cold]
#[inline(never)]
pub(super) fn grazes(block: &Block, i: usize, ray: &Ray) -> bool {
    distance(block, i, &LocalRay::new(ray)).is_some_and(|t| t > 0.0 && t <= f64::from(ray.t_max))
}

/// `Slabs::near` and `far`.
#[inline(always)]
fn reciprocals<L: Lanes>(l: L, d: [L::F8; 3], a: [L::F8; 3], size: L::F8) -> ([L::F8; 3], [L::F8; 3]) {
    let (drift, least) = (l.mul8(size, l.splat8(SLACK)), l.mul8(size, l.splat8(1e-18)));
    let one = |k: usize, x: L::F8| l.copysign8(l.div8(l.splat8(1.0), x), d[k]);
    let near = |k: usize| one(k, l.add8(a[k], drift));
    let far = |k: usize| one(k, l.max8(l.sub8(a[k], drift), least));
    ([near(0), near(1), near(2)], [far(0), far(1), far(2)])
}

/// Which axis is longest for whom, and the slopes against those that occur.
#[inline(always)]
fn slopes<L: Lanes>(l: L, d: [L::F8; 3], a: [L::F8; 3]) -> ([u32; 3], [[L::F8; 2]; 3]) {
    let x = !l.le8(a[0], a[1]) & !l.le8(a[0], a[2]) & 0xff;
    let y = !x & !l.le8(a[1], a[2]) & 0xff;
    let long = [x, y, !x & !y & 0xff];
    let mut slope = [[l.splat8(0.0); 2]; 3];
    for k in 0..3 {
        if long[k] != 0 {
            let axis = AXES[k];
            slope[k] = [l.div8(d[axis[0]], d[axis[2]]), l.div8(d[axis[1]], d[axis[2]])];
        }
    }
    (long, slope)
}

/// One axis of a shaft.
#[derive(Clone, Copy)]
struct Side<L: Lanes> {
    /// Index within the axis of the near plane.
    behind: usize,
    /// Whether the directions differ in sign.
    mixed: bool,
    /// The origin against which the near plane is nearest and that against which the far plane is farthest; where the
    /// signs are mixed, the hull's high and low end.
    o: [L::F8; 2],
    /// Reciprocals of the directions: the least and the greatest.
    r: [L::F8; 2],
}

/// What holds every ray of some groups.
pub(super) struct Shaft<L: Lanes> {
    side: [Side<L>; 3],
    t_max: L::F8,
}

impl<L: Lanes> Shaft<L> {
    /// Around two groups (the same twice will do).
    #[inline(always)]
    pub fn new(l: L, [g, h]: [&Group<L>; 2]) -> Self {
        let reach = |g: &Group<L>| l.mul8(g.size, g.t_max);
        let reach = l.range8(l.max8(reach(g), reach(h))).1;
        let side = |k: usize| Side::new(l, [g, h], k, reach);
        let t_max = l.splat8(l.range8(l.max8(g.t_max, h.t_max)).1);
        Self { side: [side(0), side(1), side(2)], t_max }
    }

    /// Entry distances, and which boxes are entered before the end.
    #[inline(always)]
    pub fn test(&self, l: L, node: &Node) -> (L::F8, u32) {
        let (mut near, mut far, mut mask) = (l.splat8(0.0), self.t_max, 0xff);
        for k in 0..3 {
            let side = &self.side[k];
            let plane = |flip: usize| l.load8(&node.planes[2 * k + ((side.behind ^ flip) & 1)]);
            if side.mixed {
                mask &= l.le8(plane(0), side.o[0]) & l.le8(side.o[1], plane(1));
                continue;
            }
            let x = |flip: usize| l.sub8(plane(flip), side.o[flip]);
            let (x, y) = (x(0), x(1));
            near = l.max8(near, l.min8(l.mul8(x, side.r[0]), l.mul8(x, side.r[1])));
            far = l.min8(far, l.max8(l.mul8(y, side.r[0]), l.mul8(y, side.r[1])));
        }
        (near, mask & l.le8(near, far))
    }
}

impl<L: Lanes> Side<L> {
    #[inline(always)]
    fn new(l: L, [g, h]: [&Group<L>; 2], k: usize, reach: f32) -> Self {
        let range = |a: L::F8, b: L::F8| (l.range8(l.min8(a, b)).0, l.range8(l.max8(a, b)).1);
        let signs = l.signs8(g.d[k]) | (l.signs8(h.d[k]) << GROUP);
        let (lo, hi) = range(g.o[k], h.o[k]);
        if signs != 0 && signs != 0xffff {
            let end = |g: &Group<L>| l.add8(g.o[k], l.mul8(g.d[k], g.t_max));
            let (end_lo, end_hi) = range(end(g), end(h));
            let (lo, hi) = (lo.min(end_lo), hi.max(end_hi));
            // the drift of the directions, `SLACK * reach`, and a few roundings
            let pad = 2.0 * SLACK * (reach + lo.abs().max(hi.abs()));
            let o = [l.splat8(hi + pad), l.splat8(lo - pad)];
            return Self { behind: 0, mixed: true, o, r: [l.splat8(0.0); 2] };
        }
        let (near, far) = (range(g.near[k], h.near[k]), range(g.far[k], h.far[k]));
        let r = [l.splat8(near.0.min(far.0)), l.splat8(near.1.max(far.1))];
        let behind = usize::from(signs != 0);
        let o = if behind == 0 { [hi, lo] } else { [lo, hi] };
        Self { behind, mixed: false, o: [l.splat8(o[0]), l.splat8(o[1])], r }
    }
}
