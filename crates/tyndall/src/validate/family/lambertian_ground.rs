//! Slabs over a Lambertian ground: `R + T T* rho / (1 - rho R*)` of the slab's own fluxes.

use super::{Family, Tolerance, slab_flux::medium_of};
use crate::validate::{
    bands::{Bands, Dialect},
    case::Case,
    scene,
    table::Table,
};

pub(super) const FAMILY: Family = Family {
    name: "lambertian-ground",
    title: "Slabs over a Lambertian ground: reflectance of the whole",
    source: "closed form from the slab's fluxes",
    tolerance: Tolerance::Absolute(3e-4),
    cases,
};

fn cases(dialect: Dialect) -> Vec<Case> {
    let all = Table::parse(include_str!("../../../data/validate/slab_over_lambertian_ground.csv"));
    let mut out = Vec::new();
    for phase in ["isotropic", "hg"] {
        let table = all.only("phase", phase);
        let bands = Bands::of(table.len(), dialect);
        let medium = medium_of(&bands, &table, phase);
        let ground = scene::diffuse(&bands, &table.column("ground_reflectance")) + &scene::plane(-1.5);
        let text = scene::over_ground(&bands, 0.6, &medium, &scene::slab("m", scene::INTERFACE), &ground);
        let labels = table.labels(&["tau", "albedo", "g", "ground_reflectance"]);
        let case = Case::new(format!("{phase} R mu=0.6"), bands, text, table.column("R_top"));
        out.push(case.labels(labels).uncertainty(3e-7));
    }
    out
}
