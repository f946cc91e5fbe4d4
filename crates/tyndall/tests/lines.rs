//! Spectral lines beside a continuum: colour as a sum by hand, bands as power over width.

mod common;

use common::{
    Bands, Run,
    judge::{Family, pooled},
    scene,
};
use tyndall::WavelengthPdf;
use tyndall_spectral::{ColourSpace, SpaceName, cie};

/// 400 to 912 nm, so that the lines of sodium lie inside.
const BANDS: Bands = Bands::new(32);
/// Sodium's D lines, its green pair and a potassium line: wavelength \[nm\], power.
const LINES: [(f32, f64); 5] = [(589.0, 40.0), (589.59, 20.0), (568.82, 5.0), (498.28, 1.5), (766.49, 8.0)];
const CONTINUUM: f64 = 0.25;

fn lamp() -> String {
    let lines: Vec<String> = LINES.iter().map(|(l, p)| format!("{l} {p}")).collect();
    format!(
        "\"bool absolute\" true \"spectrum L\" [300 {CONTINUUM} 950 {CONTINUUM}] \"float lines\" [{}]",
        lines.join(" ")
    )
}

/// What a camera sees of radiance `transmittance(lambda)` times the lamp's: X, Y, Z and the bands' means per nm.
fn by_hand(transmittance: impl Fn(f32) -> f64) -> ([f64; 3], Vec<f64>) {
    let edges = BANDS.edges();
    let mut bands: Vec<f64> = edges
        .windows(2)
        .map(|e| {
            (0..160).map(|i| CONTINUUM * transmittance(e[0] + (i as f32 + 0.5) * 0.1)).sum::<f64>() / 160.0
        })
        .collect();
    let cmf = |lambda: f32| cie::matching_functions().each_ref().map(|c| f64::from(c.eval(lambda)));
    let mut xyz = [0.0; 3];
    let mut add =
        |lambda: f32, power: f64| xyz.iter_mut().zip(cmf(lambda)).for_each(|(s, c)| *s += power * c);
    for i in 0..51200 {
        let lambda = edges[0] + (i as f32 + 0.5) * 0.01;
        add(lambda, 0.01 * CONTINUUM * transmittance(lambda));
    }
    for (lambda, power) in LINES {
        add(lambda, power * transmittance(lambda));
        let band = edges.iter().filter(|e| **e <= lambda).count() - 1;
        bands[band] += power * transmittance(lambda) / f64::from(Bands::WIDTH);
    }
    (xyz, bands)
}

fn check(family: &mut Family, name: &str, run: &Run, text: &str, transmittance: impl Fn(f32) -> f64) {
    let (xyz, bands) = by_hand(transmittance);
    let got = pooled(&run.develop(text));
    let m = ColourSpace::get(SpaceName::Srgb).rgb_from_xyz.0;
    let rgb: Vec<f64> = m.iter().map(|row| row.iter().zip(xyz).map(|(a, b)| a * b).sum()).collect();
    family.bands(&format!("{name}, RGB"), &got[..3], &rgb);
    family.bands(name, &got[3..], &bands);
}

fn runs() -> [(&'static str, Run); 5] {
    let run = || Run::new(BANDS, 2048);
    [
        ("hero 8", run()),
        ("hero 8, uniform", Run { pdf: WavelengthPdf::Uniform, ..run() }),
        ("hero 8, light", Run { pdf: WavelengthPdf::Light, ..run() }),
        ("opow, light", Run { pdf: WavelengthPdf::Light, ..run().opow() }),
        ("analog, light", Run { pdf: WavelengthPdf::Light, ..run().analog() }),
    ]
}

#[test]
fn lamp_seen_directly() {
    let sky = format!("LightSource \"infinite\" {}\n", lamp());
    let text = format!("{}WorldBegin\n{sky}", scene::parallel_camera(&BANDS, -1.0));
    let mut family = Family::default();
    runs().iter().for_each(|(name, run)| check(&mut family, name, run, &text, |_| 1.0));
    family.assert(0.05);
}

/// An area lamp through a coloured absorber, met by chance; lines and continuum have their own transmittance.
#[test]
fn area_lamp_through_an_absorber() {
    let medium = "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"float sigma_s\" 0 \
                  \"spectrum sigma_a\" [390 2 920 0.1]\n";
    let panel = format!(
        "AreaLightSource \"diffuse\" \"bool twosided\" true {}\n{}{}",
        lamp(),
        scene::BLACK,
        scene::plane(-2.0)
    );
    let text = format!(
        "{}WorldBegin\n{medium}{}{panel}",
        scene::parallel_camera(&BANDS, -1.0),
        scene::slab("m", scene::INTERFACE)
    );
    let sigma = |lambda: f32| 2.0 + (0.1 - 2.0) * (f64::from(lambda) - 390.0) / 530.0;
    let mut family = Family::default();
    for (name, run) in runs() {
        let run = Run { spp: 4096, ..run };
        check(&mut family, name, &run, &text, |lambda| (-sigma(lambda)).exp());
    }
    family.assert(0.1);
}

/// A white floor under a point lamp: light sampling carries lines too.
#[test]
fn point_lamp_on_a_white_floor() {
    let lamp = lamp().replace("spectrum L", "spectrum I");
    let lamp = format!("LightSource \"point\" {lamp} \"point3 from\" [0 0 1]\n");
    let white = "Material \"diffuse\" \"spectrum reflectance\" [300 1 950 1]\n";
    let camera = scene::camera(&BANDS, [0.0, 0.0, 0.5], [0.0; 3], 1e-4);
    let text = format!("{camera}WorldBegin\n{lamp}{white}{}", scene::plane(0.0));
    let mut family = Family::default();
    for (name, run) in runs().iter().filter(|(n, _)| !n.starts_with("analog")) {
        check(&mut family, name, run, &text, |_| std::f64::consts::FRAC_1_PI);
    }
    family.assert(0.05);
}
