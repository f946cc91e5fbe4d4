//! `realistic`: a system of lenses between the film and the scene (Kolb, Mitchell, Hanrahan 1995, "A realistic camera
//! model for computer graphics").
//!
//! A point of the film sees the scene through the exit pupil. Points are drawn uniformly in a rectangle that bounds it on the
//! plane of the last element, and weighed so that the pixel is the film's irradiance,
//! `E = integral of L cos^4 theta / z^2 dA` \[W m^-2 nm^-1\], with z the distance from the film to that plane.

mod aperture;
mod lens;
mod pupil;

pub use aperture::Aperture;
pub use lens::{Element, Lens};

use super::{CameraSample, Projective};
use crate::{TransportError, error::check};
use pupil::ExitPupil;
use tyndall_base::{Vec3, vec::vec3};
use tyndall_geometry::Ray;

/// Parameters: see the module; of the projection, resolution and position count.
#[derive(Clone, Debug)]
pub struct Realistic {
    pub(super) projective: Projective,
    lens: Lens,
    aperture: Aperture,
    pupil: ExitPupil,
    /// Of the film \[m\].
    diagonal: f64,
}

impl Realistic {
    /// A film of `diagonal` \[m\] in the plane z = 0 of camera space behind `lens`.
    ///
    /// # Errors
    /// When the film is empty or no light reaches it.
    pub fn new(
        projective: Projective,
        lens: Lens,
        aperture: Aperture,
        diagonal: f64,
    ) -> Result<Self, TransportError> {
        check(diagonal > 0.0, "diagonal", "> 0 m", diagonal)?;
        let pupil = ExitPupil::new(&lens, &aperture, diagonal);
        if pupil.is_closed() {
            let why = "no light gets from the scene to any point of the film".into();
            return Err(TransportError::Unusable { what: "lens", why });
        }
        Ok(Self { projective: projective.validated()?, lens, aperture, pupil, diagonal })
    }

    /// The ray of `sample` and its weight: the irradiance that unit radiance along it adds to the film. Where the lens
    /// blocks the light the weight is 0, and the ray the one through the middle of the last element.
    #[inline(never)]
    pub fn sample(&self, sample: &CameraSample) -> (Ray, f32) {
        let film = self.on_film(sample);
        let blocked = || {
            let d = vec3(-film[0] as f32, -film[1] as f32, self.lens.rear() as f32);
            (self.projective.place(vec3(0.0, 0.0, self.lens.rear() as f32), d, sample.time), 0.0)
        };
        let r = (film[0] * film[0] + film[1] * film[1]).sqrt();
        let u = [f64::from(sample.lens.x), f64::from(sample.lens.y)];
        let Some((p, area)) = self.pupil.sample(2.0 * r / self.diagonal, u) else { return blocked() };
        // the pupil of the point on the x axis, turned to the film's point
        let (cos, sin) = if r > 0.0 { (film[0] / r, film[1] / r) } else { (1.0, 0.0) };
        let rear = self.lens.rear();
        let at = [cos * p[0] - sin * p[1], sin * p[0] + cos * p[1], rear];
        let d = [at[0] - film[0], at[1] - film[1], rear];
        let Some((o, out, transmission)) = self.lens.to_scene(film, d, &self.aperture) else {
            return blocked();
        };
        let cos2 = rear * rear / (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        let weight = transmission * area * cos2 * cos2 / (rear * rear);
        (self.projective.place(narrow(o), narrow(out), sample.time), weight as f32)
    }

    /// The film's point; the lens turns the picture over.
    fn on_film(&self, sample: &CameraSample) -> [f64; 3] {
        let [w, h] = self.projective.resolution.map(f64::from);
        let width = self.diagonal / (1.0 + (h / w) * (h / w)).sqrt();
        let (u, v) = (f64::from(sample.film.x) / w - 0.5, f64::from(sample.film.y) / h - 0.5);
        [-u * width, v * width * h / w, 0.0]
    }
}

fn narrow(v: [f64; 3]) -> Vec3 {
    vec3(v[0] as f32, v[1] as f32, v[2] as f32)
}

#[cfg(test)]
mod tests;
