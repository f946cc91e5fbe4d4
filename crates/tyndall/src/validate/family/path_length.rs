//! Invariance of the path length: in uniform light the mean length of paths inside a body that does not absorb is `4 V/S`,
//! 4/3 of the radius of a sphere, however it scatters (Bardsley and Dubi 1981, Blanco and Fournier 2003).
//!
//! Backwards: a faint glow of the whole body, `sigma_a Le = 1` with a vanishing `sigma_a`, adds up to the length, and the
//! mean over the disc is the mean over uniform light.

use super::{Family, Tolerance};
use crate::validate::{
    bands::{Bands, Dialect},
    case::Case,
    scene,
};
use std::f64::consts::FRAC_PI_4;

pub(super) const FAMILY: Family = Family {
    name: "path-length",
    title: "Mean path length in a scattering sphere is 4/3 of its radius",
    source: "Bardsley and Dubi 1981, Blanco and Fournier 2003",
    tolerance: Tolerance::Relative(0.003),
    cases,
};

/// So little that `sigma_a <l^2>` is far below every error.
const SIGMA_A: f64 = 1e-6;

fn cases(dialect: Dialect) -> Vec<Case> {
    let bands = Bands::of(8, dialect);
    let sigma_s: [f64; 8] = [0.1, 10.0, 1.0, 3.0, 0.3, 20.0, 5.0, 0.01];
    let g = [0.0, 0.9, -0.5, 0.3, 0.8, 0.95, 0.0, 0.6];
    let tau: Vec<f64> = sigma_s.iter().map(|s| s + SIGMA_A).collect();
    let albedo: Vec<f64> = sigma_s.iter().map(|s| s / (s + SIGMA_A)).collect();
    let labels: Vec<String> = (0..8).map(|i| format!("sigma_s {}, g {}", sigma_s[i], g[i])).collect();
    let case = |name: &str, phase: String| {
        let glow = bands.emission("Le", "Lescale", &[1.0 / SIGMA_A; 8]) + &phase;
        let medium = scene::medium(&bands, "m", &tau, &albedo, &glow);
        let camera = scene::camera(&bands, [0.0, 0.0, 5.0], [0.0; 3], 1.0);
        let text = format!("{camera}WorldBegin\n{medium}{}", scene::ball("m", scene::INTERFACE));
        // the length is longer by no more than sigma_a <l^2> / 2
        Case::new(name, bands, text, vec![4.0 / 3.0; 8])
            .labels(labels.clone())
            .uncertainty(1e-5)
            .affine(0.0, 1.0 / FRAC_PI_4)
            .light_sampling_only()
    };
    vec![
        case("henyey-greenstein", scene::asymmetry(&bands, &g)),
        case("rayleigh", scene::phase(&bands, "rayleigh", &[])),
    ]
}
