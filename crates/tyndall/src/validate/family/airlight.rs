//! Airlight: what a point light beside the line of sight adds to it by single scattering, before a black plane.

use super::{Family, Tolerance};
use crate::validate::{
    bands::{Bands, Dialect},
    case::Case,
    scene,
    table::Table,
};

pub(super) const FAMILY: Family = Family {
    name: "airlight",
    title: "Airlight of a point light, single scattering",
    source: "adaptive quadrature to 1e-11",
    tolerance: Tolerance::Relative(0.003),
    cases,
};

fn cases(dialect: Dialect) -> Vec<Case> {
    let all = Table::parse(include_str!("../../../data/validate/airlight_point_light_single_scattering.csv"));
    let case = |(h, z): (&str, &str)| {
        let table = all.only("h", h).only("z_surface", z);
        let bands = Bands::of(table.len(), dialect);
        let expected = table.column("L_single_scatter_I=1W/sr");
        Case::new(format!("h={h} z={z}"), bands, text(&bands, &table, h, z), expected)
            .labels(table.labels(&["sigma_t", "albedo", "g"]))
            .depth(1)
            .brightest(1e-3)
            .light_sampling_only()
    };
    [("0.1", "4.0"), ("1.0", "4.0"), ("1.0", "20.0")].map(case).into()
}

fn text(bands: &Bands, table: &Table, h: &str, z: &str) -> String {
    let phase = scene::asymmetry(bands, &table.column("g"));
    let medium = scene::medium(bands, "m", &table.column("sigma_t"), &table.column("albedo"), &phase);
    let window = "\"float screenwindow\" [-0.0001 0.0001 -0.0001 0.0001]";
    format!(
        "{medium}MediumInterface \"\" \"m\"\nLookAt 0 0 0  0 0 1  0 1 0\nCamera \"perspective\" {window}\n{}\
         WorldBegin\nMediumInterface \"m\" \"m\"\n\
         LightSource \"point\"{} \"spectrum I\" [300 1 900 1] \"point3 from\" [{h} 0 3]\n{}{}",
        scene::film(bands),
        scene::absolute(bands.dialect),
        scene::BLACK,
        scene::plane(z.parse().expect("a depth"))
    )
}
