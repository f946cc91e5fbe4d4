//! `spherical`: all directions at once, as an equal-area octahedral square or in latitude and longitude.
//!
//! The image's vertical axis is the camera's y; in latitude and longitude the top row looks up, and the middle of the
//! left edge along +x.

use super::{CameraSample, Projective};
use crate::{TransportError, light::square_to_sphere};
use std::f32::consts::PI;
use tyndall_base::{Vec3, math, vec::vec3};
use tyndall_geometry::Ray;

/// How directions are laid out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SphericalMapping {
    /// Equal areas are equal solid angles (Clarberg 2008).
    #[default]
    EqualArea,
    /// Azimuth along x, polar angle along y.
    Equirectangular,
}

/// Parameters: see the module; of the projection, resolution and position count.
#[derive(Clone, Debug)]
pub struct Spherical {
    pub(super) projective: Projective,
    mapping: SphericalMapping,
}

impl Spherical {
    /// A camera at the origin of its space.
    ///
    /// # Errors
    /// When the film is empty.
    pub fn new(projective: Projective, mapping: SphericalMapping) -> Result<Self, TransportError> {
        Ok(Self { projective: projective.validated()?, mapping })
    }

    /// See [`super::Camera::sample_ray`].
    pub fn sample_ray(&self, sample: &CameraSample) -> Ray {
        let [w, h] = self.projective.resolution.map(|n| n as f32);
        let d = self.direction([sample.film.x / w, sample.film.y / h]);
        self.projective.place(Vec3::ZERO, d, sample.time)
    }

    /// The direction of a point of the image, from (0, 0) at the top left.
    fn direction(&self, [u, v]: [f32; 2]) -> Vec3 {
        let d = match self.mapping {
            SphericalMapping::EqualArea => square_to_sphere(wrapped([u, v])),
            SphericalMapping::Equirectangular => {
                let ((sin_t, cos_t), (sin_p, cos_p)) = (math::sin_cos(PI * v), math::sin_cos(2.0 * PI * u));
                vec3(sin_t * cos_p, sin_t * sin_p, cos_t)
            }
        };
        vec3(d.x, d.z, d.y)
    }
}

/// Points beyond an edge of the square, which a wide pixel filter asks for, are those next to it across the edge.
fn wrapped([mut u, mut v]: [f32; 2]) -> [f32; 2] {
    if !(0.0..=1.0).contains(&u) {
        u = if u < 0.0 { -u } else { 2.0 - u };
        v = 1.0 - v;
    }
    if !(0.0..=1.0).contains(&v) {
        v = if v < 0.0 { -v } else { 2.0 - v };
        u = 1.0 - u;
    }
    [u.clamp(0.0, 1.0), v.clamp(0.0, 1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_base::vec::vec2;
    use tyndall_geometry::Transform;

    fn camera(mapping: SphericalMapping) -> Spherical {
        let projective = Projective {
            resolution: [8, 4],
            screen: [-1.0, 1.0, -1.0, 1.0],
            lens_radius: 0.0,
            focal_distance: 1.0,
            to_world: Transform::translate(1.0, 2.0, 3.0),
            motion: None,
        };
        Spherical::new(projective, mapping).expect("valid")
    }

    fn look(mapping: SphericalMapping, x: f32, y: f32) -> Vec3 {
        let ray =
            camera(mapping).sample_ray(&CameraSample { film: vec2(x, y), lens: vec2(0.0, 0.0), time: 0.0 });
        assert_eq!(ray.o, vec3(1.0, 2.0, 3.0));
        ray.d
    }

    #[test]
    fn latitude_and_longitude() {
        use SphericalMapping::Equirectangular as E;
        let near = |a: Vec3, b: Vec3| assert!((a - b).length() < 1e-5, "{a:?} {b:?}");
        near(look(E, 3.0, 0.0), vec3(0.0, 1.0, 0.0));
        near(look(E, 0.0, 2.0), vec3(1.0, 0.0, 0.0));
        near(look(E, 2.0, 2.0), vec3(0.0, 0.0, 1.0));
        near(look(E, 4.0, 2.0), vec3(-1.0, 0.0, 0.0));
    }

    #[test]
    fn the_square_has_up_in_the_middle_and_is_whole() {
        use SphericalMapping::EqualArea as A;
        assert!((look(A, 4.0, 2.0) - vec3(0.0, 1.0, 0.0)).length() < 1e-5);
        assert!((look(A, 0.0, 0.0) - vec3(0.0, -1.0, 0.0)).length() < 1e-3);
        // across an edge is where the octahedron folds
        assert!((look(A, -0.1, 1.0) - look(A, 0.1, 3.0)).length() < 1e-4);
        assert!((look(A, 2.0, 4.1) - look(A, 6.0, 3.9)).length() < 1e-4);
    }
}
