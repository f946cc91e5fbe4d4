//! Media: coefficients, albedo, optical depth.

use serde::Serialize;
use tyndall_io::LoadedScene;
use tyndall_spectral::{LambdaRange, Wavelengths};
use tyndall_transport::media::Medium;

/// A medium over the spectral range; pairs are least and greatest value.
#[derive(Clone, Debug, Serialize)]
pub struct MediumInfo {
    /// Its name.
    pub name: String,
    /// Its class.
    pub class: String,
    /// Absorption coefficient \[1/m\].
    pub sigma_a: [f32; 2],
    /// Scattering coefficient \[1/m\].
    pub sigma_s: [f32; 2],
    /// Extinction coefficient \[1/m\].
    pub sigma_t: [f32; 2],
    /// Single-scattering albedo; 0 where nothing is extinguished.
    pub albedo: [f32; 2],
    /// Mean cosine of the phase function.
    pub mean_cosine: [f32; 2],
    /// Optical depth along the diagonal of the scene.
    pub optical_depth: [f32; 2],
    /// Whether it emits.
    pub emits: bool,
}

/// All media; `diagonal` of the scene in m.
pub(super) fn media(loaded: &LoadedScene, range: LambdaRange, diagonal: f32) -> Vec<MediumInfo> {
    loaded.media.iter().zip(&loaded.scene.media).map(|(name, m)| medium(name, m, range, diagonal)).collect()
}

fn medium(name: &str, medium: &Medium, range: LambdaRange, diagonal: f32) -> MediumInfo {
    let mut all = [Span::EMPTY; 5];
    for lambda in wavelengths(range) {
        let w = Wavelengths::continuum([lambda], [1.0]);
        let m = medium.homogeneous(&w);
        let (a, s, t) = (m.sigma_a.hero(), m.sigma_s.hero(), m.sigma_t().hero());
        let albedo = if t > 0.0 { s / t } else { 0.0 };
        let values = [a, s, t, albedo, m.phase.mean_cosine(lambda)];
        all.iter_mut().zip(values).for_each(|(span, v)| span.add(v));
    }
    let [sigma_a, sigma_s, sigma_t, albedo, mean_cosine] = all.map(|s| [s.0, s.1]);
    MediumInfo {
        name: name.into(),
        class: match medium {
            Medium::Homogeneous(_) => "homogeneous".into(),
        },
        sigma_a,
        sigma_s,
        sigma_t,
        albedo,
        mean_cosine,
        optical_depth: sigma_t.map(|s| s * diagonal),
        emits: medium.emission().is_some(),
    }
}

/// Every nm of the range.
pub(super) fn wavelengths(range: LambdaRange) -> impl Iterator<Item = f32> {
    let steps = range.width().ceil().max(1.0) as usize;
    (0..=steps).map(move |i| range.min + range.width() * i as f32 / steps as f32)
}

#[derive(Clone, Copy)]
struct Span(f32, f32);

impl Span {
    const EMPTY: Self = Self(f32::INFINITY, f32::NEG_INFINITY);

    fn add(&mut self, v: f32) {
        (self.0, self.1) = (self.0.min(v), self.1.max(v));
    }
}
