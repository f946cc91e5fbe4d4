use crate::math::{atan2, sin_cos_turns};
use crate::vec::{Vec2, vec2};
use std::f32::consts::{FRAC_1_PI, TAU};

/// Uniform on the unit disk by the map of Shirley & Chiu (1997): concentric squares to concentric circles.
#[inline(always)]
pub fn sample_concentric_disk(u: [f32; 2]) -> Vec2 {
    let (x, y) = (2.0 * u[0] - 1.0, 2.0 * u[1] - 1.0);
    let wide = x.abs() > y.abs();
    let (r, other) = if wide { (x, y) } else { (y, x) };
    // the centre of the square: any angle will do
    let eighth = if r == 0.0 { 0.0 } else { other / r * 0.125 };
    let (sin, cos) = sin_cos_turns(if wide { eighth } else { 0.25 - eighth });
    vec2(r * cos, r * sin)
}

/// The point of the unit square that [`sample_concentric_disk`] maps to `p`.
#[inline]
pub fn invert_concentric_disk(p: Vec2) -> [f32; 2] {
    let r = (p.x * p.x + p.y * p.y).sqrt();
    let wide = p.x.abs() > p.y.abs();
    // both branches use the signed radius of their own quadrant, so |angle| <= 1/8 turn
    let (near, far) = if wide { (p.x, p.y) } else { (p.y, p.x) };
    let signed = r.copysign(near);
    let other = if near == 0.0 { 0.0 } else { signed * atan2(far / near, 1.0) * (8.0 / TAU) };
    let (x, y) = if wide { (signed, other) } else { (other, signed) };
    [0.5 * (x + 1.0), 0.5 * (y + 1.0)]
}

/// Uniform on the unit disk in polar coordinates, `r = sqrt(u0)`, `phi = 2 pi u1`.
#[inline(always)]
pub fn sample_polar_disk(u: [f32; 2]) -> Vec2 {
    let (sin, cos) = sin_cos_turns(u[1]);
    let r = u[0].sqrt();
    vec2(r * cos, r * sin)
}

/// `1 / pi` per unit area inside the unit disk.
#[inline(always)]
pub fn pdf_uniform_disk() -> f32 {
    FRAC_1_PI
}
