use super::disk::sample_concentric_disk;
use crate::math::sin_cos_turns;
use crate::vec::{Vec3, vec3};
use std::f32::consts::{FRAC_1_PI, TAU};

/// The direction with cosine `1 - height` to `+z` and azimuth `2 pi turn`; a small `height` keeps its precision.
#[inline(always)]
fn from_height(height: f32, turn: f32) -> Vec3 {
    let (sin_phi, cos_phi) = sin_cos_turns(turn);
    let sin_theta = (height * (2.0 - height)).max(0.0).sqrt();
    vec3(sin_theta * cos_phi, sin_theta * sin_phi, 1.0 - height)
}

/// Density `cos theta / pi` over the upper hemisphere (Malley: the unit disk lifted up).
#[inline(always)]
pub fn sample_cosine_hemisphere(u: [f32; 2]) -> Vec3 {
    let p = sample_concentric_disk(u);
    vec3(p.x, p.y, (1.0 - p.x * p.x - p.y * p.y).max(0.0).sqrt())
}

/// `cos theta / pi` per steradian; zero below the horizon.
#[inline(always)]
pub fn pdf_cosine_hemisphere(cos_theta: f32) -> f32 {
    cos_theta.max(0.0) * FRAC_1_PI
}

/// Uniform over the upper hemisphere.
#[inline(always)]
pub fn sample_uniform_hemisphere(u: [f32; 2]) -> Vec3 {
    from_height(1.0 - u[0], u[1])
}

/// `1 / 2 pi` per steradian.
#[inline(always)]
pub fn pdf_uniform_hemisphere() -> f32 {
    1.0 / TAU
}

/// Uniform over the sphere.
#[inline(always)]
pub fn sample_uniform_sphere(u: [f32; 2]) -> Vec3 {
    from_height(2.0 * u[0], u[1])
}

/// `1 / 4 pi` per steradian.
#[inline(always)]
pub fn pdf_uniform_sphere() -> f32 {
    0.5 / TAU
}

/// Uniform over the cone about `+z` with `1 - cos theta_max = one_minus_cos_max`.
///
/// The complement of the cosine is the parameter because it keeps its digits for narrow cones (the sun, far spheres).
#[inline(always)]
pub fn sample_uniform_cone(u: [f32; 2], one_minus_cos_max: f32) -> Vec3 {
    from_height(u[0] * one_minus_cos_max, u[1])
}

/// `1 / (2 pi (1 - cos theta_max))` per steradian inside the cone.
#[inline(always)]
pub fn pdf_uniform_cone(one_minus_cos_max: f32) -> f32 {
    1.0 / (TAU * one_minus_cos_max)
}

/// Dense towards `+z`: density `1 / (4 pi c)` per steradian, where `c = |w - z| = 2 sin(theta / 2)` is the chord to `+z`.
///
/// Single scattering around a small light at distance D makes the radiance `(pi - theta) / (D sin theta)`, which this
/// follows within a factor of 1.3, with a distribution function that inverts in one line: `u = sin(theta / 2)`.
#[inline(always)]
pub fn sample_chord(u: [f32; 2]) -> Vec3 {
    from_height(2.0 * u[0] * u[0], u[1])
}

/// Density per steradian of [`sample_chord`] at a direction whose chord to the axis is `chord`.
#[inline(always)]
pub fn pdf_chord(chord: f32) -> f32 {
    0.5 / (TAU * chord)
}
