use crate::math::{atan2, exp, ln, tan};

/// Distance to a collision in a medium of extinction `sigma` \[1/m\]: density `sigma e^(-sigma t)` on `[0, inf)`.
///
/// `t = -ln(1 - u) / sigma`; infinite when `sigma` is zero (and finite `u > 0`), zero when `u` is zero.
#[inline(always)]
pub fn sample_exponential(u: f32, sigma: f32) -> f32 {
    let optical = -ln(1.0 - u);
    if sigma > 0.0 { optical / sigma } else { f32::INFINITY }
}

/// `sigma e^(-sigma t)` per metre.
#[inline(always)]
pub fn pdf_exponential(t: f32, sigma: f32) -> f32 {
    sigma * exp(-sigma * t)
}

/// Distance to a collision before `t_max`: density `sigma e^(-sigma t) / (1 - e^(-sigma t_max))` on `[0, t_max]`.
///
/// Uniform on `[0, t_max]` when `sigma t_max` is below 1e-3 to rounding (second order in the optical depth).
#[inline(always)]
pub fn sample_truncated_exponential(u: f32, sigma: f32, t_max: f32) -> f32 {
    let depth = sigma * t_max;
    let share = opacity(depth);
    // -ln(1 - u share) / sigma; for thin segments its series in x = u share, divided by sigma = depth / t_max
    let x = u * share;
    let thin = t_max * (x / depth) * (1.0 + 0.5 * x * (1.0 + x * (2.0 / 3.0) * (1.0 + 0.75 * x)));
    let thick = -ln(1.0 - x) / sigma;
    let t = if depth < THIN { thin } else { thick };
    if depth > 0.0 { t.min(t_max) } else { u * t_max }
}

/// Density of [`sample_truncated_exponential`] per metre; zero outside `[0, t_max]`.
#[inline(always)]
pub fn pdf_truncated_exponential(t: f32, sigma: f32, t_max: f32) -> f32 {
    let share = opacity(sigma * t_max);
    let inside = if share > 0.0 { sigma * exp(-sigma * t) / share } else { 1.0 / t_max };
    if (0.0..=t_max).contains(&t) { inside } else { 0.0 }
}

/// Below this optical depth the series beats the difference of rounded numbers.
const THIN: f32 = 0.05;

/// `1 - e^(-depth)`, precise for small depths.
#[inline(always)]
fn opacity(depth: f32) -> f32 {
    let series = depth * (1.0 - depth * (0.5 - depth * (1.0 / 6.0 - depth * (1.0 / 24.0))));
    if depth < THIN { series } else { 1.0 - exp(-depth) }
}

/// The greatest `f32` angle below `pi / 2`, whose tangent is positive: 1.3e7.
const STEEPEST: f32 = 1.570_796_251_296_997_1;

/// Equiangular sampling of a distance on a ray (Kulla & Fajardo 2012): the density follows the inverse square of the
/// distance to a point, here called the light.
///
/// With `delta` the ray parameter nearest to the light, `d` the light's distance from the ray and angles
/// `theta = atan((t - delta) / d)`: `t = delta + d tan((1 - u) theta_a + u theta_b)`,
/// `pdf = d / ((theta_b - theta_a) (d^2 + (t - delta)^2))`.
#[derive(Clone, Copy, Debug)]
pub struct Equiangular {
    delta: f32,
    d: f32,
    theta_a: f32,
    theta_b: f32,
    range: [f32; 2],
}

impl Equiangular {
    /// For a ray with unit direction, `delta` the projection of the light on it and `d` the distance of the light
    /// from it, both in metres, over `[t_min, t_max]`; `t_max` may be infinite.
    ///
    /// A light on the ray itself is moved off it by 10^-4 of the segment (of the way to it, on an infinite one), so that
    /// the density stays finite.
    #[inline(always)]
    pub fn new(delta: f32, d: f32, t_min: f32, t_max: f32) -> Self {
        let length = t_max - t_min;
        let scale = if length < f32::INFINITY { length } else { (delta - t_min).abs() };
        let d = d.max(1e-4 * scale).max(f32::MIN_POSITIVE);
        let theta = |t: f32| atan2(t - delta, d).clamp(-STEEPEST, STEEPEST);
        Self { delta, d, theta_a: theta(t_min), theta_b: theta(t_max), range: [t_min, t_max] }
    }

    /// A distance within the segment \[m\].
    #[inline(always)]
    pub fn sample(&self, u: f32) -> f32 {
        let t = self.delta + self.d * tan(self.theta_a + u * (self.theta_b - self.theta_a));
        t.max(self.range[0]).min(self.range[1])
    }

    /// Density per metre; zero outside the segment.
    #[inline(always)]
    pub fn pdf(&self, t: f32) -> f32 {
        let s = t - self.delta;
        let inside = self.d / ((self.theta_b - self.theta_a) * (self.d * self.d + s * s));
        if t >= self.range[0] && t <= self.range[1] { inside } else { 0.0 }
    }
}
