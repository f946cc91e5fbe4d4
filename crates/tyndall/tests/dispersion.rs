//! Dispersion: an index of refraction that differs from band to band separates the lanes of a path.

mod common;

use common::{Bands, Run, judge::Family, scene};

const BANDS: Bands = Bands::new(8);
const ETA: [f64; 8] = [1.52, 1.33, 1.7, 1.45, 1.33, 1.9, 1.2, 1.6];

/// A ball of cloudy glass before a half-lit background.
fn ball(eta: &[f64]) -> String {
    let albedo = [0.9, 0.5, 0.8, 1.0, 0.7, 0.95, 0.6, 0.99];
    let g = [0.0, 0.5, -0.3, 0.8, 0.2, 0.6, -0.5, 0.3];
    let medium = scene::medium(&BANDS, "m", &[0.4; 8], &albedo, &scene::asymmetry(&BANDS, &g));
    let camera = scene::camera(&BANDS, [0.0, 0.0, 5.0], [0.0; 3], 1.1);
    let half = "AttributeBegin\nAreaLightSource \"diffuse\" \"bool absolute\" true \"bool twosided\" true \
                \"spectrum L\" [300 1 900 1]\nShape \"bilinearmesh\" \"point3 P\" [0.2 -9 -3  9 -9 -3  0.2 9 -3  9 9 -3]\n\
                AttributeEnd\n";
    format!("{camera}WorldBegin\n{medium}{}{half}", scene::ball("m", &scene::glass(&BANDS, eta)))
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
