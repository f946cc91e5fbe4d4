//! Affine and projective maps, kept in `f64` with their inverse.
//!
//! Column vectors: `p' = M p`, and `(a * b)` applies `b` first.

use crate::dvec::{DVec3, dvec3};
use crate::{Bounds3, GeometryError};
use std::ops::Mul;
use tyndall_base::Vec3;
use tyndall_base::math::f64::sin_cos;

/// A 4x4 matrix in rows.
pub type Matrix = [[f64; 4]; 4];

const IDENTITY: Matrix =
    [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

/// An invertible map of space and its inverse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    m: Matrix,
    inverse: Matrix,
}

impl Default for Transform {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Transform {
    /// The map that moves nothing.
    pub const IDENTITY: Self = Self { m: IDENTITY, inverse: IDENTITY };

    /// From a matrix in rows.
    ///
    /// # Errors
    /// When the matrix is singular or not finite.
    pub fn new(m: Matrix) -> Result<Self, GeometryError> {
        Ok(Self { m, inverse: invert(&m)? })
    }

    /// From a matrix written column by column, as pbrt's `Transform` directive has it.
    ///
    /// # Errors
    /// When the matrix is singular or not finite.
    pub fn from_columns(c: [f64; 16]) -> Result<Self, GeometryError> {
        Self::new(std::array::from_fn(|r| std::array::from_fn(|k| c[4 * k + r])))
    }

    /// Moves by (x, y, z).
    pub fn translate(x: f64, y: f64, z: f64) -> Self {
        let at = |s: f64| {
            let mut m = IDENTITY;
            (m[0][3], m[1][3], m[2][3]) = (s * x, s * y, s * z);
            m
        };
        Self { m: at(1.0), inverse: at(-1.0) }
    }

    /// Scales the axes.
    ///
    /// # Errors
    /// When a factor is zero or not finite.
    pub fn scale(x: f64, y: f64, z: f64) -> Result<Self, GeometryError> {
        let mut m = IDENTITY;
        (m[0][0], m[1][1], m[2][2]) = (x, y, z);
        Self::new(m)
    }

    /// Turns by `degrees` about `axis`, counter-clockwise seen from the axis' tip (Rodrigues 1840). Quarter turns
    /// about a coordinate axis are exact.
    ///
    /// # Errors
    /// When the axis has no direction.
    pub fn rotate(degrees: f64, axis: [f64; 3]) -> Result<Self, GeometryError> {
        let a = dvec3(axis[0], axis[1], axis[2]);
        let length = a.length();
        if !(length > 0.0 && length.is_finite() && degrees.is_finite()) {
            return Err(GeometryError::BadParameter {
                parameter: "rotation",
                expected: "finite degrees and an axis of finite length > 0",
                got: length,
            });
        }
        let a = a * (1.0 / length);
        let (s, c) = sin_cos_degrees(degrees);
        let [x, y, z] = a.to_array();
        let k = 1.0 - c;
        let m = [
            [x * x * k + c, x * y * k - z * s, x * z * k + y * s, 0.0],
            [y * x * k + z * s, y * y * k + c, y * z * k - x * s, 0.0],
            [z * x * k - y * s, z * y * k + x * s, z * z * k + c, 0.0],
            [0.0, 0.0, 0.0, 1.0],
        ];
        Ok(Self { m, inverse: transpose(&m) })
    }

    /// World to camera: `eye` goes to the origin, `look` onto the positive z axis, `up` into the upper yz half-plane;
    /// left-handed camera space, as in pbrt.
    ///
    /// # Errors
    /// When `eye` and `look` coincide or `up` is along the view.
    pub fn look_at(eye: [f64; 3], look: [f64; 3], up: [f64; 3]) -> Result<Self, GeometryError> {
        let [e, l, u] = [eye, look, up].map(|a| dvec3(a[0], a[1], a[2]));
        let z = (l - e).normalize();
        let x = u.normalize().cross(z);
        if !(x.length() > 1e-12) {
            return Err(GeometryError::BadParameter {
                parameter: "LookAt",
                expected: "distinct eye and look points and an up vector across the view",
                got: x.length(),
            });
        }
        let x = x.normalize();
        let y = z.cross(x);
        let camera_to_world =
            [[x.x, y.x, z.x, e.x], [x.y, y.y, z.y, e.y], [x.z, y.z, z.z, e.z], [0.0, 0.0, 0.0, 1.0]];
        Ok(Self::new(camera_to_world)?.inverse())
    }

    /// The inverse map.
    pub const fn inverse(&self) -> Self {
        Self { m: self.inverse, inverse: self.m }
    }

    /// The matrix in rows.
    pub const fn matrix(&self) -> &Matrix {
        &self.m
    }

    /// True for the identity to the last bit.
    pub fn is_identity(&self) -> bool {
        self.m == IDENTITY
    }

    /// True when left becomes right: the linear part's determinant is negative.
    pub fn swaps_handedness(&self) -> bool {
        let [a, b, c] = [0, 1, 2].map(|r| dvec3(self.m[r][0], self.m[r][1], self.m[r][2]));
        a.dot(b.cross(c)) < 0.0
    }

    /// A point's image; the homogeneous coordinate is divided out.
    #[inline]
    pub fn point(&self, p: Vec3) -> Vec3 {
        self.point64(p.into()).round()
    }

    /// A vector's image: no translation.
    #[inline]
    pub fn vector(&self, v: Vec3) -> Vec3 {
        self.vector64(v.into()).round()
    }

    /// A normal's image under the inverse transpose; not normalised.
    #[inline]
    pub fn normal(&self, n: Vec3) -> Vec3 {
        self.normal64(n.into()).round()
    }

    /// [`Self::point`] in double precision.
    #[inline]
    pub fn point64(&self, p: DVec3) -> DVec3 {
        let row = |r: usize| self.m[r][0] * p.x + self.m[r][1] * p.y + self.m[r][2] * p.z + self.m[r][3];
        let q = dvec3(row(0), row(1), row(2));
        let w = row(3);
        if w == 1.0 { q } else { q * (1.0 / w) }
    }

    /// [`Self::vector`] in double precision.
    #[inline]
    pub fn vector64(&self, v: DVec3) -> DVec3 {
        let row = |r: usize| self.m[r][0] * v.x + self.m[r][1] * v.y + self.m[r][2] * v.z;
        dvec3(row(0), row(1), row(2))
    }

    /// [`Self::normal`] in double precision.
    #[inline]
    pub fn normal64(&self, n: DVec3) -> DVec3 {
        let column =
            |c: usize| self.inverse[0][c] * n.x + self.inverse[1][c] * n.y + self.inverse[2][c] * n.z;
        dvec3(column(0), column(1), column(2))
    }

    /// Bound on the rounding error of [`Self::point64`] per axis, for affine maps.
    #[inline]
    pub fn point_noise(&self, p: DVec3) -> DVec3 {
        let a = p.abs();
        let row = |r: usize| {
            let m = &self.m[r];
            (m[0].abs() * a.x + m[1].abs() * a.y + m[2].abs() * a.z + m[3].abs()) * (4.0 * f64::EPSILON)
        };
        dvec3(row(0), row(1), row(2))
    }

    /// Greatest length per axis of the image of a vector within `[-e, e]`.
    #[inline]
    pub fn spread(&self, e: DVec3) -> DVec3 {
        let row = |r: usize| self.m[r][0].abs() * e.x + self.m[r][1].abs() * e.y + self.m[r][2].abs() * e.z;
        dvec3(row(0), row(1), row(2))
    }

    /// The box around the image of a box (affine maps), rounded outwards.
    pub fn bounds(&self, b: Bounds3) -> Bounds3 {
        if b.is_empty() {
            return b;
        }
        Bounds3::from_points(b.corners().map(|c| self.point(c))).padded(Vec3::ZERO)
    }
}

/// `a * b`: first `b`, then `a`.
impl Mul for Transform {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        Self { m: product(&self.m, &b.m), inverse: product(&b.inverse, &self.inverse) }
    }
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|r| std::array::from_fn(|c| (0..4).map(|k| a[r][k] * b[k][c]).sum()))
}

fn transpose(m: &Matrix) -> Matrix {
    std::array::from_fn(|r| std::array::from_fn(|c| m[c][r]))
}

/// Sine and cosine of an angle in degrees, exact at multiples of 90.
fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    let turns = degrees / 360.0;
    let within = degrees - 360.0 * turns.floor();
    match within {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        _ => sin_cos(within * (std::f64::consts::PI / 180.0)),
    }
}

/// Gauss-Jordan elimination with partial pivoting.
fn invert(m: &Matrix) -> Result<Matrix, GeometryError> {
    let (mut a, mut inv) = (*m, IDENTITY);
    let mut determinant = 1.0;
    for k in 0..4 {
        let pivot = (k..4).fold(k, |best, r| if a[r][k].abs() > a[best][k].abs() { r } else { best });
        if pivot != k {
            a.swap(k, pivot);
            inv.swap(k, pivot);
            determinant = -determinant;
        }
        determinant *= a[k][k];
        let scale = 1.0 / a[k][k];
        if !(determinant != 0.0 && determinant.is_finite() && scale.is_finite()) {
            return Err(GeometryError::SingularTransform { determinant });
        }
        for c in 0..4 {
            a[k][c] *= scale;
            inv[k][c] *= scale;
        }
        for r in (0..4).filter(|&r| r != k) {
            let f = a[r][k];
            for c in 0..4 {
                a[r][c] -= f * a[k][c];
                inv[r][c] -= f * inv[k][c];
            }
        }
    }
    Ok(inv)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_base::vec::vec3;

    fn messy() -> Transform {
        Transform::translate(3.0, -40.0, 0.5)
            * Transform::rotate(33.0, [1.0, 2.0, -0.5]).unwrap()
            * Transform::scale(0.1, 7.0, -2.0).unwrap()
    }

    #[test]
    fn inverse_undoes() {
        let t = messy();
        let p = dvec3(1.0, -2.0, 30.0);
        assert!((t.inverse().point64(t.point64(p)) - p).length() < 1e-12);
        let both = t * t.inverse();
        for r in 0..4 {
            for c in 0..4 {
                assert!((both.m[r][c] - IDENTITY[r][c]).abs() < 1e-12);
            }
        }
        assert!(t.swaps_handedness());
    }

    #[test]
    fn normals_stay_orthogonal_to_tangents() {
        let t = messy();
        let (n, v) = (vec3(1.0, 2.0, 3.0), vec3(3.0, 0.0, -1.0));
        assert!(t.normal(n).normalize().dot(t.vector(v).normalize()).abs() < 1e-6);
    }

    #[test]
    fn quarter_turns_are_exact() {
        let t = Transform::rotate(90.0, [0.0, 0.0, 5.0]).unwrap();
        assert_eq!(t.point(vec3(1.0, 0.0, 0.25)), vec3(0.0, 1.0, 0.25));
        let back = Transform::rotate(-90.0, [0.0, 0.0, 5.0]).unwrap();
        assert_eq!(back.point(vec3(0.0, 1.0, 0.0)), vec3(1.0, 0.0, 0.0));
    }

    #[test]
    fn look_at_puts_the_target_ahead() {
        let t = Transform::look_at([278.0, 273.0, -800.0], [278.0, 273.0, 0.0], [0.0, 1.0, 0.0]).unwrap();
        assert_eq!(t.point(vec3(278.0, 273.0, 0.0)), vec3(0.0, 0.0, 800.0));
        assert_eq!(t.vector(vec3(0.0, 1.0, 0.0)), vec3(0.0, 1.0, 0.0));
        assert!(Transform::look_at([0.0; 3], [0.0, 1.0, 0.0], [0.0, 2.0, 0.0]).is_err());
    }

    #[test]
    fn singular_matrices_are_refused() {
        assert!(matches!(Transform::scale(1.0, 0.0, 1.0), Err(GeometryError::SingularTransform { .. })));
        assert!(Transform::new([[f64::NAN; 4]; 4]).is_err());
    }

    #[test]
    fn bounds_hold_every_mapped_point() {
        let (t, b) = (messy(), Bounds3::new(vec3(-1.0, 0.0, 2.0), vec3(1.0, 3.0, 2.0)));
        let image = t.bounds(b);
        assert!(image.contains(t.point(vec3(0.3, 1.7, 2.0))) && image.contains(t.point(b.lo)));
    }
}
