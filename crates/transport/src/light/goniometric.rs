//! `goniometric`: a point whose intensity depends on the direction, by an image or by a measured luminaire.
//!
//! I(d) = I profile(d). The image is square, in the equal-area octahedral parameterisation with y upwards, as in pbrt; a
//! photometric web (IES LM-63, type C) has its nadir along +z of the light's space, where pbrt's `spot` points by
//! default, and the plane of horizontal angle 0 towards +x.

use super::{LiSample, point::towards, sphere_to_square};
use crate::texture::Texels;
use std::f64::consts::PI;
use tyndall_base::{Vec3, math, vec::vec3};
use tyndall_geometry::Transform;
use tyndall_spectral::{Emission, Spectrum, Wavelengths};

/// Relative intensity over directions.
#[derive(Clone, Debug)]
pub enum Profile {
    /// One channel of a square image.
    Image(Texels),
    /// A grid of angles.
    Web(PhotometricWeb),
}

/// Intensities on a grid of polar and azimuthal angles, bilinear between them.
#[derive(Clone, Debug, PartialEq)]
pub struct PhotometricWeb {
    /// Polar angles from the nadir, ascending \[rad\]; nothing is emitted outside of them.
    pub polar: Vec<f32>,
    /// Azimuths, ascending from 0 to 2 pi \[rad\].
    pub azimuth: Vec<f32>,
    /// Intensity, polar angles fastest.
    pub values: Vec<f32>,
}

/// Parameters: see the module.
#[derive(Clone, Debug)]
pub struct GoniometricLight {
    /// Position \[m\].
    pub p: Vec3,
    /// Intensity where the profile is 1 \[W sr^-1 nm^-1\].
    pub intensity: Emission,
    /// The scene to the light's space.
    pub to_light: Transform,
    /// Relative intensity.
    pub profile: Profile,
}

impl GoniometricLight {
    /// See [`super::Light::sample_li`].
    #[inline]
    pub fn sample_li<const N: usize>(&self, from: Vec3, w: &Wavelengths<N>) -> Option<LiSample<N>> {
        towards(self.p, from, |d| self.intensity_along(d, w))
    }

    /// Intensity along the unit direction `d`.
    #[inline(never)]
    pub fn intensity_along<const N: usize>(&self, d: Vec3, w: &Wavelengths<N>) -> Spectrum<N> {
        let share = self.profile.eval(self.to_light.vector(d).normalize());
        if share == 0.0 { Spectrum::ZERO } else { self.intensity.sample(w) * share }
    }

    /// Integral of the profile over directions \[sr\].
    pub fn solid_angle(&self) -> f64 {
        self.profile.integral()
    }
}

impl Profile {
    /// Relative intensity along the unit direction `d` of the light's space.
    pub fn eval(&self, d: Vec3) -> f32 {
        match self {
            Self::Image(image) => {
                let [u, v] = sphere_to_square(vec3(d.x, d.z, d.y));
                let cell = |t: f32, n: usize| ((t * n as f32) as usize).min(n - 1);
                image.data[cell(v, image.height) * image.width + cell(u, image.width)]
            }
            Self::Web(web) => web.eval(d),
        }
    }

    /// Integral over directions \[sr\]: texels have equal solid angles; webs by the midpoint rule, a degree a step.
    pub fn integral(&self) -> f64 {
        let web = match self {
            Self::Image(image) => {
                let sum: f64 = image.data.iter().map(|v| f64::from(*v)).sum();
                return 4.0 * PI * sum / image.data.len() as f64;
            }
            Self::Web(web) => web,
        };
        let (rows, columns) = (360, 360);
        let row = |i: u32| {
            let theta = PI * (f64::from(i) + 0.5) / f64::from(rows);
            let at = |j: u32| {
                let phi = 2.0 * PI * (f64::from(j) + 0.5) / f64::from(columns);
                f64::from(web.at(theta as f32, phi as f32))
            };
            math::f64::sin(theta) * (0..columns).map(at).sum::<f64>()
        };
        (0..rows).map(row).sum::<f64>() * 2.0 * PI * PI / f64::from(rows * columns)
    }
}

impl PhotometricWeb {
    fn eval(&self, d: Vec3) -> f32 {
        let phi = math::atan2(d.y, d.x);
        let turn = 2.0 * std::f32::consts::PI;
        self.at(math::acos(d.z.clamp(-1.0, 1.0)), if phi < 0.0 { phi + turn } else { phi })
    }

    fn at(&self, theta: f32, phi: f32) -> f32 {
        let (first, last) = (self.polar[0], self.polar[self.polar.len() - 1]);
        // a hair of room for angles that went through radians and back
        if theta < first - 1e-5 || theta > last + 1e-5 {
            return 0.0;
        }
        let ((i, s), (j, t)) = (place(&self.polar, theta), place(&self.azimuth, phi));
        let column = |j: usize| {
            let at = |i: usize| self.values[j * self.polar.len() + i];
            let next = (i + 1).min(self.polar.len() - 1);
            (1.0 - s) * at(i) + s * at(next)
        };
        (1.0 - t) * column(j) + t * column((j + 1).min(self.azimuth.len() - 1))
    }
}

/// The interval of `x` and how far into it, clamped to the table.
fn place(knots: &[f32], x: f32) -> (usize, f32) {
    let i = knots.partition_point(|k| *k <= x).clamp(1, knots.len().max(2) - 1) - 1;
    let (a, b) = (knots[i], knots[(i + 1).min(knots.len() - 1)]);
    (i, if b > a { ((x - a) / (b - a)).clamp(0.0, 1.0) } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f32::consts::{FRAC_PI_2, TAU};
    use tyndall_base::{rng::Pcg32, warp};

    fn web() -> PhotometricWeb {
        // brightness falls from the nadir to the horizon, twice as fast towards +y
        PhotometricWeb {
            polar: vec![0.0, 0.5 * FRAC_PI_2, FRAC_PI_2],
            azimuth: vec![0.0, FRAC_PI_2, 2.0 * FRAC_PI_2, 3.0 * FRAC_PI_2, TAU],
            values: vec![8.0, 4.0, 0.0, 8.0, 2.0, 0.0, 8.0, 4.0, 0.0, 8.0, 4.0, 0.0, 8.0, 4.0, 0.0],
        }
    }

    #[test]
    fn a_web_gives_its_knots_and_what_is_between() {
        let profile = Profile::Web(web());
        let near = |d: Vec3, want: f32| {
            let got = profile.eval(d.normalize());
            assert!((got - want).abs() < 1e-3, "{d:?}: {got} for {want}");
        };
        near(vec3(0.0, 0.0, 1.0), 8.0);
        near(vec3(1.0, 0.0, 1.0), 4.0);
        near(vec3(0.0, 1.0, 1.0), 2.0);
        near(vec3(1.0, 1.0, std::f32::consts::SQRT_2), 3.0);
        near(vec3(0.0, -1.0, 1.0), 4.0);
        near(vec3(0.3, 0.2, -0.1), 0.0);
    }

    /// The integral against plain sampling of the sphere.
    #[test]
    fn integrals_agree_with_sampling() {
        let texels =
            Texels { width: 4, height: 4, channels: 1, data: (0..16).map(|i| (i * i % 7) as f32).collect() };
        for profile in [Profile::Web(web()), Profile::Image(texels)] {
            let mut rng = Pcg32::new(7, 1);
            let n = 200_000;
            let (mut sum, mut square) = (0.0, 0.0);
            for _ in 0..n {
                let v = f64::from(profile.eval(warp::sample_uniform_sphere(rng.next_2d()))) * 4.0 * PI;
                sum += v;
                square += v * v;
            }
            let mean = sum / f64::from(n);
            let error = ((square / f64::from(n) - mean * mean) / f64::from(n)).sqrt();
            assert!((mean - profile.integral()).abs() < 4.0 * error + 1e-3 * mean, "{mean} {error}");
        }
    }

    /// pbrt's image has y upwards: the centre of the square is +y of the light's space.
    #[test]
    fn the_centre_of_the_image_is_up() {
        let data = vec![0.0, 0.0, 0.0, 0.0, 5.0, 0.0, 0.0, 0.0, 0.0];
        let profile = Profile::Image(Texels { width: 3, height: 3, channels: 1, data });
        assert_eq!(profile.eval(vec3(0.0, 1.0, 0.0)), 5.0);
        assert_eq!(profile.eval(vec3(0.0, 0.0, 1.0)), 0.0);
    }
}
