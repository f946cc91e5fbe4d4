use super::vec64::{V, add_scaled, cross, dot, from, length, normalize, one_minus_dot, sub, to_vec3};
use crate::each;
use crate::math::f64::{atan2, sin_cos};
use crate::vec::Vec3;

/// Uniform directions in the solid angle of a triangle (Arvo 1995).
///
/// A part of the solid angle picks the point C' on the arc A C whose triangle A B C' has it as area; the direction then
/// lies on the arc B C'. Works in double precision with differences written without cancellation, so that triangles
/// down to 1e-9 sr are sampled evenly; below, sample by area.
#[derive(Clone, Copy, Debug)]
pub struct SphericalTriangle {
    a: V,
    b: V,
    c: V,
    /// Unit tangent at A along the arc A C.
    toward_c: V,
    cos_alpha: f64,
    sin_alpha: f64,
    solid_angle: f64,
}

impl SphericalTriangle {
    /// The smallest solid angle that is sampled \[sr\].
    pub const SMALLEST: f64 = 1e-9;

    /// From the three vertices seen from the origin, not necessarily unit vectors; none where the solid angle is below
    /// [`Self::SMALLEST`] (edge-on, degenerate or far away) or not finite.
    #[inline]
    pub fn new(vertices: [Vec3; 3]) -> Option<Self> {
        let (p, q, r) = (from(vertices[0]), from(vertices[1]), from(vertices[2]));
        let (a, b, c) = (normalize(p), normalize(q), normalize(r));
        let solid_angle = solid_angle([a, b, c]);
        // the planes of the arcs A B and A C; their angle is alpha
        let (ab, ac) = (cross(p, sub(q, p)), cross(p, sub(r, p)));
        let scale = 1.0 / (length(ab) * length(ac));
        let (cos_alpha, sin_alpha) = (dot(ab, ac) * scale, length(cross(ab, ac)) * scale);
        let toward_c = normalize(cross(ac, a));
        let usable = (Self::SMALLEST..100.0).contains(&solid_angle) && sin_alpha > 0.0;
        usable.then_some(Self { a, b, c, toward_c, cos_alpha, sin_alpha, solid_angle })
    }

    /// The solid angle \[sr\].
    #[inline(always)]
    pub fn solid_angle(&self) -> f32 {
        self.solid_angle as f32
    }

    /// `1 / solid angle` per steradian.
    #[inline(always)]
    pub fn pdf(&self) -> f32 {
        (1.0 / self.solid_angle) as f32
    }

    /// A unit direction within the triangle.
    #[inline]
    pub fn sample(&self, u: [f32; 2]) -> Vec3 {
        let c = self.corner(f64::from(u[0]) * self.solid_angle);
        // 1 - cosine of the arc from B, uniform up to that of C'
        let height = f64::from(u[1]) * one_minus_dot(c, self.b);
        let sin = (height * (2.0 - height)).max(0.0).sqrt();
        let toward = add_scaled(c, self.b, -dot(c, self.b));
        let norm = length(toward);
        let along = if norm > 0.0 { sin / norm } else { 0.0 };
        to_vec3(add_scaled(each(self.b, |x| x * (1.0 - height)), toward, along))
    }

    /// The point C' on the arc A C with `solid angle(A, B, C') = area`.
    #[inline(always)]
    fn corner(&self, area: f64) -> V {
        let (sin_alpha, cos_alpha) = (self.sin_alpha, self.cos_alpha);
        let (sin_half, cos_half) = sin_cos(0.5 * area);
        let (sin_area, versine) = (2.0 * sin_half * cos_half, 2.0 * sin_half * sin_half);
        // Arvo's s, t = sin, cos(area - alpha); u = t - cos alpha; v = s + sin alpha cos c, expanded
        let s = sin_area * cos_alpha - (1.0 - versine) * sin_alpha;
        let t = (1.0 - versine) * cos_alpha + sin_area * sin_alpha;
        let u = sin_area * sin_alpha - versine * cos_alpha;
        let v = sin_area * cos_alpha + versine * sin_alpha - sin_alpha * one_minus_dot(self.a, self.b);
        let denominator = (v * s + u * t) * sin_alpha;
        let cos_b = if denominator == 0.0 { 1.0 } else { ((v * t - u * s) * cos_alpha - v) / denominator };
        let cos_b = cos_b.clamp(-1.0, 1.0);
        let sin_b = ((1.0 - cos_b) * (1.0 + cos_b)).sqrt();
        add_scaled(each(self.a, |x| x * cos_b), self.toward_c, sin_b)
    }

    /// The numbers that [`Self::sample`] maps to the unit direction `w`, which must lie in the triangle.
    #[inline]
    pub fn invert(&self, w: Vec3) -> [f32; 2] {
        let w = normalize(from(w));
        // C' is where the great circle through B and w meets the arc A C
        let c = cross(cross(self.b, w), cross(self.c, self.a));
        let c = normalize(if dot(c, add_scaled(self.a, self.c, 1.0)) < 0.0 { each(c, |x| -x) } else { c });
        if !c[0].is_finite() {
            return [0.0; 2]; // w is B itself: any first number
        }
        let part = solid_angle([self.a, self.b, c]) / self.solid_angle;
        let height = one_minus_dot(w, self.b) / one_minus_dot(c, self.b);
        [part.min(1.0) as f32, height.min(1.0) as f32]
    }
}

/// Solid angle of three unit vectors (Van Oosterom & Strackee 1983).
#[inline(always)]
fn solid_angle([a, b, c]: [V; 3]) -> f64 {
    let triple = dot(a, cross(sub(b, a), sub(c, a)));
    2.0 * atan2(triple.abs(), 1.0 + dot(a, b) + dot(b, c) + dot(c, a))
}
