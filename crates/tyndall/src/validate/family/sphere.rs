//! A sphere of medium in a uniform environment: mean radiance over its disc.

use super::{Family, Tolerance};
use crate::validate::{
    bands::{Bands, Dialect},
    case::Case,
    scene,
    table::Table,
};
use std::f64::consts::FRAC_PI_4;

pub(super) const FAMILY: Family = Family {
    name: "sphere",
    title: "Sphere of medium in uniform light, isotropic and forward scattering",
    source: "integral equation of the source function; for g != 0 a Monte Carlo program of its own, 6e6 paths a row",
    tolerance: Tolerance::Relative(0.003),
    cases,
};

fn cases(dialect: Dialect) -> Vec<Case> {
    let isotropic = Table::parse(include_str!("../../../data/validate/sphere_uniform_environment.csv"));
    let anisotropic = Table::parse(include_str!("../../../data/validate/sphere_anisotropic.csv"));
    vec![case("isotropic", dialect, &isotropic, 5e-7), case("henyey-greenstein", dialect, &anisotropic, 8e-5)]
}

fn case(name: &str, dialect: Dialect, table: &Table, uncertainty: f64) -> Case {
    let bands = Bands::of(table.len(), dialect);
    let (tau, albedo) = (table.column("tau_radius"), table.column("albedo"));
    let phase = scene::asymmetry(&bands, &table.column("g"));
    let expected = table.column("mean_radiance_over_disc_env=1");
    Case::new(name, bands, text(&bands, &tau, &albedo, &phase), expected)
        .labels(table.labels(&["tau_radius", "albedo", "g"]))
        .uncertainty(uncertainty)
        .affine(1.0 - 1.0 / FRAC_PI_4, 1.0 / FRAC_PI_4)
}

/// The picture is the square around the disc, its corners are sky: `1 + pi/4 (L - 1)`.
fn text(bands: &Bands, tau: &[f64], albedo: &[f64], phase: &str) -> String {
    let medium = scene::medium(bands, "m", tau, albedo, phase);
    let camera = scene::camera(bands, [0.0, 0.0, 5.0], [0.0; 3], 1.0);
    let (sky, ball) = (scene::sky(bands.dialect), scene::ball("m", scene::INTERFACE));
    format!("{camera}WorldBegin\n{sky}{medium}{ball}")
}
