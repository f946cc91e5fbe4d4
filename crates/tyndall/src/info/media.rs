//! Media: coefficients, albedo, optical depth.

use serde::Serialize;
use tyndall_base::{
    Vec3,
    vec::{vec2, vec3},
};
use tyndall_geometry::Ray;
use tyndall_io::LoadedScene;
use tyndall_spectral::{LambdaRange, Wavelengths};
use tyndall_transport::{
    media::{Heterogeneous, Medium, Painted},
    texture::TextureContext,
};

/// Wavelengths at which media that vary in space are looked at.
const SPECTRAL_POINTS: usize = 41;
/// Points along each axis of their box.
const LATTICE: usize = 16;

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
    /// Optical depth along the diagonal of the scene; where the medium varies, the greatest along the axes and a diagonal
    /// of its box.
    pub optical_depth: [f32; 2],
    /// Whether it emits.
    pub emits: bool,
}

/// All media; `diagonal` of the scene in m.
pub(super) fn media(loaded: &LoadedScene, range: LambdaRange, diagonal: f32) -> Vec<MediumInfo> {
    loaded.media.iter().zip(&loaded.scene.media).map(|(name, m)| medium(name, m, range, diagonal)).collect()
}

fn medium(name: &str, medium: &Medium, range: LambdaRange, diagonal: f32) -> MediumInfo {
    let mut all = [Span::EMPTY; 6];
    let mut add = |values: [f32; 6]| all.iter_mut().zip(values).for_each(|(span, v)| span.add(v));
    match medium {
        Medium::Homogeneous(m) => {
            for lambda in wavelengths(range) {
                let w = Wavelengths::continuum([lambda], [1.0]);
                let m = m.at(&w);
                let (a, s, t) = (m.sigma_a.hero(), m.sigma_s.hero(), m.sigma_t().hero());
                add([a, s, t, albedo(s, t), m.phase.mean_cosine(lambda), t * diagonal]);
            }
        }
        Medium::Heterogeneous(m) => varying(m, range, &mut add),
        Medium::Painted(m) => painted(m, range, diagonal, &mut add),
    }
    let [sigma_a, sigma_s, sigma_t, albedo, mean_cosine, optical_depth] = all.map(|s| [s.0, s.1]);
    MediumInfo {
        name: name.into(),
        class: match medium {
            Medium::Homogeneous(_) => "homogeneous".into(),
            Medium::Heterogeneous(m) => m.class().into(),
            Medium::Painted(_) => "by textures".into(),
        },
        sigma_a,
        sigma_s,
        sigma_t,
        albedo,
        mean_cosine,
        optical_depth,
        emits: medium.emission().is_some(),
    }
}

fn albedo(sigma_s: f32, sigma_t: f32) -> f32 {
    if sigma_t > 0.0 { sigma_s / sigma_t } else { 0.0 }
}

/// Coefficients on a lattice of points, optical depths along the longest lines through the middle of the box.
fn varying(m: &Heterogeneous, range: LambdaRange, add: &mut impl FnMut([f32; 6])) {
    let b = m.bounds();
    let (middle, extent) = (b.centre(), b.extent());
    let axes = [vec3(extent.x, 0.0, 0.0), vec3(0.0, extent.y, 0.0), vec3(0.0, 0.0, extent.z), extent];
    let step = range.width() / (SPECTRAL_POINTS - 1) as f32;
    for i in 0..SPECTRAL_POINTS {
        let lambda = (range.min + step * i as f32).min(range.max);
        let w = Wavelengths::continuum([lambda], [1.0]);
        let through = |v: Vec3| {
            let d = v * (1.0 / v.length());
            m.optical_depth(&Ray::new(middle - v * 0.5, d), v.length(), &w).hero()
        };
        let depth = axes.into_iter().map(through).fold(0.0, f32::max);
        for cell in 0..LATTICE * LATTICE * LATTICE {
            let at = |n: usize| (n % LATTICE) as f32 / LATTICE as f32 + 0.5 / LATTICE as f32;
            let u = vec3(at(cell), at(cell / LATTICE), at(cell / LATTICE / LATTICE));
            let p = b.lo + extent.hadamard(u);
            let point = m.at(p, &w);
            let (a, s) = (point.sigma_a.hero(), point.sigma_s.hero());
            add([a, s, a + s, albedo(s, a + s), m.mean_cosine(p, &w), depth]);
        }
    }
}

/// Coefficients for entries all over the unit square of texture coordinates.
fn painted(m: &Painted, range: LambdaRange, diagonal: f32, add: &mut impl FnMut([f32; 6])) {
    let step = range.width() / (SPECTRAL_POINTS - 1) as f32;
    for i in 0..SPECTRAL_POINTS {
        let lambda = (range.min + step * i as f32).min(range.max);
        let w = Wavelengths::continuum([lambda], [1.0]);
        for cell in 0..LATTICE * LATTICE {
            let at = |n: usize| ((n % LATTICE) as f32 + 0.5) / LATTICE as f32;
            let uv = vec2(at(cell), at(cell / LATTICE));
            let inside = m.at(&TextureContext { uv, ..TextureContext::ORIGIN }, &w);
            let (a, s, t) = (inside.sigma_a.hero(), inside.sigma_s.hero(), inside.sigma_t().hero());
            add([a, s, t, albedo(s, t), m.g, t * diagonal]);
        }
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
