//! Plane albedo of an isotropic half-space, `1 - H(mu0) sqrt(1 - albedo)` (Chandrasekhar 1950).
//!
//! 60 mean free paths are as good as infinitely many at albedos up to 0.9.

use super::{Family, Tolerance};
use crate::validate::{
    bands::{Bands, Dialect},
    case::Case,
    scene,
    table::Table,
};

pub(super) const FAMILY: Family = Family {
    name: "semi-infinite",
    title: "Half-space: Chandrasekhar's H function",
    source: "closed-form integral for H, agrees with adding-doubling to 2e-10",
    tolerance: Tolerance::Absolute(3e-4),
    cases,
};

fn cases(dialect: Dialect) -> Vec<Case> {
    let table = Table::parse(include_str!("../../../data/validate/semi_infinite_isotropic_albedo.csv"));
    let bands = Bands::of(table.len(), dialect);
    let depth = vec![60.0; table.len()];
    let medium = scene::medium(&bands, "m", &depth, &table.column("albedo"), "");
    let slab = scene::slab("m", scene::INTERFACE);
    let case = |mu: &str| {
        let text = scene::reflectance(&bands, mu.parse().expect("a cosine"), &medium, &slab);
        Case::new(format!("R mu={mu}"), bands, text, table.column(&format!("plane_albedo_mu0_{mu}")))
            .labels(table.labels(&["albedo"]))
            .uncertainty(1e-6)
    };
    ["1.0", "0.7", "0.3", "0.1"].map(case).into()
}
