//! Three `f64`: hit points and transforms are worked out in double and rounded once.

use std::ops::{Add, Mul, Neg, Sub};
use tyndall_base::{Vec3, vec::vec3};

/// A vector of three `f64`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DVec3 {
    /// First component.
    pub x: f64,
    /// Second component.
    pub y: f64,
    /// Third component.
    pub z: f64,
}

/// Shorthand for [`DVec3`].
#[inline(always)]
pub const fn dvec3(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3 { x, y, z }
}

impl DVec3 {
    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, b: Self) -> f64 {
        self.x * b.x + self.y * b.y + self.z * b.z
    }

    /// Vector product.
    #[inline(always)]
    pub fn cross(self, b: Self) -> Self {
        dvec3(self.y * b.z - self.z * b.y, self.z * b.x - self.x * b.z, self.x * b.y - self.y * b.x)
    }

    /// Squared Euclidean norm.
    #[inline(always)]
    pub fn length_squared(self) -> f64 {
        self.dot(self)
    }

    /// Euclidean norm.
    #[inline(always)]
    pub fn length(self) -> f64 {
        self.length_squared().sqrt()
    }

    /// The unit vector along `self` (not finite for the zero vector).
    #[inline(always)]
    pub fn normalize(self) -> Self {
        self * (1.0 / self.length())
    }

    /// Components' absolute values.
    #[inline(always)]
    pub fn abs(self) -> Self {
        dvec3(self.x.abs(), self.y.abs(), self.z.abs())
    }

    /// Component-wise minimum.
    #[inline(always)]
    pub fn min(self, b: Self) -> Self {
        dvec3(self.x.min(b.x), self.y.min(b.y), self.z.min(b.z))
    }

    /// Component-wise maximum.
    #[inline(always)]
    pub fn max(self, b: Self) -> Self {
        dvec3(self.x.max(b.x), self.y.max(b.y), self.z.max(b.z))
    }

    /// The components as an array.
    #[inline(always)]
    pub const fn to_array(self) -> [f64; 3] {
        [self.x, self.y, self.z]
    }

    /// Rounded to the nearest `f32`.
    #[inline(always)]
    pub fn round(self) -> Vec3 {
        vec3(self.x as f32, self.y as f32, self.z as f32)
    }
}

impl From<Vec3> for DVec3 {
    #[inline(always)]
    fn from(v: Vec3) -> Self {
        dvec3(f64::from(v.x), f64::from(v.y), f64::from(v.z))
    }
}

impl Add for DVec3 {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        dvec3(self.x + b.x, self.y + b.y, self.z + b.z)
    }
}

impl Sub for DVec3 {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        dvec3(self.x - b.x, self.y - b.y, self.z - b.z)
    }
}

impl Mul<f64> for DVec3 {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: f64) -> Self {
        dvec3(self.x * s, self.y * s, self.z * s)
    }
}

impl Neg for DVec3 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        dvec3(-self.x, -self.y, -self.z)
    }
}
