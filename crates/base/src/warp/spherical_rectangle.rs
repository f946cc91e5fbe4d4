use super::vec64::{V, add_scaled, cross, dot, from, length, to_vec3};
use crate::each;
use crate::math::f64::{atan2, sin_cos};
use crate::vec::Vec3;
use std::f64::consts::TAU;

/// Uniform directions in the solid angle of a rectangle (Urena, Fajardo & King 2013).
///
/// In the frame of the rectangle (axes along its sides, the reference point as origin) a part of the solid angle fixes
/// the x of the point, and the height of a cap fixes its y. Double precision, down to 1e-9 sr; below, sample by area.
#[derive(Clone, Copy, Debug)]
pub struct SphericalRectangle {
    axes: [V; 3],
    /// Near and far ends along the axes, and the plane `z = z0 < 0`.
    x: [f64; 2],
    y: [f64; 2],
    z0: f64,
    /// z of the normals of the planes through the origin and the lower and upper side.
    b: [f64; 2],
    /// A full turn less the two angles at the left side.
    k: f64,
    solid_angle: f64,
}

impl SphericalRectangle {
    /// The smallest solid angle that is sampled \[sr\].
    pub const SMALLEST: f64 = 1e-9;

    /// From a corner, as seen from the reference point, and the two sides that leave it at right angles.
    ///
    /// None where the solid angle is below [`Self::SMALLEST`] (edge-on, degenerate or far away) or not finite.
    #[inline]
    pub fn new(corner: Vec3, side_x: Vec3, side_y: Vec3) -> Option<Self> {
        let (d, ex, ey) = (from(corner), from(side_x), from(side_y));
        let (width, height) = (length(ex), length(ey));
        let (ax, ay) = (each(ex, |v| v / width), each(ey, |v| v / height));
        let normal = cross(ax, ay);
        let distance = dot(d, normal);
        // the plane lies on the negative side
        let (az, z0) = if distance > 0.0 { (each(normal, |v| -v), -distance) } else { (normal, distance) };
        let (x0, y0) = (dot(d, ax), dot(d, ay));
        let (x, y) = ([x0, x0 + width], [y0, y0 + height]);
        let [right, left] = angles(x, y, z0);
        let k = TAU - left;
        let solid_angle = right - k;
        let b = each(y, |y| -y / (y * y + z0 * z0).sqrt());
        let b = [b[0], -b[1]];
        let rectangle = Self { axes: [ax, ay, az], x, y, z0, b, k, solid_angle };
        let usable = (Self::SMALLEST..100.0).contains(&solid_angle) && z0 < 0.0;
        usable.then_some(rectangle)
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

    /// A point of the rectangle, relative to the reference point; its direction is uniform in the solid angle.
    #[inline]
    pub fn sample(&self, u: [f32; 2]) -> Vec3 {
        let x = self.abscissa(f64::from(u[0]));
        let d2 = x * x + self.z0 * self.z0;
        // h = y / |point| is uniform between the two sides
        let [h0, h1] = each(self.y, |y| y / (d2 + y * y).sqrt());
        let h = h0 + f64::from(u[1]) * (h1 - h0);
        let y = (h * (d2 / (1.0 - h * h)).sqrt()).clamp(self.y[0], self.y[1]);
        let p = add_scaled(each(self.axes[2], |v| v * self.z0), self.axes[0], x);
        to_vec3(add_scaled(p, self.axes[1], y))
    }

    /// The x with the share `u` of the solid angle on its left.
    #[inline(always)]
    fn abscissa(&self, u: f64) -> f64 {
        let (sin, cos) = sin_cos(u * self.solid_angle + self.k);
        let f = (cos * self.b[0] - self.b[1]) / sin;
        let c = (1.0 / (f * f + self.b[0] * self.b[0]).sqrt()).copysign(f).clamp(-1.0, 1.0);
        let x = -(c * self.z0) / (1.0 - c * c).sqrt();
        // c = +-1 points along the axis itself
        if x.is_nan() { self.x[0] } else { x.clamp(self.x[0], self.x[1]) }
    }

    /// The numbers that [`Self::sample`] maps to the point `p` of the rectangle, relative to the reference point.
    #[inline]
    pub fn invert(&self, p: Vec3) -> [f32; 2] {
        let p = from(p);
        // any point on the ray will do: bring it to the plane
        let p = each(p, |v| v * self.z0 / dot(p, self.axes[2]));
        let x = dot(p, self.axes[0]).clamp(self.x[0], self.x[1]);
        let y = dot(p, self.axes[1]).clamp(self.y[0], self.y[1]);
        let [right, left] = angles([self.x[0], x], self.y, self.z0);
        let part = (right + left - TAU) / self.solid_angle;
        let h = |y: f64| y / (x * x + self.z0 * self.z0 + y * y).sqrt();
        let height = (h(y) - h(self.y[0])) / (h(self.y[1]) - h(self.y[0]));
        [part.clamp(0.0, 1.0) as f32, height.clamp(0.0, 1.0) as f32]
    }
}

/// Interior angles of the spherical rectangle: the sum of the two on the right and of the two on the left.
///
/// The planes through the origin and the lower, right, upper and left side have the normals n0..n3. Angles are added by
/// multiplying complex numbers, which takes one arc tangent instead of two.
#[inline(always)]
fn angles(x: [f64; 2], y: [f64; 2], z: f64) -> [f64; 2] {
    let n = [[0.0, z, -y[0]], [-z, 0.0, x[1]], [0.0, -z, y[1]], [z, 0.0, -x[0]]];
    let angle = |a: V, b: V| (-dot(a, b), length(cross(a, b)));
    let sum = |(c0, s0): (f64, f64), (c1, s1): (f64, f64)| {
        let both = atan2(s0 * c1 + c0 * s1, c0 * c1 - s0 * s1);
        if both < 0.0 { both + TAU } else { both }
    };
    [sum(angle(n[0], n[1]), angle(n[1], n[2])), sum(angle(n[2], n[3]), angle(n[3], n[0]))]
}
