//! A trap: a slab 8000 wide and 1 thick with a black plane 0.001 under it. Offsets of rays that grow with the coordinates
//! step over the plane; pbrt-v4 answers R = 0.999 where 0.469 is right.

use super::{
    Family, Tolerance,
    slab_flux::{FLUX, ROUNDING, medium_of},
};
use crate::validate::{
    bands::{Bands, Dialect},
    case::Case,
    scene,
    table::Table,
};

pub(super) const FAMILY: Family = Family {
    name: "wide-slab",
    title: "Wide thin slab close above a black plane, 8000 : 1 : 0.001",
    source: "adding-doubling, as slab-flux",
    tolerance: Tolerance::Absolute(3e-4),
    cases,
};

fn cases(dialect: Dialect) -> Vec<Case> {
    let slab = scene::layer("m", scene::INTERFACE, [-1.0, 0.0], 4000.0);
    let mut out = Vec::new();
    for phase in ["isotropic", "rayleigh"] {
        for mu in ["1.0", "0.5", "0.1"] {
            let table = Table::parse(FLUX).only("phase", phase).only("mu0", mu);
            let bands = Bands::of(table.len(), dialect);
            let medium = medium_of(&bands, &table, phase);
            let text = scene::seen_from_above(&bands, mu.parse().expect("a cosine"), &medium, &slab, -1.001);
            let case = Case::new(format!("{phase} R mu={mu}"), bands, text, table.column("R"));
            out.push(case.labels(table.labels(&["tau", "albedo"])).uncertainty(ROUNDING));
        }
    }
    out
}
