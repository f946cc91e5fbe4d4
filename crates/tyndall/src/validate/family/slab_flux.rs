//! Plane albedo R and transmittance T of slabs in collimated light, one row of a table a band.

use super::{Family, Tolerance};
use crate::validate::{
    bands::{Bands, Dialect},
    case::Case,
    scene,
    table::Table,
};

pub(super) const FAMILY: Family = Family {
    name: "slab-flux",
    title: "Reflectance and transmittance of slabs: isotropic, Henyey-Greenstein, Rayleigh",
    source: "adding-doubling (van de Hulst 1980), agrees with discrete ordinates to 4e-7",
    tolerance: Tolerance::Absolute(3e-4),
    cases,
};

/// The table, and how far it is rounded.
pub(super) const FLUX: &str = include_str!("../../../data/validate/slab_flux.csv");
pub(super) const ROUNDING: f64 = 3e-7;

/// The rows of `table` as the bands of one medium `m`.
pub(super) fn medium_of(bands: &Bands, table: &Table, phase: &str) -> String {
    let phase = scene::phase(bands, phase, &table.column("g"));
    scene::medium(bands, "m", &table.column("tau"), &table.column("albedo"), &phase)
}

fn cases(dialect: Dialect) -> Vec<Case> {
    let slab = scene::slab("m", scene::INTERFACE);
    let all = Table::parse(FLUX);
    let mut out = Vec::new();
    for phase in ["isotropic", "hg", "rayleigh"] {
        for mu in ["1.0", "0.5", "0.1"] {
            let table = all.only("phase", phase).only("mu0", mu);
            let bands = Bands::of(table.len(), dialect);
            let medium = medium_of(&bands, &table, phase);
            let cos = mu.parse().expect("a cosine");
            let labels = table.labels(&["tau", "albedo", "g"]);
            let case = |quantity: &str, column: &str, text: String| {
                Case::new(format!("{phase} {quantity} mu={mu}"), bands, text, table.column(column))
                    .labels(labels.clone())
                    .uncertainty(ROUNDING)
            };
            out.push(case("R", "R", scene::reflectance(&bands, cos, &medium, &slab)));
            out.push(case("T", "T_total", scene::transmittance(&bands, cos, &medium, &slab)));
        }
    }
    out.extend(grey(&all, dialect, &slab));
    out
}

/// The isotropic slabs of thickness 1, whose albedos alone differ.
fn grey(all: &Table, dialect: Dialect, slab: &str) -> [Case; 2] {
    let table = all.only("phase", "isotropic").only("tau", "1").only("mu0", "0.5");
    let bands = Bands::of(table.len(), dialect);
    let medium = medium_of(&bands, &table, "isotropic");
    let case = |quantity: &str, column: &str, text: String| {
        Case::new(format!("grey {quantity} mu=0.5"), bands, text, table.column(column))
            .labels(table.labels(&["tau", "albedo"]))
            .uncertainty(ROUNDING)
            .grey()
    };
    [
        case("R", "R", scene::reflectance(&bands, 0.5, &medium, slab)),
        case("T", "T_total", scene::transmittance(&bands, 0.5, &medium, slab)),
    ]
}
