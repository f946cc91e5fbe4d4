//! Rays against the boxes of eight children.
//!
//! Boxes are conservative: they are wider by `2^-20` of a triangle's extent when built and by `2^-20 t` during the walk
//! (as a drift of the direction), which is more than the edge test in `triangle.rs` can be off; and by `2^-22` of the
//! origin's coordinates, for the rounding of their multiples.

use super::lanes::Lanes;
use super::node::{Node, WIDTH};
use super::query::LocalRay;

/// Widening of boxes, relative to distance and size: 16 half-ulps.
pub(crate) const SLACK: f32 = 16.0 / (1u32 << 24) as f32;
/// Widening of the origin's multiples, relative: four half-ulps, for a product and a sum in their making and, where there
/// is no fused multiply-add, the other product.
const BLUR: f32 = 4.0 / (1u32 << 24) as f32;
/// The origin's multiples are at most that, so that boxes of empty slots, which are infinite, are passed at infinity.
const HUGE: f32 = 1e38;

/// The ray as the box test wants it: it passes the plane at `p` across axis k at `p r_k - o_k r_k`, one instruction for eight.
pub(super) struct Slabs<L: Lanes> {
    /// Where the near plane of each axis begins among both of `Node::planes`: 0 or [`WIDTH`].
    near_plane: [usize; 3],
    /// By axis, `r` and `o r` with the reciprocals of the directions that arrive earliest and leave latest.
    near: [[L::F8; 2]; 3],
    far: [[L::F8; 2]; 3],
}

impl<L: Lanes> Slabs<L> {
    #[inline(always)]
    pub fn new(l: L, ray: &LocalRay) -> Self {
        let ([dx, dy, dz], [x, y, z]) = (ray.d, ray.o);
        let size = dx.abs() + dy.abs() + dz.abs();
        let drift = size * SLACK;
        // lanes 0 to 2 are for the near planes, 4 to 6 for the far ones: one division for all
        let both = |near: f32, far: f32| l.load8(&[near, near, near, near, far, far, far, far]);
        let d = l.load8(&[dx, dy, dz, 1.0, dx, dy, dz, 1.0]);
        let o = l.load8(&[x, y, z, 0.0, x, y, z, 0.0]);
        // the far reciprocal is finite even across the axis: 1e18 / size
        let least = l.splat8(size * 1e-18);
        let r = l.div8(l.splat8(1.0), l.max8(l.add8(l.abs8(d), both(drift, -drift)), least));
        let r = l.copysign8(r, d);
        let or = l.mul8(o, r);
        let or = l.add8(or, l.mul8(l.abs8(or), both(BLUR, -BLUR)));
        // NaN becomes a number
        let or = l.max8(l.min8(or, l.splat8(HUGE)), l.splat8(-HUGE));
        let (r, or) = (l.store8(r), l.store8(or));
        let axis = |k: usize| [l.splat8(r[k]), l.splat8(or[k])];
        let behind = |d: f32| (d.to_bits() >> 31) as usize * WIDTH;
        Self {
            near_plane: [behind(dx), behind(dy), behind(dz)],
            near: [axis(0), axis(1), axis(2)],
            far: [axis(4), axis(5), axis(6)],
        }
    }

    /// Entry distances, and which boxes are entered before `t_max`.
    #[inline(always)]
    pub fn test(&self, l: L, node: &Node, t_max: L::F8) -> (L::F8, u32) {
        let planes: &[f32; 6 * WIDTH] = bytemuck::cast_ref(&node.planes);
        let t = |k: usize, flip: usize, [r, or]: [L::F8; 2]| {
            // 0 or WIDTH by construction; the mask lets the compiler see that all is in range
            let from = 2 * WIDTH * k + ((self.near_plane[k] ^ flip) & WIDTH);
            let plane: &[f32; WIDTH] = planes[from..].first_chunk().expect("a row of planes");
            l.product_minus8(l.load8(plane), r, or)
        };
        let near = |k: usize| t(k, 0, self.near[k]);
        let far = |k: usize| t(k, WIDTH, self.far[k]);
        let last = l.min8(far(0), l.min8(far(1), far(2)));
        let first = l.max8(near(0), l.max8(near(1), near(2)));
        let first = l.max8(first, l.splat8(0.0));
        (first, l.le8(first, l.min8(last, t_max)))
    }
}

#[cfg(test)]
mod tests {
    use super::super::build::widen;
    use super::super::lanes::Portable;
    #[cfg(target_arch = "x86_64")]
    use super::super::lanes_avx2::Avx2;
    use super::super::node::Child;
    use super::*;
    use crate::{Bounds3, Ray};
    use tyndall_base::{Vec3, vec::vec3};
    use tyndall_testkit::Rng;

    /// The slots that the ray enters, by every instruction set that there is.
    fn entered(node: &Node, ray: &Ray) -> Vec<u32> {
        let local = LocalRay::new(ray);
        fn by<L: Lanes>(l: L, node: &Node, ray: &LocalRay, t_max: f32) -> u32 {
            Slabs::new(l, ray).test(l, node, l.splat8(t_max)).1
        }
        let mut all = vec![by(Portable, node, &local, ray.t_max)];
        #[cfg(target_arch = "x86_64")]
        all.extend(Avx2::detect().map(|l| by(l, node, &local, ray.t_max)));
        all
    }

    /// Boxes of all sizes near and far, some flat, widened as they are built, around a point of the ray: each is entered, and
    /// no empty slot is.
    #[test]
    fn a_box_that_holds_a_point_of_the_ray_is_entered() {
        let mut rng = Rng::new(11);
        for round in 0..40_000 {
            let mut number = |scale: f32| {
                let x = scale * (2.0 * rng.f32() - 1.0);
                // whole numbers lie level with each other, zeros make rays that run along an axis
                if round % 3 == 0 { x.round() } else { x }
            };
            let scale = 10.0f32.powi(round % 23 - 11);
            let o = vec3(number(scale), number(1e3 * scale), number(scale));
            let d = vec3(number(2.0), number(2.0), number(2.0)) * [1.0, 1e-6, 1e6][round as usize % 3];
            if d == Vec3::ZERO {
                continue;
            }
            let size = scale / d.abs().max_component();
            let t = number(size).abs();
            let ray = Ray { t_max: t * 1.000_001 + f32::MIN_POSITIVE, ..Ray::new(o, d) };
            // rounded outwards, so that the point itself is within
            let at = |k: usize| f64::from(o[k]) + f64::from(t) * f64::from(d[k]);
            let low = |k: usize| (at(k) as f32).next_down();
            let high = |k: usize| (at(k) as f32).next_up();
            let grow = number(0.1 * scale).abs();
            let lo = vec3(low(0), low(1) - grow, low(2));
            let b = widen(Bounds3 { lo, hi: vec3(high(0) + grow, high(1), high(2) + grow) }, 0.0);
            let slot = round as usize % WIDTH;
            let mut node = Node::EMPTY;
            node.set(slot, b, Child::ROOT, u8::MAX);
            for mask in entered(&node, &ray) {
                assert_eq!(mask, 1 << slot, "round {round}: {b:?} by {o:?} {d:?} at {t}");
            }
        }
    }

    /// Numbers near the ends of what `f32` holds: empty slots stay closed, which name no child.
    #[test]
    fn no_ray_enters_an_empty_slot() {
        let places = [0.0, -0.0, 1.0, -1e-45, 1e-38, 1e38, f32::MAX, -f32::MAX];
        let ways = [0.0, -0.0, 1.0, -1.0, 1e-45, -1e-38, 1e30, -1e30];
        let ends = [0.0, 1.0, f32::MAX, f32::INFINITY];
        let mut rng = Rng::new(12);
        for _ in 0..20_000 {
            let mut one = |of: &[f32]| of[(rng.f32() * of.len() as f32) as usize % of.len()];
            let mut three = |of: &[f32]| vec3(one(of), one(of), one(of));
            let ray = Ray::new(three(&places), three(&ways));
            let ray = Ray { t_max: one(&ends), ..ray };
            for mask in entered(&Node::EMPTY, &ray) {
                assert_eq!(mask, 0, "{ray:?}");
            }
        }
    }
}
