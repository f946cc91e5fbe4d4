//! `projection`: a point that throws an image, like a slide projector.
//!
//! The light looks along +z with +y up; `fov` spans the shorter side of the image. I(d) is the image's colour where d
//! crosses its plane (no inverse-square law over the plane: intensity is per solid angle, as in pbrt), 0 beside it.

use super::{LiSample, point::towards};
use crate::{
    TransportError,
    error::check,
    texture::{ImageMap, TextureContext},
};
use tyndall_base::{Vec3, math, vec::vec2};
use tyndall_geometry::Transform;
use tyndall_spectral::{Emission, Spectrum, Wavelengths};

/// Parameters: see the module.
#[derive(Clone, Debug)]
pub struct ProjectionLight {
    p: Vec3,
    to_light: Transform,
    image: ImageMap,
    mean: Emission,
    /// Half the image's width and height at distance 1.
    half: [f32; 2],
}

impl ProjectionLight {
    /// The image's colours are intensities \[W sr^-1 nm^-1\]; `mean` is their mean over the image.
    ///
    /// # Errors
    /// When `fov` is not between 0 and 180 degrees.
    pub fn new(
        to_world: &Transform,
        image: ImageMap,
        mean: Emission,
        fov: f32,
    ) -> Result<Self, TransportError> {
        check(fov > 0.0 && fov < 180.0, "fov", "between 0 and 180 degrees", f64::from(fov))?;
        let tan = math::f64::tan(f64::from(fov) * (std::f64::consts::PI / 360.0)) as f32;
        let aspect = image.texels.width as f32 / image.texels.height as f32;
        let half = if aspect > 1.0 { [tan * aspect, tan] } else { [tan, tan / aspect] };
        Ok(Self { p: to_world.point(Vec3::ZERO), to_light: to_world.inverse(), image, mean, half })
    }

    /// Position \[m\].
    pub fn p(&self) -> Vec3 {
        self.p
    }

    /// See [`super::Light::sample_li`].
    #[inline]
    pub fn sample_li<const N: usize>(&self, from: Vec3, w: &Wavelengths<N>) -> Option<LiSample<N>> {
        towards(self.p, from, |d| self.intensity_along(d, w))
    }

    /// Intensity along the direction `d`.
    #[inline(never)]
    pub fn intensity_along<const N: usize>(&self, d: Vec3, w: &Wavelengths<N>) -> Spectrum<N> {
        let d = self.to_light.vector(d);
        if d.z <= 0.0 {
            return Spectrum::ZERO;
        }
        let (x, y) = (d.x / (d.z * self.half[0]), d.y / (d.z * self.half[1]));
        if x.abs() > 1.0 || y.abs() > 1.0 {
            return Spectrum::ZERO;
        }
        let uv = vec2(0.5 * (x + 1.0), 0.5 * (y + 1.0));
        self.image.spectrum(&TextureContext { p: Vec3::ZERO, n: Vec3::ZERO, uv }, w)
    }

    /// Half the image's width and height at distance 1.
    pub fn half(&self) -> [f32; 2] {
        self.half
    }

    /// Solid angle of the image \[sr\].
    pub fn solid_angle(&self) -> f64 {
        let [a, b] = self.half.map(f64::from);
        // of a pyramid (Van Oosterom & Strackee 1983)
        4.0 * math::f64::atan2(a * b, (1.0 + a * a + b * b).sqrt())
    }

    /// Mean intensity over the image.
    pub fn mean_emission(&self) -> &Emission {
        &self.mean
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::{Lookup, Mapping, RgbKind, RgbRule, Texels, Wrap};
    use std::sync::Arc;
    use tyndall_base::{rng::Pcg32, vec::vec3, warp};
    use tyndall_spectral::{Curve, SpaceName};

    fn light() -> ProjectionLight {
        // 4 x 2 texels, one channel: 1 to 8 from the top left
        let texels = Texels { width: 4, height: 2, channels: 1, data: (1..=8).map(|i| i as f32).collect() };
        let image = ImageMap {
            texels: Arc::new(texels),
            mapping: Mapping::default(),
            wrap: Wrap::Clamp,
            lookup: Lookup::Point,
            scale: 1.0,
            invert: false,
            rule: RgbRule { space: SpaceName::Srgb, kind: RgbKind::Unbounded },
        };
        ProjectionLight::new(&Transform::translate(1.0, 0.0, 0.0), image, Curve::ONE.into(), 90.0)
            .expect("valid")
    }

    #[test]
    fn texels_land_where_the_slide_has_them() {
        let (light, w) = (light(), Wavelengths::<2>::continuum([500.0, 600.0], [1.0; 2]));
        let at = |x: f32, y: f32| light.intensity_along(vec3(x, y, 1.0).normalize(), &w)[0];
        // top left, top right, bottom left; the shorter side spans -1 to 1
        assert_eq!([at(-1.9, 0.9), at(1.9, 0.9), at(-1.9, -0.9)], [1.0, 4.0, 5.0]);
        assert_eq!([at(2.1, 0.0), at(0.0, 1.1)], [0.0, 0.0]);
        assert_eq!(light.intensity_along(vec3(0.0, 0.0, -1.0), &w)[1], 0.0);
    }

    #[test]
    fn solid_angle_by_sampling() {
        let (light, w) = (light(), Wavelengths::<1>::continuum([500.0], [1.0]));
        let mut rng = Pcg32::new(3, 3);
        let n = 100_000;
        let lit =
            (0..n).filter(|_| light.intensity_along(warp::sample_uniform_sphere(rng.next_2d()), &w)[0] > 0.0);
        let share = lit.count() as f64 / f64::from(n);
        let error = (share * (1.0 - share) / f64::from(n)).sqrt();
        let want = light.solid_angle() / (4.0 * std::f64::consts::PI);
        assert!((share - want).abs() < 4.0 * error, "{share} {want}");
    }
}
