//! Three-vectors of `f64` for the solid-angle warps, whose differences of nearly equal cosines need the digits.

use crate::vec::{Vec3, vec3};

pub(super) type V = [f64; 3];

#[inline(always)]
pub(super) fn from(v: Vec3) -> V {
    [f64::from(v.x), f64::from(v.y), f64::from(v.z)]
}

#[inline(always)]
pub(super) fn to_vec3(v: V) -> Vec3 {
    vec3(v[0] as f32, v[1] as f32, v[2] as f32)
}

#[inline(always)]
pub(super) fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub(super) fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline(always)]
pub(super) fn sub(a: V, b: V) -> V {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `a + s b`.
#[inline(always)]
pub(super) fn add_scaled(a: V, b: V, s: f64) -> V {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

/// `s a`.
#[inline(always)]
pub(super) fn scale(a: V, s: f64) -> V {
    [a[0] * s, a[1] * s, a[2] * s]
}

#[inline(always)]
pub(super) fn length(a: V) -> f64 {
    dot(a, a).sqrt()
}

#[inline(always)]
pub(super) fn normalize(a: V) -> V {
    scale(a, 1.0 / length(a))
}

/// `1 - a . b` of unit vectors, without cancellation.
#[inline(always)]
pub(super) fn one_minus_dot(a: V, b: V) -> f64 {
    let d = sub(a, b);
    0.5 * dot(d, d)
}
