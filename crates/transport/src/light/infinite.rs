//! `infinite` without an image: the same radiance \[W m^-2 sr^-1 nm^-1\] from all directions.

use super::LiSample;
use tyndall_base::warp;
use tyndall_spectral::{Emission, Wavelengths};

/// Parameters: see the module.
#[derive(Clone, Debug)]
pub struct UniformInfiniteLight {
    /// Radiance.
    pub emission: Emission,
}

impl UniformInfiniteLight {
    /// Directions are uniform over the sphere: 1/(4 pi).
    pub const PDF: f32 = 0.079_577_47;

    /// See [`super::Light::sample_li`].
    #[inline]
    pub fn sample_li<const N: usize>(&self, u: [f32; 2], w: &Wavelengths<N>) -> LiSample<N> {
        let wi = warp::sample_uniform_sphere(u);
        LiSample { l: self.emission.sample(w), wi, target: None, pdf: Self::PDF, delta: false }
    }
}
