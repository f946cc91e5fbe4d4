//! The media under test, all named "m" and filling the unit cube.

use super::common::{Bands, Dialect, scene};

pub const BANDS: Bands = Bands::new(8);
pub const EXTINCTION: [f64; 8] = [4.0, 0.6, 2.5, 1.2, 3.3, 0.9, 1.8, 6.0];
pub const ALBEDO: [f64; 8] = [0.9, 0.4, 0.7, 0.95, 0.5, 0.8, 0.3, 0.6];
/// Of what stands around the cube.
pub const REFLECTANCE: [f64; 8] = [0.3, 0.6, 0.9, 0.5, 0.7, 0.4, 0.8, 0.2];
const LAMP: [f64; 8] = [1.5, 0.5, 1.0, 2.0, 0.3, 1.0, 1.5, 0.5];
const G: [f64; 8] = [0.7, -0.4, 0.0, 0.5, -0.3, 0.85, 0.2, -0.6];

/// Densities between 0 and 2 in no order, some of them zero.
pub fn densities(n: usize) -> Vec<f64> {
    let at = |i: usize| ((i * 2_654_435_761) >> 7) % 1000;
    (0..n).map(|i| if at(i) < 250 { 0.0 } else { 0.002 * at(i) as f64 }).collect()
}

/// Radiance 1 from everywhere.
pub fn sky() -> String {
    scene::sky(Dialect::Own)
}

/// A disk above the cube.
pub fn lamp() -> String {
    format!(
        "AttributeBegin\nAreaLightSource \"diffuse\" \"bool absolute\" true \"bool twosided\" true{}{}\n{}\
         Translate 0.2 0.3 1.6\nShape \"disk\" \"float radius\" 0.5\nAttributeEnd\n",
        BANDS.interpolation(),
        BANDS.step("L", &LAMP),
        scene::BLACK,
    )
}

pub fn numbers(name: &str, values: &[f64]) -> String {
    let text: Vec<String> = values.iter().map(f64::to_string).collect();
    format!(" \"float {name}\" [{}]", text.join(" "))
}

/// Spectra of the tests with the albedo `albedo`, times `scale`.
pub fn spectra(albedo: &[f64; 8], scale: f64) -> String {
    let part = |f: &dyn Fn(f64) -> f64| -> Vec<f64> {
        EXTINCTION.iter().zip(albedo).map(|(t, w)| scale * t * f(*w)).collect()
    };
    let (a, s) = (BANDS.step("sigma_a", &part(&|w| 1.0 - w)), BANDS.step("sigma_s", &part(&|w| w)));
    format!("{}{a}{s}", BANDS.interpolation())
}

pub fn phase() -> String {
    scene::asymmetry(&BANDS, &G)
}

pub fn medium(class: &str, parameters: &str) -> String {
    format!("MakeNamedMedium \"m\" \"string type\" \"{class}\"{parameters}\n")
}

pub fn uniform(albedo: &[f64; 8], more: &str) -> String {
    let dims = " \"integer nx\" 6 \"integer ny\" 5 \"integer nz\" 7";
    let density = numbers("density", &densities(210));
    medium("uniformgrid", &format!("{dims}{density}{}{}{more}", spectra(albedo, 1.5), phase()))
}

pub fn cloud(albedo: &[f64; 8], more: &str) -> String {
    let shape = " \"float density\" 2 \"float wispiness\" 1.5 \"float frequency\" 4";
    medium("cloud", &format!("{shape}{}{}{more}", spectra(albedo, 2.0), phase()))
}

pub fn spectral(albedo: &[f64; 8], more: &str) -> String {
    let dims = " \"integer nx\" 3 \"integer ny\" 4 \"integer nz\" 2";
    let edges: Vec<f64> = BANDS.edges().into_iter().map(f64::from).collect();
    // every voxel has its own order of the bands
    let pick = |i: usize, f: &dyn Fn(f64) -> f64| {
        let (voxel, band) = (i / 8, i % 8);
        let (t, w) = (EXTINCTION[(band + 3 * voxel) % 8], albedo[(band * 5 + voxel) % 8]);
        1.5 * densities(24)[voxel] * t * f(w)
    };
    let sigma_a: Vec<f64> = (0..192).map(|i| pick(i, &|w| 1.0 - w)).collect();
    let sigma_s: Vec<f64> = (0..192).map(|i| pick(i, &|w| w)).collect();
    let lists =
        [numbers("bands", &edges), numbers("sigma_a", &sigma_a), numbers("sigma_s", &sigma_s)].concat();
    medium("spectralgrid", &format!("{dims}{lists}{}{}{more}", BANDS.interpolation(), phase()))
}

/// Grey albedo: colours of a grid have no bands.
pub fn rgb(albedo: f64, more: &str) -> String {
    let dims = " \"integer nx\" 3 \"integer ny\" 2 \"integer nz\" 3";
    let colours = |factor: f64| -> String {
        let one = |v: &f64| format!("{} {} {} ", v * factor, 2.0 * v * factor, 0.5 * (2.0 - v) * factor);
        densities(18).iter().map(one).collect()
    };
    let scattering = format!(" \"rgb sigma_s\" [{}]", colours(1.5 * albedo));
    // an absent coefficient is one in pbrt
    let absorption = format!(" \"rgb sigma_a\" [{}]", colours(1.5 * (1.0 - albedo)));
    medium("rgbgrid", &format!("{dims}{scattering}{absorption}{}{}{more}", BANDS.interpolation(), phase()))
}

/// All of them with scattering and absorption.
pub fn all(more: &str) -> Vec<(&'static str, String)> {
    vec![
        ("uniformgrid", uniform(&ALBEDO, more)),
        ("cloud", cloud(&ALBEDO, more)),
        ("spectralgrid", spectral(&ALBEDO, more)),
        ("rgbgrid", rgb(0.7, more)),
        ("mixture", mixture(&ALBEDO, more)),
    ]
}

/// All of them without absorption.
pub fn conservative() -> Vec<(&'static str, String)> {
    vec![
        ("uniformgrid", uniform(&[1.0; 8], "")),
        ("cloud", cloud(&[1.0; 8], "")),
        ("spectralgrid", spectral(&[1.0; 8], "")),
        ("rgbgrid", rgb(1.0, "")),
        ("mixture", mixture(&[1.0; 8], "")),
    ]
}

/// The unit cube filled with "m".
pub fn cube() -> String {
    let shape = scene::cuboid([0.0; 3], [1.0; 3]);
    format!("AttributeBegin\nMediumInterface \"m\" \"\"\n{}\n{shape}AttributeEnd\n", scene::INTERFACE)
}

/// The scene with `parameters` of its integrator.
pub fn with_parameters(text: &str, parameters: &str) -> String {
    let bare = "Integrator \"volpath\"";
    assert!(text.contains(bare), "an integrator to switch");
    text.replace(bare, &format!("{bare} {parameters}"))
}

/// The whole cube seen askew.
pub fn camera() -> String {
    scene::camera(&BANDS, [3.0, 2.5, 4.0], [0.5; 3], 0.55)
}

/// Smoke and mist with spectra, densities and phase functions of their own, as one medium.
pub fn mixture(albedo: &[f64; 8], more: &str) -> String {
    let smoke = uniform(albedo, "").replace("MakeNamedMedium \"m\"", "MakeNamedMedium \"smoke\"");
    let mist = cloud(albedo, "").replace("MakeNamedMedium \"m\"", "MakeNamedMedium \"mist\"");
    let mist =
        mist.replace("\"henyey-greenstein\"", "\"schlick\"").replace("\"spectrum g\"", "\"spectrum k\"");
    format!("{smoke}{mist}{}", medium("mixture", &format!(" \"string media\" [\"smoke\" \"mist\"]{more}")))
}
