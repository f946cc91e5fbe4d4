//! A plate of absorbing glass whose index differs from band to band: the geometric series of reflections between its faces
//! (Fresnel). Refraction parts the wavelengths of a path.

use super::{Family, Tolerance};
use crate::validate::{
    bands::{Bands, Dialect},
    case::Case,
    scene,
};

pub(super) const FAMILY: Family = Family {
    name: "dispersion",
    title: "Plate of dispersive, absorbing glass",
    source: "Fresnel's equations and the geometric series",
    tolerance: Tolerance::Absolute(3e-4),
    cases,
};

const ETA: [f64; 8] = [1.52, 1.33, 1.7, 1.45, 1.33, 1.9, 1.2, 1.6];

/// Reflectance of a smooth boundary in natural light for the cosine `mu` outside, and the cosine inside (Fresnel).
fn fresnel(eta: f64, mu: f64) -> (f64, f64) {
    let inside = (1.0 - (1.0 - mu * mu) / (eta * eta)).sqrt();
    let s = (mu - eta * inside) / (mu + eta * inside);
    let p = (eta * mu - inside) / (eta * mu + inside);
    (0.5 * (s * s + p * p), inside)
}

fn cases(dialect: Dialect) -> Vec<Case> {
    let bands = Bands::of(8, dialect);
    let tau: Vec<f64> = (0..8).map(|i| 0.1 + 0.15 * (i * 3 % 8) as f64).collect();
    let medium = scene::medium(&bands, "m", &tau, &[0.0; 8], "");
    let slab = scene::slab("m", &scene::glass(&bands, &ETA));
    let labels: Vec<String> = (0..8).map(|i| format!("n {}, tau {:.2}", ETA[i], tau[i])).collect();
    let mut out = Vec::new();
    for mu in [1.0, 0.5, 0.2] {
        let series = |i: usize| {
            let (r, inside) = fresnel(ETA[i], mu);
            let a = (-tau[i] / inside).exp();
            let (through, echo) = ((1.0 - r).powi(2) * a, 1.0 / (1.0 - r * r * a * a));
            (r + through * r * a * echo, through * echo)
        };
        let (r, t): (Vec<f64>, Vec<f64>) = (0..8).map(series).unzip();
        let case = |quantity: &str, text: String, expected: Vec<f64>| {
            Case::new(format!("{quantity} mu={mu}"), bands, text, expected).labels(labels.clone())
        };
        out.push(case("R", scene::reflectance(&bands, mu, &medium, &slab), r));
        out.push(case("T", scene::transmittance(&bands, mu, &medium, &slab), t));
    }
    out
}
