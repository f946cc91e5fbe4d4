//! Orthonormal frames: `z` is the normal.

use tyndall_base::{Vec3, vec::vec3};

/// A right-handed orthonormal basis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// First tangent.
    pub x: Vec3,
    /// Second tangent.
    pub y: Vec3,
    /// Normal.
    pub z: Vec3,
}

impl Frame {
    /// Some frame about the unit vector `z`, continuous but for `z.z = 0` (Duff et al. 2017, "Building an
    /// Orthonormal Basis, Revisited").
    #[inline(always)]
    pub fn from_z(z: Vec3) -> Self {
        let sign = 1.0f32.copysign(z.z);
        let a = -1.0 / (sign + z.z);
        let b = z.x * z.y * a;
        Self {
            x: vec3(1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x),
            y: vec3(b, sign + z.y * z.y * a, -z.y),
            z,
        }
    }

    /// The frame about the unit vector `z` whose `x` lies along the part of `x` orthogonal to `z`; some frame
    /// when there is no such part.
    #[inline]
    pub fn from_xz(x: Vec3, z: Vec3) -> Self {
        let across = x - z * x.dot(z);
        let l2 = across.length_squared();
        if l2 > 1e-12 * x.length_squared() && l2.is_finite() {
            // a second step removes what cancelled in the first
            let x = across * (1.0 / l2.sqrt());
            let x = (x - z * x.dot(z)).normalize();
            Self { x, y: z.cross(x), z }
        } else {
            Self::from_z(z)
        }
    }

    /// Coordinates of `v` in this frame.
    #[inline(always)]
    pub fn to_local(&self, v: Vec3) -> Vec3 {
        vec3(v.dot(self.x), v.dot(self.y), v.dot(self.z))
    }

    /// The vector with coordinates `v`.
    #[inline(always)]
    pub fn from_local(&self, v: Vec3) -> Vec3 {
        self.x * v.x + self.y * v.y + self.z * v.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_orthonormal(f: Frame) {
        for (a, b, want) in [
            (f.x, f.x, 1.0),
            (f.y, f.y, 1.0),
            (f.z, f.z, 1.0),
            (f.x, f.y, 0.0),
            (f.y, f.z, 0.0),
            (f.z, f.x, 0.0),
        ] {
            assert!((a.dot(b) - want).abs() < 1e-6, "{f:?}");
        }
        assert!((f.x.cross(f.y) - f.z).length() < 1e-6, "right-handed: {f:?}");
    }

    #[test]
    fn frames_are_orthonormal_right_handed_and_invert() {
        let mut directions = vec![vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, -1.0), vec3(1.0, 0.0, -0.0)];
        for i in 0..1000 {
            let k = |p: f32| (i as f32 * p).fract() * 2.0 - 1.0;
            directions.push(vec3(k(0.618), k(0.754), k(0.569) + 1e-3).normalize());
        }
        for z in directions {
            assert_orthonormal(Frame::from_z(z));
            let f = Frame::from_xz(vec3(0.3, -2.0, 0.1), z);
            assert_orthonormal(f);
            let v = vec3(0.2, 0.5, -0.7);
            assert!((f.from_local(f.to_local(v)) - v).length() < 1e-6);
        }
    }
}
