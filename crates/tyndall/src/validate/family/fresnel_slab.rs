//! Slabs with smooth dielectric boundaries whose index differs from band to band.

use super::{Family, Tolerance, slab_flux::medium_of};
use crate::validate::{
    bands::{Bands, Dialect},
    case::Case,
    scene,
    table::Table,
};

pub(super) const FAMILY: Family = Family {
    name: "fresnel-slab",
    title: "Slabs behind Fresnel boundaries: reflectance with the specular part, transmittance",
    source: "matrix method with Fresnel boundaries",
    tolerance: Tolerance::Absolute(3e-4),
    cases,
};

fn cases(dialect: Dialect) -> Vec<Case> {
    let all = Table::parse(include_str!("../../../data/validate/slab_fresnel.csv"));
    let mut out = Vec::new();
    for mu in ["1.0", "0.5"] {
        let table = all.only("mu0_external", mu);
        let bands = Bands::of(table.len(), dialect);
        let medium = medium_of(&bands, &table, "hg");
        let slab = scene::slab("m", &scene::glass(&bands, &table.column("n_rel")));
        let cos = mu.parse().expect("a cosine");
        let case = |quantity: &str, column: &str, text: String| {
            Case::new(format!("{quantity} mu={mu}"), bands, text, table.column(column))
                .labels(table.labels(&["n_rel", "tau", "albedo", "g"]))
                .uncertainty(1e-6)
        };
        out.push(case("R", "R_total_incl_specular", scene::reflectance(&bands, cos, &medium, &slab)));
        out.push(case("T", "T_total", scene::transmittance(&bands, cos, &medium, &slab)));
    }
    out
}
