//! Scenes whose luminance is known at every pixel: in closed form, or from a render of many more samples.

use super::common::{Bands, Dialect, scene};
use super::measure::{Mode, reseed, run};
use std::f64::consts::PI;
use std::path::Path;
use tyndall::{Options, Plan, Source, WavelengthPdf, plan};
use tyndall_spectral::{LambdaRange, cie};

const BANDS: Bands = Bands::new(8);
/// Of the renders that serve as truth.
const REFERENCE_SEED: u64 = 0x7ea5;

/// A scene and its answers.
pub struct Case {
    pub name: &'static str,
    /// `None` is the built-in fog box.
    text: Option<String>,
    side: u32,
    max_depth: Option<u32>,
    /// Y of each pixel.
    pub truth: Vec<f64>,
}

impl Case {
    /// All pixels of a scene in bands have the same answer.
    fn closed(name: &'static str, side: u32, max_depth: u32, bands: &[f64], text: String) -> Self {
        let truth = vec![luminance(bands); (side * side) as usize];
        Self { name, text: Some(text), side, max_depth: Some(max_depth), truth }
    }

    pub fn plan(&self, mode: Mode, spp: u32) -> Plan {
        let base = Options {
            spp: Some(spp),
            resolution: Some([self.side; 2]),
            errors: mode.errors(),
            target: mode.target(),
            max_depth: self.max_depth,
            ..Options::default()
        };
        let planned = match &self.text {
            None => plan(Source::BuiltIn, &base),
            Some(text) => {
                let edges = BANDS.edges();
                let range = LambdaRange { min: edges[0], max: edges[BANDS.count] };
                let options = Options { range, wavelength_pdf: WavelengthPdf::Light, ..base };
                plan(Source::Text("test.pbrt", text, Path::new("")), &options)
            }
        };
        planned.unwrap_or_else(|e| panic!("{}: {e}", self.name))
    }
}

/// Integral of a spectrum in bands with y-bar, whose table is linear between whole nm.
fn luminance(bands: &[f64]) -> f64 {
    let y = |nm: u32| f64::from(cie::y_bar().eval(nm as f32));
    let edges: Vec<u32> = BANDS.edges().iter().map(|&e| e as u32).collect();
    let integral = |e: &[u32]| (e[0]..e[1]).map(|nm| 0.5 * (y(nm) + y(nm + 1))).sum::<f64>();
    edges.windows(2).zip(bands).map(|(e, v)| v * integral(e)).sum()
}

/// The cases in closed form at `side` x `side` pixels.
pub fn closed_forms(side: u32) -> Vec<Case> {
    vec![slab_in_sunlight(side), conservative_ball(side), box_of_fog(side), sky_through_absorber(side)]
}

const TAU: [f64; 8] = [1.0, 0.2, 3.0, 0.5, 2.0, 0.1, 1.5, 0.8];
const G: [f64; 8] = [0.0, 0.5, -0.4, 0.8, 0.0, -0.7, 0.3, 0.6];

/// Single scattering of sunlight reflected by a slab (Chandrasekhar 1960).
fn slab_in_sunlight(side: u32) -> Case {
    let albedo = [0.8, 1.0, 0.5, 0.9, 0.3, 0.95, 0.7, 0.6];
    let (mu0, mu) = (0.5f64, 0.7f64);
    let cos = (1.0 - mu0 * mu0).sqrt() * (1.0 - mu * mu).sqrt() - mu * mu0;
    let phase = |g: f64| (1.0 - g * g) / (4.0 * PI * (1.0 + g * g - 2.0 * g * cos).powf(1.5));
    let radiance: Vec<f64> = (0..8)
        .map(|i| albedo[i] * phase(G[i]) * mu0 / (mu0 + mu) * -(-TAU[i] * (1.0 / mu0 + 1.0 / mu)).exp_m1())
        .collect();
    let sun = format!(
        "LightSource \"distant\" \"bool absolute\" true \"spectrum L\" [300 1 900 1] \"point3 from\" [{} 0 {mu0}] \
         \"point3 to\" [0 0 0]\n",
        -(1.0 - mu0 * mu0).sqrt()
    );
    let camera = scene::camera(&BANDS, [5.0 * (1.0 - mu * mu).sqrt(), 0.0, 5.0 * mu], [0.0; 3], 0.01);
    let medium = scene::medium(&BANDS, "m", &TAU, &albedo, &scene::asymmetry(&BANDS, &G));
    let text = format!("{camera}WorldBegin\n{sun}{medium}{}", scene::slab("m", scene::INTERFACE));
    Case::closed("slab, single scattering", side, 1, &radiance, text)
}

/// A ball that scatters and does not absorb, in a sky of radiance 1: a furnace.
fn conservative_ball(side: u32) -> Case {
    let camera = scene::camera(&BANDS, [0.0, 0.0, 5.0], [0.0; 3], 0.9);
    let medium = scene::medium(&BANDS, "m", &TAU, &[1.0; 8], &scene::asymmetry(&BANDS, &G));
    let text = format!(
        "{camera}WorldBegin\n{}{medium}{}",
        scene::sky(Dialect::Own),
        scene::ball("m", scene::INTERFACE)
    );
    Case::closed("furnace, ball", side, u32::MAX, &[1.0; 8], text)
}

/// Walls that emit and reflect around a fog that does not absorb: L = Le / (1 - rho).
fn box_of_fog(side: u32) -> Case {
    let (le, rho) = ([1.0, 2.0, 0.5, 1.0, 3.0, 0.7, 1.0, 0.3], [0.5, 0.1, 0.7, 0.5, 0.3, 0.6, 0.2, 0.8]);
    let radiance: Vec<f64> = le.iter().zip(rho).map(|(l, r)| l / (1.0 - r)).collect();
    let fog = scene::medium(&BANDS, "m", &TAU.map(|t| 0.5 * t), &[1.0; 8], &scene::asymmetry(&BANDS, &G));
    let camera = "LookAt 0.3 0.2 0.1  1 0.4 -0.2  0 1 0\nCamera \"perspective\" \"float fov\" 60\n";
    let text = format!(
        "{fog}MediumInterface \"\" \"m\"\n{camera}{}WorldBegin\nMediumInterface \"m\" \"\"\nMaterial \"diffuse\"{}{}\n\
         AreaLightSource \"diffuse\" \"bool absolute\" true \"bool twosided\" true{}{}\n{}",
        scene::film(&BANDS),
        BANDS.interpolation(),
        BANDS.step("reflectance", &rho),
        BANDS.interpolation(),
        BANDS.step("L", &le),
        scene::cuboid([-1.0; 3], [1.0; 3])
    );
    Case::closed("furnace, box with fog", side, u32::MAX, &radiance, text)
}

/// Beer-Lambert: the sky through a slab that absorbs.
fn sky_through_absorber(side: u32) -> Case {
    let mu: f64 = 0.5;
    let radiance: Vec<f64> = TAU.iter().map(|t| (-t / mu).exp()).collect();
    let medium = scene::medium(&BANDS, "m", &TAU, &[0.0; 8], "");
    let slab = scene::slab("m", scene::INTERFACE);
    let text = format!(
        "{}WorldBegin\n{}{medium}{slab}",
        scene::parallel_camera(&BANDS, -mu),
        scene::sky(Dialect::Own)
    );
    Case::closed("absorbing slab", side, u32::MAX, &radiance, text)
}

/// The built-in scene, whose tails are heavy: the lamp's rim, coloured walls, fog. `reference` samples per pixel make the truth.
pub fn fog(side: u32, reference: u32) -> Case {
    let mut case = Case { name: "built-in fog box", text: None, side, max_depth: None, truth: Vec::new() };
    let mut plan = case.plan(Mode::Conservative, reference);
    reseed(&mut plan, REFERENCE_SEED);
    case.truth = run(&plan).state.film.develop().y.iter().map(|&y| f64::from(y)).collect();
    case
}
