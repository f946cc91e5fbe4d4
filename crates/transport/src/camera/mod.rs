//! Cameras: a point of the film and of the lens to a ray of the scene.

mod orthographic;
mod perspective;
mod realistic;
mod spherical;

pub use orthographic::Orthographic;
pub use perspective::Perspective;
pub use realistic::{Aperture, Element, Lens, Realistic};
pub use spherical::{Spherical, SphericalMapping};

use crate::{TransportError, error::check};
use tyndall_base::{Vec2, Vec3, vec::vec2, warp};
use tyndall_geometry::{Motion, Ray, Transform};

/// Where on the film (pixels), on the lens (unit square) and within the shutter (0 to 1) a ray starts.
#[derive(Clone, Copy, Debug)]
pub struct CameraSample {
    /// Film position in pixels; the centre of the first pixel is (0.5, 0.5).
    pub film: Vec2,
    /// Point of the unit square that is warped to the lens.
    pub lens: Vec2,
    /// Shutter time as a fraction of the shutter interval.
    pub time: f32,
}

/// What all projective cameras share.
#[derive(Clone, Debug)]
pub struct Projective {
    /// Full resolution in pixels.
    pub resolution: [u32; 2],
    /// The film's rectangle on the plane one unit before the camera: `[x0, x1, y0, y1]`, y upwards.
    pub screen: [f32; 4],
    /// Radius of the thin lens \[m\]; 0 is a pinhole.
    pub lens_radius: f32,
    /// Distance of the plane in focus \[m\].
    pub focal_distance: f32,
    /// Camera space (x right, y up, z forward) to the scene, when the shutter opens.
    pub to_world: Transform,
    /// How that changes while the shutter is open.
    pub motion: Option<Box<Motion>>,
}

impl Projective {
    /// pbrt's default window: the shorter side spans -1 to 1; `frame_aspect` overrides width over height.
    pub fn default_screen(resolution: [u32; 2], frame_aspect: Option<f32>) -> [f32; 4] {
        let aspect = frame_aspect.unwrap_or(resolution[0] as f32 / resolution[1] as f32);
        if aspect > 1.0 { [-aspect, aspect, -1.0, 1.0] } else { [-1.0, 1.0, -1.0 / aspect, 1.0 / aspect] }
    }

    /// Refuses empty films and windows, negative lenses and focal planes behind the camera.
    pub fn validated(self) -> Result<Self, TransportError> {
        let [w, h] = self.resolution;
        check(w > 0 && h > 0, "film resolution", "at least 1 x 1 pixels", f64::from(w.min(h)))?;
        let [x0, x1, y0, y1] = self.screen;
        check(x0 < x1, "screenwindow", "x0 < x1", f64::from(x1 - x0))?;
        check(y0 < y1, "screenwindow", "y0 < y1", f64::from(y1 - y0))?;
        check(self.lens_radius >= 0.0, "lensradius", ">= 0 m", f64::from(self.lens_radius))?;
        check(self.focal_distance > 0.0, "focaldistance", "> 0 m", f64::from(self.focal_distance))?;
        Ok(self)
    }

    /// Pixels to the window; the film's first row is the top.
    #[inline(always)]
    fn to_screen(&self, film: Vec2) -> Vec2 {
        let [x0, x1, y0, y1] = self.screen;
        let (u, v) = (film.x / self.resolution[0] as f32, film.y / self.resolution[1] as f32);
        vec2(x0 + u * (x1 - x0), y1 - v * (y1 - y0))
    }

    /// The window to pixels.
    fn to_film(&self, screen: Vec2) -> Vec2 {
        let [x0, x1, y0, y1] = self.screen;
        let (u, v) = ((screen.x - x0) / (x1 - x0), (y1 - screen.y) / (y1 - y0));
        vec2(u * self.resolution[0] as f32, v * self.resolution[1] as f32)
    }

    /// The ray from `o` along `d`, both in camera space.
    #[inline(always)]
    fn place(&self, o: Vec3, d: Vec3, time: f32) -> Ray {
        let moved;
        let to_world = match &self.motion {
            None => &self.to_world,
            Some(motion) => {
                moved = motion.at(time);
                &moved
            }
        };
        Ray { time, ..Ray::new(to_world.point(o), to_world.vector(d).normalize()) }
    }

    #[inline(always)]
    fn lens_point(&self, lens: Vec2) -> Vec2 {
        warp::sample_concentric_disk([lens.x, lens.y]) * self.lens_radius
    }
}

/// Any camera.
#[derive(Clone, Debug)]
pub enum Camera {
    /// Central projection.
    Perspective(Perspective),
    /// Parallel projection.
    Orthographic(Orthographic),
    /// All directions.
    Spherical(Spherical),
    /// Through a system of lenses.
    Realistic(Box<Realistic>),
}

impl Camera {
    /// The ray through `sample`, with unit direction, and what unit radiance along it gives the pixel: 1, but behind a
    /// system of lenses, where it is 0 for a ray that they block.
    #[inline]
    pub fn sample(&self, sample: &CameraSample) -> (Ray, f32) {
        match self {
            Self::Perspective(c) => (c.sample_ray(sample), 1.0),
            Self::Orthographic(c) => (c.sample_ray(sample), 1.0),
            Self::Spherical(c) => (c.sample_ray(sample), 1.0),
            Self::Realistic(c) => c.sample(sample),
        }
    }

    /// The ray of [`Self::sample`].
    #[inline]
    pub fn sample_ray(&self, sample: &CameraSample) -> Ray {
        self.sample(sample).0
    }

    /// Where on the film \[pixels\] a point of the scene is seen, when the shutter opens and from the middle of the lens; `None`
    /// behind the camera, and for cameras that do not map lines to lines.
    pub fn project(&self, p: Vec3) -> Option<Vec2> {
        let projective = self.projective();
        let p = projective.to_world.inverse().point(p);
        match self {
            Self::Perspective(c) if p.z > 0.0 => {
                let scale = 1.0 / (p.z * c.tan_half());
                Some(projective.to_film(vec2(p.x, p.y) * scale))
            }
            Self::Orthographic(_) if p.z > 0.0 => Some(projective.to_film(vec2(p.x, p.y))),
            _ => None,
        }
    }

    /// Film resolution in pixels.
    pub fn resolution(&self) -> [u32; 2] {
        self.projective().resolution
    }

    /// Camera space to the scene.
    pub fn to_world(&self) -> &Transform {
        &self.projective().to_world
    }

    /// The same camera for another number of pixels; a window that was the default one follows the new aspect.
    pub fn resized(mut self, resolution: [u32; 2]) -> Self {
        let p = self.projective_mut();
        if p.screen == Projective::default_screen(p.resolution, None) {
            p.screen = Projective::default_screen(resolution, None);
        }
        p.resolution = resolution;
        self
    }

    /// What all projective cameras share.
    pub fn projective(&self) -> &Projective {
        match self {
            Self::Perspective(c) => &c.projective,
            Self::Orthographic(c) => &c.projective,
            Self::Spherical(c) => &c.projective,
            Self::Realistic(c) => &c.projective,
        }
    }

    fn projective_mut(&mut self) -> &mut Projective {
        match self {
            Self::Perspective(c) => &mut c.projective,
            Self::Orthographic(c) => &mut c.projective,
            Self::Spherical(c) => &mut c.projective,
            Self::Realistic(c) => &mut c.projective,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_on_a_ray_are_projected_to_where_it_starts() {
        let to_world = Transform::look_at([1.0, 2.0, 5.0], [0.3, -0.2, 0.1], [0.0, 1.0, 0.1]).unwrap();
        let projective = || Projective {
            resolution: [64, 48],
            screen: [-1.5, 1.2, -1.0, 0.8],
            lens_radius: 0.0,
            focal_distance: 1e6,
            to_world,
            motion: None,
        };
        let cameras = [
            Camera::Perspective(Perspective::new(projective(), 40.0).unwrap()),
            Camera::Orthographic(Orthographic::new(projective()).unwrap()),
        ];
        for camera in cameras {
            for film in [vec2(3.25, 40.5), vec2(60.0, 1.0), vec2(32.0, 24.0)] {
                let ray = camera.sample_ray(&CameraSample { film, lens: vec2(0.5, 0.5), time: 0.0 });
                let seen = camera.project(ray.at(3.7)).expect("before the camera");
                assert!((seen.x - film.x).hypot(seen.y - film.y) < 1e-3, "{seen:?} is not {film:?}");
                assert!(camera.project(ray.at(-3.7)).is_none());
            }
        }
    }
}
