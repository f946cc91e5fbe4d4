//! Particles that leave a light: what learning where light comes from begins with.

use super::{Light, Target};
use crate::{MediumId, Scene};
use tyndall_base::{Vec3, vec::vec2, warp};
use tyndall_geometry::{Frame, Ray, spawn_origin};
use tyndall_spectral::{Spectrum, Wavelengths};

/// A particle on its way.
#[derive(Clone, Copy, Debug)]
pub struct Particle<const N: usize> {
    /// Where it goes.
    pub ray: Ray,
    /// The medium it starts in, as far as the light tells; the camera's otherwise.
    pub medium: MediumId,
    /// Power per lane over the particle's density \[W nm^-1\].
    pub power: Spectrum<N>,
}

impl Light {
    /// A particle of this light: `u_y` chooses the point, `u_d` the direction. Lights at infinity send theirs through a
    /// disk as large as the scene. `None` where nothing is emitted.
    pub fn emit<const N: usize>(
        &self,
        scene: &Scene,
        u_y: [f32; 2],
        u_d: [f32; 2],
        w: &Wavelengths<N>,
    ) -> Option<Particle<N>> {
        let Some(y) = self.sample_position(&scene.accel, u_y) else {
            return self.distant_particle(scene, u_y, u_d, w);
        };
        let (d, inverse_pdf) = self.direction(&y.target, u_d);
        let power = self.emitted_along(&y, d, w) * (inverse_pdf / y.target.pdf_area);
        let o = spawn_origin(y.target.p, &y.target.rounding, y.target.n, d);
        let particle = Particle { ray: Ray::new(o, d), medium: self.medium_at(scene, &y.target, d), power };
        (power.is_finite() && !power.is_zero()).then_some(particle)
    }

    /// A direction from a point of the light, with projected solid angle (areas) or solid angle (points) over density.
    fn direction(&self, y: &Target, u: [f32; 2]) -> (Vec3, f32) {
        const PI: f32 = std::f32::consts::PI;
        match self {
            Self::Area(l) => {
                let back = l.two_sided && u[0] < 0.5;
                let stretched = if l.two_sided { [(2.0 * u[0]).fract(), u[1]] } else { u };
                let local = warp::sample_cosine_hemisphere(stretched);
                let frame = Frame::from_z(if back { -y.n } else { y.n });
                (frame.from_local(local), PI * l.sides() as f32)
            }
            Self::Spot(l) => {
                let height = 1.0 - l.cos_end;
                let d = Frame::from_z(l.axis).from_local(warp::sample_uniform_cone(u, height));
                (d, 2.0 * PI * height)
            }
            _ => (warp::sample_uniform_sphere(u), 4.0 * PI),
        }
    }

    fn distant_particle<const N: usize>(
        &self,
        scene: &Scene,
        u_y: [f32; 2],
        u_d: [f32; 2],
        w: &Wavelengths<N>,
    ) -> Option<Particle<N>> {
        let (centre, radius) = scene.accel.bounds().bounding_sphere();
        let s = self.sample_li(&scene.accel, centre, u_d, w)?;
        let on = warp::sample_concentric_disk(u_y);
        let on = vec2(on.x * radius, on.y * radius);
        let frame = Frame::from_z(s.wi);
        let o = centre + s.wi * radius + frame.x * on.x + frame.y * on.y;
        let power = s.l * (std::f32::consts::PI * radius * radius / s.pdf);
        let particle = Particle { ray: Ray::new(o, -s.wi), medium: scene.camera_medium, power };
        (power.is_finite() && !power.is_zero() && o.is_finite()).then_some(particle)
    }

    fn medium_at(&self, scene: &Scene, y: &Target, d: Vec3) -> MediumId {
        let boundary = match self {
            Self::Area(l) => scene.shapes[l.shape as usize].boundary,
            _ => None,
        };
        boundary.map_or(scene.camera_medium, |b| if y.n.dot(d) > 0.0 { b.outside } else { b.inside })
    }
}
