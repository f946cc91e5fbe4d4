//! Ways to render the same picture.

use crate::scenes::SmallScene;
use tyndall::{
    Options, Spectral, WavelengthPdf,
    integrators::{Equiangular, Guiding, Settings},
};
use tyndall_spectral::strategy::Rule;
use tyndall_transport::sampler::SamplerKind;

/// A way to render.
#[derive(Clone, Copy)]
pub struct Variant {
    pub name: &'static str,
    pub options: fn(&mut Options),
    pub settings: fn(&mut Settings),
    /// Samples against those of the scene: noisy and cheap variants take more.
    pub effort: u32,
    /// Draws hardly any wavelengths from the outermost bands: what few there are say nothing of their own error.
    pub blind_to_outer_bands: bool,
}

const fn with_options(name: &'static str, options: fn(&mut Options), effort: u32) -> Variant {
    Variant { name, options, settings: |_| {}, effort, blind_to_outer_bands: false }
}

const fn with_settings(name: &'static str, settings: fn(&mut Settings), effort: u32) -> Variant {
    Variant { name, options: |_| {}, settings, effort, blind_to_outer_bands: false }
}

/// What ships, with enough samples to be the common reference.
pub const REFERENCE: Variant = with_options("defaults", |_| {}, 6);

/// A photon's history: nothing of the path integrator's machinery.
const ANALOG: Variant = with_options("analog", |o| o.integrator = Some("analog".into()), 6);
/// The paper's algorithm.
const WANG_CHERN: Variant = with_options("wang-chern", |o| o.integrator = Some("wang-chern".into()), 6);
const FIXED_80: Variant = with_options(
    "opow, 80 wavelengths",
    |o| o.spectral = Spectral::Opow { set: Some((80, Rule::Midpoint)) },
    3,
);
const CONE_CLIPPING_OFF: Variant = with_settings("cone clipping off", |s| s.cone_clipping = false, 1);

/// Much at once that differs from the defaults.
pub const HERO_4_BY_FLIGHTS: Variant = Variant {
    name: "hero 4, uniform, equiangular always, transmittance by flights",
    options: |o| {
        o.spectral = Spectral::Hero { wavelengths: 4 };
        o.wavelength_pdf = WavelengthPdf::Uniform;
    },
    settings: |s| (s.equiangular, s.exact_transmittance) = (Equiangular::Always, false),
    effort: 2,
    blind_to_outer_bands: false,
};

const EVERYWHERE: &[Variant] = &[
    with_settings("light sampling off", |s| s.light_sampling = false, 3),
    with_settings("exact transmittance off", |s| s.exact_transmittance = false, 1),
    with_settings("survival off", |s| s.survival = false, 1),
    with_settings("equiangular off", |s| s.equiangular = Equiangular::Off, 1),
    with_settings("equiangular always", |s| s.equiangular = Equiangular::Always, 1),
    with_settings("equiangular on first segments", |s| s.equiangular_depth = 0, 1),
    with_settings("path reuse off", |s| s.reuse = false, 1),
    with_settings("path reuse off, equiangular always", reuse_off_equiangular, 1),
    with_settings("light in common is shared, too", |s| s.level = false, 1),
    with_settings("one light at a time", |s| s.each_light = false, 1),
    with_settings("balance heuristic", |s| s.power = false, 1),
    with_settings("no pixels refined", |s| s.refine = false, 1),
    with_settings("no pixels refined, path reuse off", |s| (s.refine, s.reuse) = (false, false), 1),
    with_settings("guiding always", |s| s.guiding = Guiding::Always, 1),
    with_settings("guiding off", |s| s.guiding = Guiding::Off, 1),
    with_settings("guiding and glow off", |s| (s.guiding, s.glow) = (Guiding::Off, false), 1),
    with_settings("roulette off", |s| s.roulette_depth = u32::MAX, 1),
    with_settings("fierce roulette", |s| (s.roulette_depth, s.roulette_threshold) = (0, 1.5), 2),
    with_settings("independent sampler", |s| s.sampler = SamplerKind::Independent, 1),
    with_options("hero 1", |o| o.spectral = Spectral::Hero { wavelengths: 1 }, 2),
    with_options("hero 4", |o| o.spectral = Spectral::Hero { wavelengths: 4 }, 1),
    with_options("hero 16", |o| o.spectral = Spectral::Hero { wavelengths: 16 }, 1),
    with_options("swc 4", |o| o.spectral = Spectral::Swc { wavelengths: 4 }, 2),
    with_options("swc 8", |o| o.spectral = Spectral::Swc { wavelengths: 8 }, 1),
    with_options("wang-chern, lights sampled", paper_with_lights, 3),
    with_options("opow, continuum", |o| o.spectral = Spectral::Opow { set: None }, 3),
    Variant {
        blind_to_outer_bands: true,
        ..with_options("wavelengths by eye", |o| o.wavelength_pdf = WavelengthPdf::Visible, 2)
    },
    with_options("wavelengths uniform", |o| o.wavelength_pdf = WavelengthPdf::Uniform, 1),
    // switches meet each other
    with_settings("survival and exact transmittance off, equiangular always", events_and_equiangular, 1),
    with_settings("all off", all_off, 3),
    HERO_4_BY_FLIGHTS,
];

fn reuse_off_equiangular(s: &mut Settings) {
    (s.reuse, s.equiangular) = (false, Equiangular::Always);
}

fn paper_with_lights(o: &mut Options) {
    o.integrator = Some("wang-chern".into());
    o.light_sampling = Some(true);
}

fn events_and_equiangular(s: &mut Settings) {
    (s.survival, s.exact_transmittance, s.equiangular) = (false, false, Equiangular::Always);
}

fn all_off(s: &mut Settings) {
    (s.light_sampling, s.survival, s.exact_transmittance) = (false, false, false);
    (s.equiangular, s.sampler, s.roulette_depth) = (Equiangular::Off, SamplerKind::Independent, u32::MAX);
}

/// All variants that the scene allows.
pub fn of(scene: &SmallScene) -> Vec<Variant> {
    let mut all = EVERYWHERE.to_vec();
    if scene.delta_lights {
        // no path meets the lights by chance
        all.retain(|v| !matches!(v.name, "light sampling off" | "all off"));
        all.push(CONE_CLIPPING_OFF);
    } else {
        all.extend([ANALOG, WANG_CHERN]);
    }
    if !scene.lines {
        all.push(FIXED_80);
    }
    all
}
