//! `orthographic`: parallel projection with an optional thin lens; the window is in metres.

use super::{CameraSample, Projective};
use crate::TransportError;
use tyndall_base::vec::vec3;
use tyndall_geometry::Ray;

/// Parameters: see the module.
#[derive(Clone, Debug)]
pub struct Orthographic {
    pub(super) projective: Projective,
}

impl Orthographic {
    /// A camera that looks along +z of its space.
    pub fn new(projective: Projective) -> Result<Self, TransportError> {
        Ok(Self { projective: projective.validated()? })
    }

    /// See [`super::Camera::sample_ray`].
    #[inline]
    pub fn sample_ray(&self, sample: &CameraSample) -> Ray {
        let c = &self.projective;
        let screen = c.to_screen(sample.film);
        let mut o = vec3(screen.x, screen.y, 0.0);
        let mut d = vec3(0.0, 0.0, 1.0);
        if c.lens_radius > 0.0 {
            let lens = c.lens_point(sample.lens);
            let focus = o + d * c.focal_distance;
            o += vec3(lens.x, lens.y, 0.0);
            d = focus - o;
        }
        c.place(o, d, sample.time)
    }
}
