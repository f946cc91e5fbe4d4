//! Axis-aligned boxes.

use tyndall_base::{Vec3, vec::vec3};

/// The closed box from `lo` to `hi`; empty when some `lo > hi`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds3 {
    /// Least corner.
    pub lo: Vec3,
    /// Greatest corner.
    pub hi: Vec3,
}

impl Default for Bounds3 {
    fn default() -> Self {
        Self::EMPTY
    }
}

impl Bounds3 {
    /// The box that contains nothing: the neutral element of [`Self::union`].
    pub const EMPTY: Self = Self { lo: Vec3::splat(f32::INFINITY), hi: Vec3::splat(f32::NEG_INFINITY) };

    /// The smallest box with both points.
    #[inline(always)]
    pub fn new(a: Vec3, b: Vec3) -> Self {
        Self { lo: a.min(b), hi: a.max(b) }
    }

    /// The smallest box with all points.
    pub fn from_points(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, Self::with_point)
    }

    /// Grown to hold `p`.
    #[inline(always)]
    pub fn with_point(self, p: Vec3) -> Self {
        Self { lo: self.lo.min(p), hi: self.hi.max(p) }
    }

    /// The smallest box around both.
    #[inline(always)]
    pub fn union(self, b: Self) -> Self {
        Self { lo: self.lo.min(b.lo), hi: self.hi.max(b.hi) }
    }

    /// True when no point lies inside.
    #[inline(always)]
    pub fn is_empty(self) -> bool {
        self.lo.x > self.hi.x || self.lo.y > self.hi.y || self.lo.z > self.hi.z
    }

    /// The edges' lengths, zero for an empty box.
    #[inline(always)]
    pub fn extent(self) -> Vec3 {
        if self.is_empty() { Vec3::ZERO } else { self.hi - self.lo }
    }

    /// Half the surface area \[m^2\].
    #[inline(always)]
    pub fn half_area(self) -> f32 {
        let e = self.extent();
        e.x * (e.y + e.z) + e.y * e.z
    }

    /// The middle.
    #[inline(always)]
    pub fn centre(self) -> Vec3 {
        self.lo * 0.5 + self.hi * 0.5
    }

    /// True when `p` is inside or on the boundary.
    #[inline(always)]
    pub fn contains(self, p: Vec3) -> bool {
        (0..3).all(|k| self.lo[k] <= p[k] && p[k] <= self.hi[k])
    }

    /// Centre and radius of the sphere through the corners; radius zero for an empty box.
    pub fn bounding_sphere(self) -> (Vec3, f32) {
        if self.is_empty() { (Vec3::ZERO, 0.0) } else { (self.centre(), (self.hi - self.centre()).length()) }
    }

    /// The eight corners.
    pub fn corners(self) -> [Vec3; 8] {
        let pick = |bit: usize, k: usize| if bit & (1 << k) == 0 { self.lo[k] } else { self.hi[k] };
        std::array::from_fn(|i| vec3(pick(i, 0), pick(i, 1), pick(i, 2)))
    }

    /// Moved outwards by `pad` and then to the next `f32`, so that rounding cannot have cut anything off.
    #[inline]
    pub fn padded(self, pad: Vec3) -> Self {
        let (lo, hi) = (self.lo - pad, self.hi + pad);
        Self {
            lo: vec3(lo.x.next_down(), lo.y.next_down(), lo.z.next_down()),
            hi: vec3(hi.x.next_up(), hi.y.next_up(), hi.z.next_up()),
        }
    }

    /// The parameters at which `o + t d` is inside, clipped to `[0, t_max]`; `None` when it never is.
    #[inline]
    pub fn clip(self, o: Vec3, d: Vec3, t_max: f32) -> Option<(f32, f32)> {
        let (mut t0, mut t1) = (0.0f32, t_max);
        for k in 0..3 {
            let r = 1.0 / d[k];
            let (mut near, mut far) = ((self.lo[k] - o[k]) * r, (self.hi[k] - o[k]) * r);
            if near > far {
                std::mem::swap(&mut near, &mut far);
            }
            // a NaN (0 * inf: the ray runs within the slab's face) leaves the interval as it is
            t0 = if near > t0 { near } else { t0 };
            t1 = if far < t1 { far } else { t1 };
        }
        (t0 <= t1).then_some((t0, t1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_empty_box_is_neutral_and_has_no_area() {
        let b = Bounds3::new(vec3(1.0, -2.0, 3.0), vec3(-1.0, 2.0, 5.0));
        assert_eq!(Bounds3::EMPTY.union(b), b);
        assert_eq!(Bounds3::EMPTY.half_area(), 0.0);
        assert_eq!(b.half_area(), 2.0 * 4.0 + 2.0 * 2.0 + 4.0 * 2.0);
    }

    #[test]
    fn clipping_gives_the_chord() {
        let b = Bounds3::new(vec3(0.0, 0.0, 0.0), vec3(1.0, 1.0, 1.0));
        assert_eq!(b.clip(vec3(-1.0, 0.5, 0.5), vec3(1.0, 0.0, 0.0), 10.0), Some((1.0, 2.0)));
        assert_eq!(b.clip(vec3(0.5, 0.5, 0.5), vec3(0.0, 0.0, -2.0), 10.0), Some((0.0, 0.25)));
        assert_eq!(b.clip(vec3(-1.0, 1.5, 0.5), vec3(1.0, 0.0, 0.0), 10.0), None);
        assert_eq!(b.clip(vec3(-1.0, 0.5, 0.5), vec3(1.0, 0.0, 0.0), 0.5), None);
    }
}
