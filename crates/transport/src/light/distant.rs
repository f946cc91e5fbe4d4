//! `distant`: parallel light; `emission` is the irradiance \[W m^-2 nm^-1\] on a plane that faces it.

use super::LiSample;
use tyndall_base::Vec3;
use tyndall_spectral::{Emission, Wavelengths};

/// Parameters: see the module.
#[derive(Clone, Debug)]
pub struct DistantLight {
    /// Unit direction *towards* the light.
    pub towards: Vec3,
    /// Irradiance at normal incidence.
    pub emission: Emission,
}

impl DistantLight {
    /// See [`super::Light::sample_li`].
    #[inline]
    pub fn sample_li<const N: usize>(&self, w: &Wavelengths<N>) -> LiSample<N> {
        LiSample { l: self.emission.sample(w), wi: self.towards, target: None, pdf: 1.0, delta: true }
    }
}
