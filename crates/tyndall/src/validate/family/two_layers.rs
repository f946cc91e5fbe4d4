//! Two layers on each other, seen from the top.
//!
//! The table names its stacks without their parameters. They were found by adding-doubling over a grid of round numbers:
//! these alone give all eight values of each stack to the last digit, the next best are off by 3e-3.

use super::{Family, Tolerance, slab_flux::ROUNDING};
use crate::validate::{
    bands::{Bands, Dialect},
    case::Case,
    scene,
    table::Table,
};

pub(super) const FAMILY: Family = Family {
    name: "two-layers",
    title: "Two layers: isotropic over Henyey-Greenstein, absorber over white",
    source: "adding",
    tolerance: Tolerance::Absolute(3e-4),
    cases,
};

/// Optical thickness, albedo and g of the upper and the lower layer.
const STACKS: [(&str, [[f64; 3]; 2]); 2] = [
    ("iso_over_hg", [[1.0, 0.9, 0.0], [2.0, 0.99, 0.75]]),
    ("absorber_over_white", [[0.5, 0.2, 0.0], [8.0, 1.0, 0.0]]),
];

/// Both stacks share a scene: one a band, each of them in several bands, in turn.
const COUNT: usize = 4;

fn cases(dialect: Dialect) -> Vec<Case> {
    let all = Table::parse(include_str!("../../../data/validate/two_layer_flux.csv"));
    let bands = Bands::of(COUNT, dialect);
    let stack = |band: usize| STACKS[band % 2];
    let of = |layer: usize, what: usize| (0..COUNT).map(|b| stack(b).1[layer][what]).collect::<Vec<_>>();
    let medium = |name: &str, layer: usize| {
        let g = scene::asymmetry(&bands, &of(layer, 2));
        scene::medium(&bands, name, &of(layer, 0), &of(layer, 1), &g)
    };
    let media = medium("upper", 0) + &medium("lower", 1);
    let slabs = stacked();
    let mut out = Vec::new();
    for mu in ["1.0", "0.6", "0.3"] {
        let table = all.only("mu0", mu);
        let column = |name: &str| {
            (0..COUNT).map(|b| table.only("stack", stack(b).0).column(name)[0]).collect::<Vec<_>>()
        };
        let labels: Vec<String> = (0..COUNT).map(|b| stack(b).0.replace('_', " ")).collect();
        let cos = mu.parse().expect("a cosine");
        let case = |quantity: &str, text: String, column: Vec<f64>| {
            Case::new(format!("{quantity} mu={mu}"), bands, text, column)
                .labels(labels.clone())
                .uncertainty(ROUNDING)
        };
        out.push(case("R", scene::seen_from_above(&bands, cos, &media, &slabs, -2.5), column("R")));
        out.push(case("T", scene::transmittance(&bands, cos, &media, &slabs), column("T_total")));
    }
    out
}

/// Upper layer from z = 0 down to -1, lower one to -2, by three planes.
fn stacked() -> String {
    scene::layers(&[(0.0, "upper"), (-1.0, "lower"), (-2.0, "")])
}
