//! Ways to render: what ships, and each technique changed alone.

use tyndall::{
    Options, Spectral, WavelengthPdf,
    integrators::{Equiangular, Guiding, Settings},
    transport::sampler::SamplerKind,
};

/// A way to render.
#[derive(Debug)]
pub struct Variant {
    /// What is changed against the defaults.
    pub name: &'static str,
    /// The scene on which the default should win.
    pub wins_on: &'static str,
    pub options: fn(&mut Options),
    pub settings: fn(&mut Settings),
    /// Lights of no size are invisible to it.
    pub needs_sized_lights: bool,
}

/// What ships.
pub const DEFAULTS: Variant = settings("defaults", "", |_| {});

const fn settings(name: &'static str, wins_on: &'static str, settings: fn(&mut Settings)) -> Variant {
    Variant { name, wins_on, options: |_| {}, settings, needs_sized_lights: false }
}

const fn options(name: &'static str, wins_on: &'static str, options: fn(&mut Options)) -> Variant {
    Variant { name, wins_on, options, settings: |_| {}, needs_sized_lights: false }
}

/// Each technique changed alone.
pub const TECHNIQUES: &[Variant] = &[
    Variant {
        needs_sized_lights: true,
        ..settings("light sampling off", "empty-box", |s| s.light_sampling = false)
    },
    settings("exact transmittance off", "dark-fog", |s| s.exact_transmittance = false),
    settings("survival off", "dark-fog", |s| s.survival = false),
    options("media are no lights", "flame", |o| o.set.push("integrator.mediumlights=off".into())),
    options("media are lights everywhere", "", |o| o.set.push("integrator.mediumlights=always".into())),
    settings("equiangular off", "small-lamp", |s| s.equiangular = Equiangular::Off),
    settings("equiangular always", "cloud-box", |s| s.equiangular = Equiangular::Always),
    settings("equiangular on first segments only", "small-lamp", |s| s.equiangular_depth = 0),
    settings("path reuse off", "empty-box", |s| s.reuse = false),
    settings("light in common is shared, too", "cloud-grid", |s| s.level = false),
    options("skies are sampled everywhere", "cloud-grid", |o| o.set.push("integrator.skies=always".into())),
    settings("one light at a time", "room", |s| s.each_light = false),
    settings("balance heuristic", "room", |s| s.power = false),
    settings("no pixels refined", "beam", |s| s.refine = false),
    settings("guiding off", "beam", |s| s.guiding = Guiding::Off),
    settings("guiding and glow off", "fog-box", |s| (s.guiding, s.glow) = (Guiding::Off, false)),
    settings("cone clipping off", "beam", |s| s.cone_clipping = false),
    settings("roulette off", "dark-fog", |s| s.roulette_depth = u32::MAX),
    settings("independent sampler", "empty-box", |s| s.sampler = SamplerKind::Independent),
    options("1 wavelength", "fog-box", |o| o.spectral = Spectral::Hero { wavelengths: 1 }),
    options("4 wavelengths", "fog-box", |o| o.spectral = Spectral::Hero { wavelengths: 4 }),
    options("16 wavelengths", "empty-box", |o| o.spectral = Spectral::Hero { wavelengths: 16 }),
    options("wavelengths by eye", "tri-band", |o| o.wavelength_pdf = WavelengthPdf::Visible),
    options("wavelengths uniform", "tri-band", |o| o.wavelength_pdf = WavelengthPdf::Uniform),
];
