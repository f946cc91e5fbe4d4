//! Media that emit, with their points chosen as lights and without: known answers, and the same mean.

use super::common::{Run, judge::Family, scene};
use super::known::with_integrator;
use super::media::{self, ALBEDO, BANDS, EXTINCTION, REFLECTANCE};

const LE: [f64; 8] = [1.0, 2.0, 0.5, 1.0, 3.0, 0.7, 1.0, 0.3];

/// The scene with media as lights for no, some or all points.
fn choosing(text: &str, which: &str) -> String {
    media::with_parameters(text, &format!("\"string mediumlights\" \"{which}\""))
}

fn glow() -> String {
    format!(" \"bool absolute\" true{}", BANDS.step("Le", &LE))
}

/// Black bodies between 300 K and 2300 K, scaled to about one.
fn temperatures(count: usize) -> String {
    let kelvin: Vec<f64> = media::densities(count).iter().map(|d| 300.0 + 1000.0 * d).collect();
    let scale = 1.0 / tyndall_spectral::curve::planck(2000.0, 700.0);
    format!(" \"bool absolute\" true{} \"float Lescale\" {scale}", media::numbers("temperature", &kelvin))
}

/// All kinds of media that can emit.
fn glowing() -> Vec<(&'static str, String)> {
    let colours: String = (0..18).map(|i| format!("{} {} {} ", i % 3, 0.2, (i % 5) as f64 * 0.3)).collect();
    let smoke = |text: String| text.replacen("\"uniformgrid\"", &format!("\"uniformgrid\"{}", glow()), 1);
    vec![
        ("spectrum", media::uniform(&ALBEDO, &glow())),
        ("without scattering", media::uniform(&[0.0; 8], &glow())),
        ("temperatures", media::uniform(&ALBEDO, &temperatures(210))),
        ("colours", media::rgb(0.6, &format!(" \"bool absolute\" true \"rgb Le\" [{colours}]"))),
        ("one of two", smoke(media::mixture(&ALBEDO, ""))),
    ]
}

/// The cube between a floor and a wall, seen askew; `more` is other light.
fn room(medium: &str, more: &str) -> String {
    let matt = scene::diffuse(&BANDS, &REFLECTANCE);
    let wall = "Shape \"bilinearmesh\" \"point3 P\" [-0.4 -3 -3  -0.4 3 -3  -0.4 -3 3  -0.4 3 3]\n";
    let floor = scene::plane(-0.1);
    format!("{}WorldBegin\n{more}{medium}{}{matt}{floor}{wall}", media::camera(), media::cube())
}

#[test]
fn choosing_points_of_media_does_not_matter() {
    let mut family = Family::default();
    for (name, medium) in glowing() {
        let text = room(&medium, "");
        let off = Run::new(BANDS, 192).bands(&choosing(&text, "off"));
        for (seed, which) in [(2, "auto"), (3, "always")] {
            let run = Run::new(BANDS, 96).seed(seed);
            family.equal(&format!("{name}, {which}"), &run.bands(&choosing(&text, which)), &off);
        }
    }
    family.assert(0.3);
}

/// Beside lights at infinity, which points near what emits are left with.
#[test]
fn choosing_points_under_the_sky_does_not_matter() {
    let text = room(&media::uniform(&ALBEDO, &glow()), &media::sky());
    let off = Run::new(BANDS, 384).bands(&choosing(&text, "off"));
    let mut family = Family::default();
    for (seed, which) in [(2, "auto"), (3, "always")] {
        family.equal(which, &Run::new(BANDS, 256).seed(seed).bands(&choosing(&text, which)), &off);
    }
    family.assert(0.2);
}

/// Whatever is switched with it, lane by lane and for one wavelength alone.
#[test]
fn it_goes_with_every_estimator() {
    let text = room(&media::uniform(&ALBEDO, &glow()), "");
    let judge = Run::new(BANDS, 8192).analog().seed(9).bands(&text);
    let text = choosing(&text, "always");
    let mut family = Family::default();
    let switches =
        ["", "residualratio=false", "exacttransmittance=false", "survival=false", "russianroulette=false"];
    for (i, switch) in switches.into_iter().enumerate() {
        let run = Run::new(BANDS, 1024).seed(20 + i as u64);
        family.equal(switch, &run.bands(&with_integrator(&text, switch)), &judge);
    }
    family.equal("opow", &Run::new(BANDS, 2048).opow().bands(&text), &judge);
    family.equal("power", &Run::new(BANDS, 1024).seed(30).bands(&by_power(&text)), &judge);
    family.assert(0.1);
}

fn by_power(text: &str) -> String {
    text.replace("Integrator \"volpath\"", "Integrator \"volpath\" \"string lightsampler\" \"power\"")
}

/// A floor beside a cube that absorbs and emits but does not scatter: `rho / pi` times the integral over the hemisphere of
/// `le (1 - exp(-sigma_a chord)) cos`, by midpoints.
#[test]
fn floor_beside_a_glowing_cube() {
    let at = [1.5, 0.5, -0.1];
    let dims = " \"integer nx\" 2 \"integer ny\" 2 \"integer nz\" 2 \"string edge\" \"clamp\"";
    let ones = media::numbers("density", &[1.0; 8]);
    // a majorant above the density, so that there are null collisions
    let parameters =
        format!("{dims}{ones}{}{} \"float majorantscale\" 2", media::spectra(&[0.0; 8], 1.0), glow());
    let matt = scene::diffuse(&BANDS, &REFLECTANCE);
    let camera = scene::camera(&BANDS, [at[0], at[1], 5.0], at, 1e-4);
    let medium = media::medium("uniformgrid", &parameters);
    let text = format!("{camera}WorldBegin\n{medium}{}{matt}{}", media::cube(), scene::plane(at[2]));
    let expected = irradiated(at);
    let mut family = Family::default();
    for which in ["off", "auto", "always"] {
        for (i, switch) in ["", "residualratio=false", "exacttransmittance=false"].into_iter().enumerate() {
            let run = Run { max_depth: 1, ..Run::new(BANDS, 4096).seed(5 + i as u64) };
            let got = run.bands(&with_integrator(&choosing(&text, which), switch));
            family.bands(&format!("{which} {switch}"), &got, &expected);
        }
    }
    family.assert(0.05);
}

/// Radiance that a floor at `p` reflects, by 1500 x 1500 directions of equal projected solid angle.
fn irradiated(p: [f64; 3]) -> Vec<f64> {
    const N: usize = 1500;
    let mut sums = [0.0; 8];
    for i in 0..N {
        let sin = ((i as f64 + 0.5) / N as f64).sqrt();
        for j in 0..N {
            let (s, c) = (std::f64::consts::TAU * (j as f64 + 0.5) / N as f64).sin_cos();
            let chord = chord(p, [sin * c, sin * s, (1.0 - sin * sin).sqrt()]);
            if chord > 0.0 {
                for k in 0..8 {
                    sums[k] -= LE[k] * (-EXTINCTION[k] * chord).exp_m1();
                }
            }
        }
    }
    (0..8).map(|k| REFLECTANCE[k] * sums[k] / (N * N) as f64).collect()
}

/// Length of the ray from `p` along `d` in the unit cube.
fn chord(p: [f64; 3], d: [f64; 3]) -> f64 {
    let (mut t0, mut t1) = (0.0f64, f64::INFINITY);
    for k in 0..3 {
        let (a, b) = (-p[k] / d[k], (1.0 - p[k]) / d[k]);
        (t0, t1) = (t0.max(a.min(b)), t1.min(a.max(b)));
    }
    (t1 - t0).max(0.0)
}
