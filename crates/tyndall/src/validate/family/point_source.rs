//! A point source of power 1 in an infinite medium, backwards: the fluence at its distance r is, by reciprocity, what a
//! camera at the centre of a thin shell of radius r sees of the shell's emission, which has no singularity.
//!
//! The camera's directions are all alike, so one pixel is enough, `fluence = 4 pi L`; the shell emits `4 pi sigma_a Le` per
//! volume, 1 in all. In units of the mean free path the fluence is that of a medium with sigma_t = 1 times sigma_t^2, so
//! that bands sweep the distance.

use super::{Family, Tolerance};
use crate::validate::{
    bands::{Bands, Dialect},
    case::Case,
    scene,
    table::Table,
};
use std::f64::consts::PI;

pub(super) const FAMILY: Family = Family {
    name: "point-source",
    title: "Point source in an infinite medium: fluence, by reciprocity",
    source: "Case's singular eigenfunctions (Case and Zweifel 1967)",
    tolerance: Tolerance::Relative(0.003),
    cases,
};

/// Half the thickness of the shell of radius 1.
const HALF: f64 = 0.005;

fn cases(dialect: Dialect) -> Vec<Case> {
    let table = Table::parse(include_str!("../../../data/validate/infinite_point_source.csv"));
    let bands = Bands::of(table.len(), dialect);
    // optical distances become extinctions of a shell of radius 1
    let (sigma, albedo) = (table.column("r_mfp"), table.column("albedo"));
    let fluence: Vec<f64> = table
        .column("fluence_exact_P=1")
        .iter()
        .zip(&sigma)
        .map(|(f, s)| f * s * s * thickness(*s))
        .collect();
    let text = text(&bands, &sigma, &albedo, &fluence);
    vec![
        Case::new("shell", bands, text, vec![1.0; bands.count])
            .labels(table.labels(&["albedo", "r_mfp"]))
            .uncertainty(2e-6)
            // a hundredth of a mean free path thick: hardly any walk ends in it
            .light_sampling_only(),
    ]
}

/// Mean over the shell of `exp(-sigma (r - 1))`, the greatest part of how `r^2` times the fluence varies in it.
fn thickness(sigma: f64) -> f64 {
    let x = sigma * HALF;
    1.0 + x * x / 6.0
}

/// The answers span six decades: each band's emission is divided by its own, so that all of them are 1.
fn text(bands: &Bands, sigma: &[f64], albedo: &[f64], fluence: &[f64]) -> String {
    let volume = 4.0 / 3.0 * PI * ((1.0 + HALF).powi(3) - (1.0 - HALF).powi(3));
    let sigma_a = |i: usize| sigma[i] * (1.0 - albedo[i]);
    // 4 pi L = fluence / (4 pi sigma_a Le V)
    let le: Vec<f64> = (0..bands.count).map(|i| 1.0 / (fluence[i] * sigma_a(i) * volume)).collect();
    let glow = bands.emission("Le", "Lescale", &le);
    let dark = scene::medium(bands, "m", sigma, albedo, "");
    let shell = scene::medium(bands, "shell", sigma, albedo, &glow);
    let sphere = |inside: &str, outside: &str, radius: f64| {
        format!(
            "AttributeBegin\nMediumInterface \"{inside}\" \"{outside}\"\n{}\nShape \"sphere\" \"float radius\" {radius}\n\
             AttributeEnd\n",
            scene::INTERFACE
        )
    };
    let camera = "LookAt 0 0 0  0 0 1  0 1 0\nCamera \"perspective\" \"float fov\" 20\n";
    format!(
        "{dark}MediumInterface \"\" \"m\"\n{camera}{}WorldBegin\n{shell}{}{}",
        scene::film(bands),
        sphere("m", "shell", 1.0 - HALF),
        sphere("shell", "m", 1.0 + HALF)
    )
}
