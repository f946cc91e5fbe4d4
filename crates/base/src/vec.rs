//! Vectors of two and three `f32`. Plain products and sums, no contraction, so results do not depend on the target.

use std::ops::{Add, AddAssign, Div, Index, Mul, Neg, Sub, SubAssign};

/// A pair: film position, texture coordinates, a point of the unit square.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vec2 {
    /// First component.
    pub x: f32,
    /// Second component.
    pub y: f32,
}

/// A point, direction or normal in metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vec3 {
    /// First component.
    pub x: f32,
    /// Second component.
    pub y: f32,
    /// Third component.
    pub z: f32,
}

/// Shorthand for [`Vec2`].
#[inline(always)]
pub const fn vec2(x: f32, y: f32) -> Vec2 {
    Vec2 { x, y }
}

/// Shorthand for [`Vec3`].
#[inline(always)]
pub const fn vec3(x: f32, y: f32, z: f32) -> Vec3 {
    Vec3 { x, y, z }
}

impl Vec3 {
    /// The origin.
    pub const ZERO: Self = vec3(0.0, 0.0, 0.0);

    /// The three components set to `v`.
    #[inline(always)]
    pub const fn splat(v: f32) -> Self {
        vec3(v, v, v)
    }

    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, b: Self) -> f32 {
        self.x * b.x + self.y * b.y + self.z * b.z
    }

    /// `|self . b|`.
    #[inline(always)]
    pub fn abs_dot(self, b: Self) -> f32 {
        self.dot(b).abs()
    }

    /// Vector product.
    #[inline(always)]
    pub fn cross(self, b: Self) -> Self {
        vec3(self.y * b.z - self.z * b.y, self.z * b.x - self.x * b.z, self.x * b.y - self.y * b.x)
    }

    /// Squared Euclidean norm.
    #[inline(always)]
    pub fn length_squared(self) -> f32 {
        self.dot(self)
    }

    /// Euclidean norm.
    #[inline(always)]
    pub fn length(self) -> f32 {
        self.length_squared().sqrt()
    }

    /// The unit vector along `self` (not finite for the zero vector).
    #[inline(always)]
    pub fn normalize(self) -> Self {
        self * (1.0 / self.length())
    }

    /// Unit vectors `(t, b)` such that `(t, b, self)` is orthonormal and right-handed; `self` must be a unit vector.
    /// Duff et al. 2017, "Building an orthonormal basis, revisited", listing 3.
    #[inline(always)]
    pub fn tangents(self) -> (Self, Self) {
        let sign = 1.0_f32.copysign(self.z);
        let a = -1.0 / (sign + self.z);
        let b = self.x * self.y * a;
        (
            vec3(1.0 + sign * self.x * self.x * a, sign * b, -sign * self.x),
            vec3(b, sign + self.y * self.y * a, -self.y),
        )
    }

    /// Components' absolute values.
    #[inline(always)]
    pub fn abs(self) -> Self {
        vec3(self.x.abs(), self.y.abs(), self.z.abs())
    }

    /// Component-wise product.
    #[inline(always)]
    pub fn hadamard(self, b: Self) -> Self {
        vec3(self.x * b.x, self.y * b.y, self.z * b.z)
    }

    /// Component-wise minimum.
    #[inline(always)]
    pub fn min(self, b: Self) -> Self {
        vec3(self.x.min(b.x), self.y.min(b.y), self.z.min(b.z))
    }

    /// Component-wise maximum.
    #[inline(always)]
    pub fn max(self, b: Self) -> Self {
        vec3(self.x.max(b.x), self.y.max(b.y), self.z.max(b.z))
    }

    /// The greatest component.
    #[inline(always)]
    pub fn max_component(self) -> f32 {
        self.x.max(self.y.max(self.z))
    }

    /// True when no component is infinite or NaN.
    #[inline(always)]
    pub fn is_finite(self) -> bool {
        self.x.is_finite() && self.y.is_finite() && self.z.is_finite()
    }

    /// The components as an array.
    #[inline(always)]
    pub const fn to_array(self) -> [f32; 3] {
        [self.x, self.y, self.z]
    }
}

impl From<[f32; 3]> for Vec3 {
    #[inline(always)]
    fn from(a: [f32; 3]) -> Self {
        vec3(a[0], a[1], a[2])
    }
}

impl From<Vec3> for [f32; 3] {
    #[inline(always)]
    fn from(v: Vec3) -> Self {
        v.to_array()
    }
}

impl Index<usize> for Vec3 {
    type Output = f32;
    #[inline(always)]
    fn index(&self, axis: usize) -> &f32 {
        match axis {
            0 => &self.x,
            1 => &self.y,
            _ => &self.z,
        }
    }
}

macro_rules! linear {
    ($t:ident { $($f:ident),+ }) => {
        impl Add for $t {
            type Output = Self;
            #[inline(always)]
            fn add(self, b: Self) -> Self {
                Self { $($f: self.$f + b.$f),+ }
            }
        }
        impl Sub for $t {
            type Output = Self;
            #[inline(always)]
            fn sub(self, b: Self) -> Self {
                Self { $($f: self.$f - b.$f),+ }
            }
        }
        impl Neg for $t {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                Self { $($f: -self.$f),+ }
            }
        }
        impl Mul<f32> for $t {
            type Output = Self;
            #[inline(always)]
            fn mul(self, s: f32) -> Self {
                Self { $($f: self.$f * s),+ }
            }
        }
        impl Mul<$t> for f32 {
            type Output = $t;
            #[inline(always)]
            fn mul(self, v: $t) -> $t {
                v * self
            }
        }
        impl Div<f32> for $t {
            type Output = Self;
            #[inline(always)]
            fn div(self, s: f32) -> Self {
                Self { $($f: self.$f / s),+ }
            }
        }
        impl AddAssign for $t {
            #[inline(always)]
            fn add_assign(&mut self, b: Self) {
                *self = *self + b;
            }
        }
        impl SubAssign for $t {
            #[inline(always)]
            fn sub_assign(&mut self, b: Self) {
                *self = *self - b;
            }
        }
    };
}
linear!(Vec2 { x, y });
linear!(Vec3 { x, y, z });

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tangents_complete_a_right_handed_basis() {
        for n in [vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, -1.0), vec3(0.48, -0.6, -0.64), vec3(-0.8, 0.0, 0.6)] {
            let (t, b) = n.tangents();
            assert!(t.dot(n).abs() < 1e-6 && b.dot(n).abs() < 1e-6 && (t.length() - 1.0).abs() < 1e-6);
            assert!((t.cross(b) - n).length() < 1e-6);
        }
    }

    #[test]
    fn cross_is_orthogonal_and_right_handed() {
        assert_eq!(vec3(1.0, 0.0, 0.0).cross(vec3(0.0, 1.0, 0.0)), vec3(0.0, 0.0, 1.0));
        let (a, b) = (vec3(0.3, -1.2, 2.0), vec3(1.5, 0.25, -0.75));
        assert!(a.cross(b).dot(a).abs() < 1e-6 && a.cross(b).dot(b).abs() < 1e-6);
    }
}
