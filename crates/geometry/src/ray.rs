//! A ray. It carries no wavelengths: those belong to the path.

use tyndall_base::Vec3;

/// The half-line `o + t d`, `0 < t <= t_max`. `d` need not be of unit length inside instances; in the scene it is.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Origin \[m\].
    pub o: Vec3,
    /// Direction.
    pub d: Vec3,
    /// Far end in units of `d`.
    pub t_max: f32,
    /// Time within the shutter, 0 to 1.
    pub time: f32,
}

impl Ray {
    /// The unbounded ray from `o` along `d`.
    #[inline(always)]
    pub fn new(o: Vec3, d: Vec3) -> Self {
        Self { o, d, t_max: f32::INFINITY, time: 0.0 }
    }

    /// The point at parameter `t`.
    #[inline(always)]
    pub fn at(&self, t: f32) -> Vec3 {
        self.o + self.d * t
    }
}
