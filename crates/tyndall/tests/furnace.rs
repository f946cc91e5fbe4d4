//! Furnaces: what neither absorbs nor emits cannot be seen in uniform light, and what is in equilibrium glows alike.

mod common;

use common::{Bands, Run, judge::Family, scene};

const BANDS: Bands = Bands { count: 8 };
const G: [f64; 8] = [-0.9, 0.95, 0.0, 0.5, -0.3, 0.85, 0.2, -0.6];

/// sigma_s = 5 (550 nm / lambda)^4.
fn rayleigh_law() -> Vec<f64> {
    BANDS.edges().windows(2).map(|e| 5.0 * (550.0 / (0.5 * f64::from(e[0] + e[1]))).powi(4)).collect()
}

fn phases() -> [(&'static str, String); 3] {
    [
        ("henyey-greenstein", scene::asymmetry(&BANDS, &G)),
        ("isotropic", " \"string phase\" \"isotropic\"".into()),
        ("rayleigh", " \"string phase\" \"rayleigh\"".into()),
    ]
}

/// A conservative sphere in a sky of radiance 1.
fn ball_in_the_sky(sigma: &[f64], phase: &str, material: &str) -> String {
    let camera = scene::camera([0.0, 0.0, 5.0], [0.0; 3], 0.9);
    let medium = scene::medium(&BANDS, "m", sigma, &[1.0; 8], phase);
    format!("{camera}WorldBegin\n{}{medium}{}", scene::SKY, scene::ball("m", material))
}

#[test]
fn conservative_ball() {
    let mut family = Family::default();
    for (name, phase) in phases() {
        let text = ball_in_the_sky(&rayleigh_law(), &phase, scene::INTERFACE);
        family.bands(&format!("{name}, hero"), &Run::new(BANDS, 2048).bands(&text), &[1.0; 8]);
        family.bands(&format!("{name}, opow"), &Run::new(BANDS, 1024).opow().bands(&text), &[1.0; 8]);
        family.bands(&format!("{name}, analog"), &Run::new(BANDS, 1024).analog().bands(&text), &[1.0; 8]);
    }
    family.assert(0.03);
}

#[test]
fn conservative_ball_of_dispersive_glass() {
    let eta: Vec<f64> = (0..8).map(|i| 1.31 + 0.03 * f64::from(i)).collect();
    let glass = format!("Material \"dielectric\"{}{}", scene::STEP, BANDS.step("eta", &eta));
    let sigma: Vec<f64> = rayleigh_law().iter().map(|s| 0.2 * s).collect();
    let mut family = Family::default();
    for (name, phase) in phases() {
        let text = ball_in_the_sky(&sigma, &phase, &glass);
        family.bands(&format!("{name}, hero"), &Run::new(BANDS, 2048).bands(&text), &[1.0; 8]);
        family.bands(&format!("{name}, analog"), &Run::new(BANDS, 1024).analog().bands(&text), &[1.0; 8]);
    }
    family.assert(0.03);
}

/// Inside glass the radiance of the sky is n^2.
#[test]
fn camera_inside_a_dielectric() {
    let eta = [1.33, 1.2, 1.5, 1.4, 1.25, 1.7, 1.1, 1.6];
    let glass = format!("Material \"dielectric\"{}{}", scene::STEP, BANDS.step("eta", &eta));
    // at most 0.5 off the axis: no ray is trapped by total reflection
    let camera = scene::camera([0.0; 3], [0.0, 0.1, -1.0], 0.35);
    let text = format!("{camera}WorldBegin\n{}{glass}\nShape \"sphere\"\n", scene::SKY);
    let expected = eta.map(|n| n * n);
    let mut family = Family::default();
    family.bands("hero 8", &Run::new(BANDS, 1024).bands(&text), &expected);
    family.bands("hero 16", &Run::new(BANDS, 1024).hero(16).bands(&text), &expected);
    family.bands("opow", &Run::new(BANDS, 1024).opow().bands(&text), &expected);
    family.bands("analog", &Run::new(BANDS, 1024).analog().bands(&text), &expected);
    family.assert(0.05);
}

/// A closed box with walls that emit and reflect, filled with `medium` if there is one.
fn enclosure(le: &[f64], rho: &[f64], medium: &str) -> String {
    let (emission, reflectance) = (BANDS.step("L", le), BANDS.step("reflectance", rho));
    let camera = "LookAt 0.3 0.2 0.1  1 0.4 -0.2  0 1 0\nCamera \"perspective\" \"float fov\" 60\n";
    let (before, inside) = if medium.is_empty() { (String::new(), "") } else { (medium.into(), "m") };
    format!(
        "{before}MediumInterface \"\" \"{inside}\"\n{camera}{}WorldBegin\nMediumInterface \"{inside}\" \"\"\n\
         Material \"diffuse\"{}{reflectance}\n\
         AreaLightSource \"diffuse\" \"bool absolute\" true \"bool twosided\" true{}{emission}\n{}",
        scene::film(),
        scene::STEP,
        scene::STEP,
        scene::cuboid([-1.0; 3], [1.0; 3])
    )
}

/// L = Le / (1 - rho); a conservative medium does not show.
#[test]
fn lambertian_box_with_and_without_medium() {
    let (le, rho) = ([1.0, 2.0, 0.5, 1.0, 3.0, 0.7, 1.0, 0.3], [0.5, 0.1, 0.7, 0.5, 0.3, 0.6, 0.2, 0.8]);
    let expected: Vec<f64> = le.iter().zip(rho).map(|(l, r)| l / (1.0 - r)).collect();
    let sigma: Vec<f64> = rayleigh_law().iter().map(|s| 0.1 * s).collect();
    let fog = scene::medium(&BANDS, "m", &sigma, &[1.0; 8], &scene::asymmetry(&BANDS, &G));
    let mut family = Family::default();
    for (name, medium) in [("vacuum", ""), ("fog", fog.as_str())] {
        let text = enclosure(&le, &rho, medium);
        family.bands(&format!("{name}, hero"), &Run::new(BANDS, 1024).bands(&text), &expected);
        family.bands(&format!("{name}, opow"), &Run::new(BANDS, 1024).opow().bands(&text), &expected);
        family.bands(&format!("{name}, analog"), &Run::new(BANDS, 1024).analog().bands(&text), &expected);
    }
    family.assert(0.1);
}

/// Walls, medium and all at one temperature: everything has the radiance of the black walls.
#[test]
fn isothermal_enclosure() {
    let le = [1.0, 2.0, 0.5, 1.0, 3.0, 0.7, 1.0, 0.3];
    let tau: Vec<f64> = (0..8).map(|i| 0.3 + 0.7 * f64::from(i * 3 % 8)).collect();
    let albedo: Vec<f64> = (0..8).map(|i| 0.1 + 0.12 * f64::from(i * 5 % 8)).collect();
    let emission =
        format!(" \"bool absolute\" true{}{}", BANDS.step("Le", &le), scene::asymmetry(&BANDS, &G));
    let medium = scene::medium(&BANDS, "m", &tau, &albedo, &emission);
    let text = enclosure(&le, &[0.0; 8], &medium);
    let mut family = Family::default();
    family.bands("hero", &Run::new(BANDS, 1024).bands(&text), &le);
    family.bands("opow", &Run::new(BANDS, 1024).opow().bands(&text), &le);
    family.bands("analog", &Run::new(BANDS, 1024).analog().bands(&text), &le);
    family.assert(0.1);
}
