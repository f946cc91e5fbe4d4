//! Four triangles at a time: who is passed through, in `f32`, and how far away that is, in `f64`.
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
use super::node::{Block, LANES};
use super::query::{LocalRay, Query};
use super::slabs::SLACK;
use crate::Hit;
use crate::dvec::{DVec3, dvec3};

/// The axes that play x, y and z, by the one that plays z.
pub(super) const AXES: [[usize; 3]; 3] = [[1, 2, 0], [2, 0, 1], [0, 1, 2]];

/// The ray as the edge test wants it: its longest axis is z, and a shear lays it along that axis.
pub(super) struct Shear<L: Lanes> {
    /// The axes that play x, y and z.
    axis: [usize; 3],
    o: [L::F4; 3],
    /// `d.x / d.z`, `d.y / d.z`.
    slope: [L::F4; 2],
    /// `d.z`.
    along: f32,
}

impl<L: Lanes> Shear<L> {
    #[inline(always)]
    pub fn new(l: L, ray: &LocalRay) -> Self {
        let [x, y, z] = [ray.d[0].abs(), ray.d[1].abs(), ray.d[2].abs()];
        let long = if x > y && x > z {
            0
        } else if y > z {
            1
        } else {
            2
        };
        let axis = AXES[long];
        let along = ray.d[axis[2]];
        let slope = |k: usize| l.splat4(ray.d[axis[k]] / along);
        let o = |k: usize| l.splat4(ray.o[axis[k]]);
        Self { axis, o: [o(0), o(1), o(2)], slope: [slope(0), slope(1)], along }
    }

    /// Corner `k` of the four triangles, as the ray sees it: the ray passes through (0, 0).
    #[inline(always)]
    fn corner(&self, l: L, block: &Block, k: usize) -> [L::F4; 2] {
        // the axes are 0, 1, 2 by construction
        let x = |i: usize| l.sub4(l.load4(&block.corner[k][self.axis[i].min(2)]), self.o[i]);
        let z = x(2);
        [l.fnmadd4(self.slope[0], z, x(0)), l.fnmadd4(self.slope[1], z, x(1))]
    }

    /// Lanes whose triangle lies wholly behind the ray's origin or beyond `t_max`, as its corners tell by their places along the
    /// longest axis: no need to ask how far away it is.
    #[inline(always)]
    fn aside(&self, l: L, block: &Block, t_max: f32) -> u32 {
        let z = |k: usize| l.sub4(l.load4(&block.corner[k][self.axis[2].min(2)]), self.o[2]);
        let (a, b, c) = (z(0), z(1), z(2));
        let (least, greatest) = (l.min4(a, l.min4(b, c)), l.max4(a, l.max4(b, c)));
        // the signs of differences are exact; the end is widened by more than rounding
        let end = l.splat4(t_max * self.along * (1.0 + 1.0 / (1 << 20) as f32));
        if self.along > 0.0 {
            !l.le4(l.splat4(0.0), greatest) | !l.le4(least, end)
        } else {
            !l.le4(least, l.splat4(0.0)) | !l.le4(end, greatest)
        }
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

/// Offers the query every triangle of `blocks` that the ray meets.
#[inline(always)]
pub(super) fn triangles<L: Lanes, const ANY: bool, F: FnMut(&Hit) -> bool>(
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
        // most of what the line of a shadow ray passes through lies behind it or beyond the light; nearest hits gain nothing
        if ANY {
            lanes &= !shear.aside(l, block, query.t_max());
            if lanes == 0 {
                continue;
            }
        }
        let (u, v, sum) = (l.store4(u), l.store4(v), l.store4(sum));
        while lanes != 0 {
            let i = lanes.trailing_zeros() as usize & (LANES - 1);
            lanes &= lanes - 1;
            // no `then`: closures given to it are not compiled for this instruction set
            if !query.candidate(block.mask[i]) {
                continue;
            }
            let Some(t) = distance(block, i, ray) else { continue };
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

/// The corners of lane `i`.
#[inline(always)]
fn corners(block: &Block, i: usize) -> [DVec3; 3] {
    let corner = |k: usize| {
        let x = |j: usize| f64::from(block.corner[k][j][i]);
        dvec3(x(0), x(1), x(2))
    };
    [corner(0), corner(1), corner(2)]
}

/// The distance to lane `i`'s plane in `f64`; `None` where that is not in front.
#[inline(always)]
pub(super) fn distance(block: &Block, i: usize, ray: &LocalRay) -> Option<f64> {
    let [a, b, c] = corners(block, i);
    let n = (b - a).cross(c - a);
    let facing = n.dot(ray.d64);
    let height = n.dot(a - ray.o64);
    // most of those passed through lie behind, or are what the ray leaves: spare them the division
    if (height < 0.0) != (facing < 0.0) || height == 0.0 {
        return None;
    }
    let t = height / facing;
    let magnitude = (n.x * ray.d64.x).abs() + (n.y * ray.d64.y).abs() + (n.z * ray.d64.z).abs();
    // where the ray nearly runs within the plane it may meet that far from the triangle it passed through
    if facing.abs() <= magnitude * (1.0 / 1024.0) { at_triangle(t, block, i, ray) } else { Some(t) }
}

/// `t` moved to where the ray is in the triangle's box, up to the error of the edge test. A hit in front stays one, so
/// a ray cannot leave a closed mesh here; one behind stays behind, so a ray that leaves a surface is not caught by it.
#[cold]
#[inline(never)]
fn at_triangle(t: f64, block: &Block, i: usize, ray: &LocalRay) -> Option<f64> {
    let [a, b, c] = corners(block, i);
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

#[cfg(test)]
mod tests {
    use super::super::lanes::Portable;
    use super::*;
    use crate::Ray;
    use tyndall_base::{Vec3, vec::vec3};
    use tyndall_testkit::Rng;

    /// Triangles and rays whose coordinates are few whole numbers, so that corners lie level with origins and ends, and others.
    #[test]
    fn no_triangle_is_put_aside_that_the_ray_meets() {
        let mut rng = Rng::new(5);
        let (mut aside, mut met) = (0, 0);
        for round in 0..20_000 {
            let mut number = || {
                let x = 6.0 * rng.f32() - 3.0;
                if round % 2 == 0 { x.round() } else { x }
            };
            let mut point = || vec3(number(), number(), number());
            let mut block = Block::EMPTY;
            for lane in 0..LANES {
                for k in 0..3 {
                    let p = point().to_array();
                    (0..3).for_each(|axis| block.corner[k][axis][lane] = p[axis]);
                }
            }
            let (o, d) = (point(), point());
            let t_max = [0.5, 1.0, 2.0, f32::INFINITY][round % 4];
            if d == Vec3::ZERO {
                continue;
            }
            let ray = LocalRay::new(&Ray { t_max, ..Ray::new(o, d) });
            let shear = Shear::new(Portable, &ray);
            let (through, out) = (shear.test(Portable, &block).0, shear.aside(Portable, &block, t_max));
            for lane in (0..LANES).filter(|lane| through >> lane & 1 == 1) {
                let meets = distance(&block, lane, &ray).is_some_and(|t| t > 0.0 && t <= f64::from(t_max));
                assert!(!(meets && out >> lane & 1 == 1), "lane {lane} of {block:?} and {o:?} {d:?}");
                met += u32::from(meets);
                aside += out >> lane & 1;
            }
        }
        assert!(met > 1000 && aside > 1000, "{met} {aside}");
    }
}
