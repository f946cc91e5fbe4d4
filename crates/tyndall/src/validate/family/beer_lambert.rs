//! Beer-Lambert: `L = exp(-sigma_a d)` seen through an absorber, and sunlight through one on a white plane.

use super::{Family, Tolerance};
use crate::validate::{
    bands::{Bands, Dialect},
    case::Case,
    scene,
};
use std::f64::consts::PI;

pub(super) const FAMILY: Family = Family {
    name: "beer-lambert",
    title: "Beer-Lambert: light through an absorber",
    source: "closed form",
    tolerance: Tolerance::Absolute(1e-4),
    cases,
};

const COUNT: usize = 16;

fn depths() -> Vec<f64> {
    (0..COUNT).map(|i| 0.02 + 0.2 * (i * 7 % COUNT) as f64).collect()
}

fn cases(dialect: Dialect) -> Vec<Case> {
    let bands = Bands::of(COUNT, dialect);
    let labels: Vec<String> = depths().iter().map(|tau| format!("tau {tau:.2}")).collect();
    let transmittance = |mu: f64| depths().iter().map(|tau| (-tau / mu).exp()).collect::<Vec<_>>();
    let mut all = Vec::new();
    for mu in [1.0, 0.5] {
        let expected = transmittance(mu);
        all.push(
            Case::new(format!("sky mu={mu}"), bands, sky(&bands, mu), expected)
                .labels(labels.clone())
                .effort(4),
        );
    }
    for mu in [1.0, 0.5] {
        let expected = transmittance(mu).iter().map(|t| mu / PI * t).collect();
        let case = Case::new(format!("sun mu0={mu}"), bands, sun(&bands, mu), expected);
        all.push(case.labels(labels.clone()).depth(1).light_sampling_only());
    }
    all
}

fn absorber(bands: &Bands) -> String {
    scene::medium(bands, "m", &depths(), &[0.0; COUNT], "")
}

/// The sky through an absorbing slab.
fn sky(bands: &Bands, mu: f64) -> String {
    let slab = scene::slab("m", scene::INTERFACE);
    scene::over_ground(bands, mu, &absorber(bands), &slab, "")
}

/// A white plane under the slab, lit by the sun through it and seen from between the two: `mu0 exp(-tau / mu0) / pi`.
fn sun(bands: &Bands, mu0: f64) -> String {
    let white = "Material \"diffuse\" \"spectrum reflectance\" [300 1 900 1]\n";
    let camera = scene::camera(bands, [0.0, 0.0, -1.2], [0.0, 0.0, -1.5], 0.01);
    let (sun, slab) = (scene::sun(bands.dialect, mu0), scene::slab("m", scene::INTERFACE));
    format!("{camera}WorldBegin\n{sun}{}{slab}{white}{}", absorber(bands), scene::plane(-1.5))
}
