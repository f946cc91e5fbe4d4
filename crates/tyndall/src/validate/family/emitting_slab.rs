//! Slabs that glow at one temperature: emissivity `1 - R - T` (Kirchhoff), scattering or not.

use super::{Family, Tolerance};
use crate::validate::{
    bands::{Bands, Dialect},
    case::Case,
    scene,
    table::Table,
};

pub(super) const FAMILY: Family = Family {
    name: "emitting-slab",
    title: "Isothermal slabs that emit and scatter",
    source: "Kirchhoff's law, 1 - R - T of adding-doubling",
    tolerance: Tolerance::Absolute(3e-4),
    cases,
};

fn cases(dialect: Dialect) -> Vec<Case> {
    let all = Table::parse(include_str!("../../../data/validate/isothermal_emitting_slab.csv"));
    let case = |mu: &str| {
        let table = all.only("mu_view", mu);
        let bands = Bands::of(table.len(), dialect);
        let le: Vec<f64> = (0..bands.count).map(|i| 0.5 + (i * 5 % 7) as f64).collect();
        let expected = table.column("L_over_B").iter().zip(&le).map(|(e, l)| e * l).collect();
        let glow = bands.emission("Le", "Lescale", &le);
        let more = format!("{glow}{}", scene::asymmetry(&bands, &table.column("g")));
        let medium = scene::medium(&bands, "m", &table.column("tau"), &table.column("albedo"), &more);
        let camera = scene::parallel_camera(&bands, -mu.parse::<f64>().expect("a cosine"));
        let text = format!("{camera}WorldBegin\n{medium}{}", scene::slab("m", scene::INTERFACE));
        let labels = table.labels(&["tau", "albedo", "g"]);
        Case::new(format!("L mu={mu}"), bands, text, expected).labels(labels).uncertainty(5e-7)
    };
    ["1.0", "0.3"].map(case).into()
}
