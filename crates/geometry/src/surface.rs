//! What a ray meets, and how the next ray leaves.
//!
//! A hit point is reconstructed in `f64` and rounded once; [`Rounding`] says exactly how far the rounded point may be
//! from the exact surface, axis by axis. A ray that leaves starts at the nearest `f32` point that is certainly on
//! its side, found by directed rounding, so an offset never exceeds one unit in the last place per axis and is zero
//! where the point is exact: on an axis-aligned plane the origin stays in the plane. The traversal decides `t > 0`
//! in `f64`, so such a ray neither meets the surface it leaves nor steps over one that is one ulp away.

use crate::dvec::DVec3;
use crate::{Frame, Ray};
use tyndall_base::{Vec2, Vec3, vec::vec3};

/// The exact point lies within `[p - below, p + above]`, per axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rounding {
    /// How far below `p` the exact point may lie, >= 0.
    pub below: Vec3,
    /// How far above `p` the exact point may lie, >= 0.
    pub above: Vec3,
}

impl Rounding {
    /// The point is exact.
    pub const NONE: Self = Self { below: Vec3::ZERO, above: Vec3::ZERO };

    /// Rounds `exact`, itself known up to `noise`, to `f32`.
    #[inline]
    pub fn of(exact: DVec3, noise: DVec3) -> (Vec3, Self) {
        let p = exact.round();
        let off = exact - DVec3::from(p);
        let gap = |off: f64, noise: f64| round_up((off + noise).max(0.0));
        let above = vec3(gap(off.x, noise.x), gap(off.y, noise.y), gap(off.z, noise.z));
        let below = vec3(gap(-off.x, noise.x), gap(-off.y, noise.y), gap(-off.z, noise.z));
        (p, Self { below, above })
    }

    /// The greater of both sides: a bound on the absolute error per axis.
    #[inline]
    pub fn bound(&self) -> Vec3 {
        self.below.max(self.above)
    }
}

/// The least `f32` not below `x`.
#[inline]
fn round_up(x: f64) -> f32 {
    let r = x as f32;
    // the next float in order of value without a branch; zero has gone up already where it was not exact
    let bits = r.to_bits();
    let up = f32::from_bits(if r == 0.0 {
        1
    } else if r > 0.0 {
        bits + 1
    } else {
        bits.wrapping_sub(1)
    });
    if f64::from(r) < x { up } else { r }
}

/// The `f32` point nearest to the exact surface point that is certainly not behind it, seen from the side that
/// `dir` leaves to. `n`: the geometric normal, either way round.
#[inline]
pub fn spawn_origin(p: Vec3, rounding: &Rounding, n: Vec3, dir: Vec3) -> Vec3 {
    let side = if n.dot(dir) < 0.0 { -n } else { n };
    let step = |k: usize| {
        let x = f64::from(p[k]);
        if side[k] > 0.0 {
            round_up(x + f64::from(rounding.above[k]))
        } else if side[k] < 0.0 {
            -round_up(f64::from(rounding.below[k]) - x)
        } else {
            p[k]
        }
    };
    vec3(step(0), step(1), step(2))
}

/// The ray from `o` that ends just short of the free point `target`, with unit direction; `None` when they coincide.
///
/// The margin is `2^-22` of the distance: what the rounding of an `f32` direction and of `t_max` can amount to.
#[inline]
pub fn segment(o: Vec3, target: Vec3, time: f32) -> Option<Ray> {
    segment_short_of(o, target, 0.0, time)
}

/// [`segment`] to a point of a surface with normal `n`: across a slope, the direction's rounding (`2^-24` of the
/// distance) moves the crossing by that over the cosine.
#[inline]
fn segment_to_surface(o: Vec3, target: Vec3, n: Vec3, time: f32) -> Option<Ray> {
    let v = DVec3::from(target) - DVec3::from(o);
    let cosine = v.dot(n.into()).abs() / v.length();
    segment_short_of(o, target, HALF_ULP / cosine.max(1e-6), time)
}

const HALF_ULP: f64 = 1.0 / (1u32 << 24) as f64;

#[inline]
fn segment_short_of(o: Vec3, target: Vec3, margin: f64, time: f32) -> Option<Ray> {
    let v = DVec3::from(target) - DVec3::from(o);
    let length = v.length();
    if !(length > 0.0 && length.is_finite()) {
        return None;
    }
    let t_max = (length * (1.0 - 4.0 * HALF_ULP - margin)) as f32;
    Some(Ray { o, d: (v * (1.0 / length)).round(), t_max, time })
}

/// The surface where a ray met it.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoint {
    /// The hit point \[m\], rounded to `f32`.
    pub p: Vec3,
    /// How far `p` is from the exact point.
    pub rounding: Rounding,
    /// Geometric unit normal, oriented as pbrt does: turned round when reverse orientation and a change of
    /// handedness disagree, then to the side of the shading normal where the mesh has normals.
    pub ng: Vec3,
    /// Shading unit normal.
    pub ns: Vec3,
    /// Change of position with u; orthogonal to neither normal in general, never zero.
    pub dpdu: Vec3,
    /// Change of position with v.
    pub dpdv: Vec3,
    /// Change of the shading normal with u and v; zero unless [`Accel::bend`](crate::Accel::bend) was asked for it.
    pub dn: [Vec3; 2],
    /// Surface parameters or texture coordinates.
    pub uv: Vec2,
    /// The ray's time.
    pub time: f32,
}

impl SurfacePoint {
    /// Bound on the error of `p` per axis \[m\].
    #[inline]
    pub fn p_err(&self) -> Vec3 {
        self.rounding.bound()
    }

    /// Where a ray along `dir` starts.
    #[inline]
    pub fn origin(&self, dir: Vec3) -> Vec3 {
        spawn_origin(self.p, &self.rounding, self.ng, dir)
    }

    /// The unbounded ray along `dir`.
    #[inline]
    pub fn spawn(&self, dir: Vec3) -> Ray {
        Ray { o: self.origin(dir), d: dir, t_max: f32::INFINITY, time: self.time }
    }

    /// The ray that ends just short of the free point `target`.
    #[inline]
    pub fn spawn_to(&self, target: Vec3) -> Option<Ray> {
        segment(self.origin(target - self.p), target, self.time)
    }

    /// The ray that ends just short of a sampled surface point.
    #[inline]
    pub fn spawn_to_sample(&self, sample: &ShapeSample) -> Option<Ray> {
        segment_to_surface(self.origin(sample.p - self.p), sample.origin(self.p), sample.n, self.time)
    }

    /// Tangent frame about the shading normal with x along `dpdu`.
    #[inline]
    pub fn shading_frame(&self) -> Frame {
        Frame::from_xz(self.dpdu, self.ns)
    }
}

/// A point sampled on a shape.
#[derive(Clone, Copy, Debug)]
pub struct ShapeSample {
    /// The point \[m\], rounded to `f32`.
    pub p: Vec3,
    /// How far `p` is from the exact point.
    pub rounding: Rounding,
    /// Geometric unit normal, oriented as [`SurfacePoint::ng`].
    pub n: Vec3,
    /// Surface parameters or texture coordinates.
    pub uv: Vec2,
    /// Density: per square metre from area sampling, per steradian from solid-angle sampling.
    pub pdf: f32,
}

impl ShapeSample {
    /// The end of a ray from `reference`: on that side of the surface.
    #[inline]
    pub fn origin(&self, reference: Vec3) -> Vec3 {
        spawn_origin(self.p, &self.rounding, self.n, reference - self.p)
    }

    /// The ray from the free point `o` that ends just short of the sample.
    #[inline]
    pub fn ray_from(&self, o: Vec3, time: f32) -> Option<Ray> {
        segment_to_surface(o, self.origin(o), self.n, time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dvec::dvec3;

    #[test]
    fn an_exact_point_is_not_moved() {
        let (p, r) = Rounding::of(dvec3(4000.0, 0.25, 0.0), DVec3::default());
        assert_eq!(r, Rounding::NONE);
        assert_eq!(spawn_origin(p, &r, vec3(0.1, -0.2, 1.0), vec3(0.0, 0.0, -1.0)), p);
    }

    #[test]
    fn the_origin_is_on_the_side_it_leaves_to_and_within_an_ulp() {
        let mut x = 0.123_456_789_012_3f64;
        for i in 0..1000 {
            x = (x * 997.3).fract();
            let exact = dvec3(x * 5000.0, -x * 7.0, x - 0.5);
            let noise = exact.abs() * 1e-15;
            let (p, r) = Rounding::of(exact, noise);
            let n = vec3(0.6, -0.48, 0.64);
            let dir = if i % 2 == 0 { n } else { -n };
            let q = DVec3::from(spawn_origin(p, &r, n, dir)) - exact;
            assert!(q.dot(dir.into()) >= 0.0);
            for k in 0..3 {
                assert!(q.to_array()[k].abs() <= 1.01 * f64::from(p[k].abs().next_up() - p[k].abs()));
            }
        }
    }

    #[test]
    fn a_segment_stops_short() {
        let (o, target) = (vec3(1.0, 2.0, 3.0), vec3(4000.0, -2.0, 3.5));
        let ray = segment(o, target, 0.0).expect("distinct points");
        let gap = (ray.at(ray.t_max) - target).length();
        assert!(ray.t_max < (target - o).length() && gap < 0.01, "{gap}");
        assert!(segment(o, o, 0.0).is_none());
    }
}
