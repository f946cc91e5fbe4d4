//! Dispersion: an index of refraction that differs from band to band separates the lanes of a path.

mod common;

use common::{Bands, Run, judge::Family, scene};

const BANDS: Bands = Bands { count: 8 };
const ETA: [f64; 8] = [1.52, 1.33, 1.7, 1.45, 1.33, 1.9, 1.2, 1.6];

fn glass(eta: &[f64]) -> String {
    format!("Material \"dielectric\"{}{}", scene::STEP, BANDS.step("eta", eta))
}

/// Reflectance of a smooth boundary in natural light for the cosine `mu` outside, and the cosine inside (Fresnel).
fn fresnel(eta: f64, mu: f64) -> (f64, f64) {
    let inside = (1.0 - (1.0 - mu * mu) / (eta * eta)).sqrt();
    let s = (mu - eta * inside) / (mu + eta * inside);
    let p = (eta * mu - inside) / (eta * mu + inside);
    (0.5 * (s * s + p * p), inside)
}

/// A plate of coloured glass: the geometric series of reflections between its faces.
#[test]
fn plate_of_dispersive_absorbing_glass() {
    let tau: Vec<f64> = (0..8).map(|i| 0.1 + 0.15 * f64::from(i * 3 % 8)).collect();
    let medium = scene::medium(&BANDS, "m", &tau, &[0.0; 8], "");
    let slab = scene::slab("m", &glass(&ETA));
    let mut family = Family::default();
    for mu in [1.0, 0.5, 0.2] {
        let series = |i: usize| {
            let (r, inside) = fresnel(ETA[i], mu);
            let a = (-tau[i] / inside).exp();
            let (through, echo) = ((1.0 - r).powi(2) * a, 1.0 / (1.0 - r * r * a * a));
            (r + through * r * a * echo, through * echo)
        };
        let (r, t): (Vec<f64>, Vec<f64>) = (0..8).map(series).unzip();
        let runs = [("hero 8", Run::new(BANDS, 2048)), ("hero 4", Run::new(BANDS, 2048).hero(4))];
        let more = [("opow", Run::new(BANDS, 8192).opow()), ("analog", Run::new(BANDS, 8192).analog())];
        for (name, run) in runs.into_iter().chain(more) {
            family.bands(
                &format!("{name}, R({mu})"),
                &run.bands(&scene::reflectance(mu, &medium, &slab)),
                &r,
            );
            family.bands(
                &format!("{name}, T({mu})"),
                &run.bands(&scene::transmittance(mu, &medium, &slab)),
                &t,
            );
        }
    }
    family.assert(0.1);
}

/// A ball of cloudy glass before a half-lit background.
fn ball(eta: &[f64]) -> String {
    let albedo = [0.9, 0.5, 0.8, 1.0, 0.7, 0.95, 0.6, 0.99];
    let g = [0.0, 0.5, -0.3, 0.8, 0.2, 0.6, -0.5, 0.3];
    let medium = scene::medium(&BANDS, "m", &[0.4; 8], &albedo, &scene::asymmetry(&BANDS, &g));
    let camera = scene::camera([0.0, 0.0, 5.0], [0.0; 3], 1.1);
    let half = "AttributeBegin\nAreaLightSource \"diffuse\" \"bool absolute\" true \"bool twosided\" true \
                \"spectrum L\" [300 1 900 1]\nShape \"bilinearmesh\" \"point3 P\" [0.2 -9 -3  9 -9 -3  0.2 9 -3  9 9 -3]\n\
                AttributeEnd\n";
    format!("{camera}WorldBegin\n{medium}{}{half}", scene::ball("m", &glass(eta)))
}

/// All wavelengths on one path find what glass of one index at a time finds.
#[test]
fn spectral_paths_equal_monochromatic_renders() {
    let together = Run::new(BANDS, 4096).bands(&ball(&ETA));
    let one_each = Run::new(BANDS, 4096).opow().seed(2).bands(&ball(&ETA));
    let analog = Run::new(BANDS, 4096).analog().seed(3).bands(&ball(&ETA));
    let apart: Vec<_> =
        (0..8).map(|b| Run::new(BANDS, 1024).seed(10 + b as u64).bands(&ball(&[ETA[b]; 8]))[b]).collect();
    let mut family = Family::default();
    family.equal("hero and apart", &together, &apart);
    family.equal("opow and apart", &one_each, &apart);
    family.equal("analog and apart", &analog, &apart);
    family.assert(0.1);
}
