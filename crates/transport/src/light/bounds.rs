//! Where lights are, where they point, and how much of one may reach a point at most.
//!
//! A cone of normals about `axis` with the half-angle `theta_o`, each of which emits within `theta_e`. Importance:
//! power over squared distance, times the greatest cosines that the box allows at the light and at the receiver.
//! Source: Conty Estevez & Kulla 2018, *Importance sampling of many lights with adaptive tree splitting*.

use super::{Light, volume::is_near};
use std::f32::consts::{FRAC_PI_2, PI};
use tyndall_base::{Vec3, math};
use tyndall_geometry::{Accel, Bounds3, Shape};

/// Bounds of one light or of several.
#[derive(Clone, Copy, Debug)]
pub(super) struct LightBounds {
    pub bounds: Bounds3,
    axis: Vec3,
    pub power: f32,
    cos_o: f32,
    cos_e: f32,
    two_sided: bool,
    /// Sends nothing to points near its box.
    hollow: bool,
}

/// Cosines this much beyond the last one still count: a light must not be lost to rounding.
const SLACK: f32 = 1e-4;

impl LightBounds {
    /// Of a light of finite extent; `None` for those at infinity.
    pub fn of(light: &Light, accel: &Accel, power: f64) -> Option<Self> {
        let power = power as f32;
        let everywhere = Self {
            bounds: light.bounds(accel)?,
            axis: Vec3 { x: 0.0, y: 0.0, z: 1.0 },
            power,
            cos_o: -1.0,
            cos_e: 0.0,
            two_sided: false,
            hollow: false,
        };
        match light {
            Light::Area(l) => {
                let shape = &accel.group(l.shape).shape;
                let flat = match shape {
                    Shape::Triangles(_) | Shape::Disk(_) => true,
                    Shape::Bilinear(m) => m.is_flat(l.prim),
                    _ => false,
                };
                let n = l.sample_position(accel, [0.5, 0.5]).target.n;
                let cos_o = if flat { 1.0 } else { -1.0 };
                Some(Self { axis: n, cos_o, two_sided: l.two_sided, ..everywhere })
            }
            Light::Point(_) | Light::Goniometric(_) | Light::Projection(_) => Some(everywhere),
            Light::Spot(l) => Some(Self { axis: l.axis, cos_o: 1.0, cos_e: l.cos_end, ..everywhere }),
            Light::Volume(l) => Some(Self { hollow: l.is_hollow(), ..everywhere }),
            Light::Distant(_) | Light::Infinite(_) | Light::Image(_) | Light::Portal(_) => None,
        }
    }

    /// Of both.
    pub fn union(&self, b: &Self) -> Self {
        let (axis, cos_o) = cone_union((self.axis, self.cos_o), (b.axis, b.cos_o));
        Self {
            bounds: self.bounds.union(b.bounds),
            axis,
            power: self.power + b.power,
            cos_o,
            cos_e: self.cos_e.min(b.cos_e),
            two_sided: self.two_sided || b.two_sided,
            hollow: false,
        }
    }

    /// Measure of the directions that the cone emits to (Conty Estevez & Kulla 2018, eq. 1).
    pub fn orientation_cost(&self) -> f32 {
        let (o, e) = (math::acos(self.cos_o), math::acos(self.cos_e));
        let w = (o + e).min(PI);
        let (sin_o, cos_o) = math::sin_cos(o);
        let rest = 2.0 * w * sin_o - math::cos(o - 2.0 * w) - 2.0 * o * sin_o + cos_o;
        2.0 * PI * (1.0 - cos_o) + FRAC_PI_2 * rest
    }

    /// Whether `p` is near a light that sends nothing there.
    #[inline(always)]
    pub fn is_hollow_at(&self, p: Vec3) -> bool {
        self.hollow && is_near(self.bounds, p)
    }

    /// How much a point with normal `n` (zero for none) may receive; zero only where nothing arrives.
    #[inline]
    pub fn importance(&self, p: Vec3, n: Vec3) -> f32 {
        if self.is_hollow_at(p) {
            return 0.0;
        }
        let centre = (self.bounds.lo + self.bounds.hi) * 0.5;
        let half = (self.bounds.hi - self.bounds.lo) * 0.5;
        let radius2 = half.length_squared();
        let away = p - centre;
        let d2 = away.length_squared();
        let distance2 = d2.max(radius2).max(f32::MIN_POSITIVE);
        if d2 <= radius2 {
            // within the box's sphere every cosine may be 1
            return self.power / distance2;
        }
        let w = away * (1.0 / d2.sqrt());
        let sin2_b = radius2 / d2;
        let (sin_b, cos_b) = (sin2_b.sqrt(), (1.0 - sin2_b).max(0.0).sqrt());
        let cos_w = w.dot(self.axis);
        let cos_w = if self.two_sided { cos_w.abs() } else { cos_w };
        let sin_o = (1.0 - self.cos_o * self.cos_o).max(0.0).sqrt();
        // theta' = max(0, theta_w - theta_o - theta_b)
        let (sin_x, cos_x) = less(sine(cos_w), cos_w, sin_o, self.cos_o);
        let (_, cos_light) = less(sin_x, cos_x, sin_b, cos_b);
        if cos_light <= self.cos_e - SLACK {
            return 0.0;
        }
        let (_, cos_receiver) = if n == Vec3::ZERO {
            (0.0, 1.0)
        } else {
            let cos_i = w.dot(n).abs();
            less(sine(cos_i), cos_i, sin_b, cos_b)
        };
        // floors instead of zeros: shading normals and lobes that reach round a corner
        self.power * cos_light.max(SLACK) * cos_receiver.max(0.02) / distance2
    }
}

#[inline(always)]
fn sine(cos: f32) -> f32 {
    (1.0 - cos * cos).max(0.0).sqrt()
}

/// Sine and cosine of `max(0, a - b)`.
#[inline(always)]
fn less(sin_a: f32, cos_a: f32, sin_b: f32, cos_b: f32) -> (f32, f32) {
    if cos_a > cos_b { (0.0, 1.0) } else { (sin_a * cos_b - cos_a * sin_b, cos_a * cos_b + sin_a * sin_b) }
}

/// A cone that holds both.
fn cone_union((a, cos_a): (Vec3, f32), (b, cos_b): (Vec3, f32)) -> (Vec3, f32) {
    let (theta_a, theta_b) = (math::acos(cos_a), math::acos(cos_b));
    let between = math::acos(a.dot(b).clamp(-1.0, 1.0));
    if (between + theta_b).min(PI) <= theta_a {
        return (a, cos_a);
    }
    if (between + theta_a).min(PI) <= theta_b {
        return (b, cos_b);
    }
    let theta = 0.5 * (theta_a + between + theta_b);
    let across = a.cross(b);
    if theta >= PI || across.length_squared() < 1e-12 {
        return (a, -1.0);
    }
    // a turned towards b by theta - theta_a
    let (sin, cos) = math::sin_cos(theta - theta_a);
    let side = across.cross(a).normalize();
    // the union is a little wider than rounding can make it narrower
    ((a * cos + side * sin).normalize(), (math::cos(theta) - 1e-6).max(-1.0))
}
