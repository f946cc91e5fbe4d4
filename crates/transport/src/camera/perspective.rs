//! `perspective`: central projection with an optional thin lens.
//!
//! `fov` is the full angle, in degrees, over the shorter side of the film, as in pbrt. A point (x, y) of the window
//! maps to the direction (x tan(fov/2), y tan(fov/2), 1) in camera space.

use super::{CameraSample, Projective};
use crate::{TransportError, error::check};
use tyndall_base::{Vec3, math, vec::vec3};
use tyndall_geometry::Ray;

/// Parameters: see the module.
#[derive(Clone, Debug)]
pub struct Perspective {
    pub(super) projective: Projective,
    /// tan(fov / 2).
    tan_half: f32,
}

impl Perspective {
    /// `fov` in degrees, 0 < fov < 180.
    pub fn new(projective: Projective, fov: f32) -> Result<Self, TransportError> {
        check(fov > 0.0 && fov < 180.0, "fov", "between 0 and 180 degrees", f64::from(fov))?;
        let half = f64::from(fov) * (std::f64::consts::PI / 360.0);
        Ok(Self { projective: projective.validated()?, tan_half: math::f64::tan(half) as f32 })
    }

    /// tan(fov / 2): half the shorter side of the default window, one metre before the camera \[m\].
    pub fn tan_half(&self) -> f32 {
        self.tan_half
    }

    /// See [`super::Camera::sample_ray`].
    #[inline]
    pub fn sample_ray(&self, sample: &CameraSample) -> Ray {
        let c = &self.projective;
        let screen = c.to_screen(sample.film) * self.tan_half;
        let mut o = Vec3::ZERO;
        let mut d = vec3(screen.x, screen.y, 1.0);
        if c.lens_radius > 0.0 {
            // thin lens: all rays of one film point meet in the plane of focus
            let lens = c.lens_point(sample.lens);
            let focus = d * c.focal_distance;
            o = vec3(lens.x, lens.y, 0.0);
            d = focus - o;
        }
        c.place(o, d, sample.time)
    }
}
