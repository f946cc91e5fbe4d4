//! `infinite` without an image: the same radiance \[W m^-2 sr^-1 nm^-1\] from all directions.

use super::LiSample;
use tyndall_base::{Vec3, warp};
use tyndall_geometry::Frame;
use tyndall_spectral::{Emission, Wavelengths};

/// Parameters: see the module.
#[derive(Clone, Debug)]
pub struct UniformInfiniteLight {
    /// Radiance.
    pub emission: Emission,
}

impl UniformInfiniteLight {
    /// Density of directions \[1/sr\]: `cos / pi` over the half of the sphere around `half`, which is all that counts at a surface
    /// that reflects; uniform over the sphere where that is zero.
    #[inline(always)]
    pub fn pdf(half: Vec3, wi: Vec3) -> f32 {
        if half == Vec3::ZERO {
            warp::pdf_uniform_sphere()
        } else {
            warp::pdf_cosine_hemisphere(half.dot(wi))
        }
    }

    /// A direction with that density.
    #[inline(always)]
    pub fn sample_direction(half: Vec3, u: [f32; 2]) -> Vec3 {
        if half == Vec3::ZERO {
            warp::sample_uniform_sphere(u)
        } else {
            Frame::from_z(half).from_local(warp::sample_cosine_hemisphere(u))
        }
    }

    /// See [`super::Light::sample_li_beside_chance`].
    #[inline]
    pub fn sample_li<const N: usize>(&self, half: Vec3, u: [f32; 2], w: &Wavelengths<N>) -> LiSample<N> {
        let wi = Self::sample_direction(half, u);
        LiSample { l: self.emission.sample(w), wi, target: None, pdf: Self::pdf(half, wi), delta: false }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_base::vec::vec3;
    use tyndall_spectral::Curve;
    use tyndall_testkit::{Rng, chi2_sphere};

    #[test]
    fn directions_follow_their_density() {
        let light = UniformInfiniteLight { emission: Curve::Constant(1.0).into() };
        let w = Wavelengths::<1>::continuum([550.0], [1.0]);
        for (half, what) in [(Vec3::ZERO, "sphere"), (vec3(0.4, -0.7, -0.2).normalize(), "half")] {
            let draw = |rng: &mut Rng| {
                let s = light.sample_li(half, rng.f32x2(), &w);
                assert!(s.pdf == UniformInfiniteLight::pdf(half, s.wi) && s.l.hero() == 1.0);
                Some(s.wi.to_array())
            };
            let pdf = |[x, y, z]: [f32; 3]| f64::from(UniformInfiniteLight::pdf(half, vec3(x, y, z)));
            chi2_sphere(draw, pdf, 200_000, 3).assert_ok(what, 2);
        }
    }
}
