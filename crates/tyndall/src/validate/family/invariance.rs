//! What must not matter: the majorant of null collisions, the number of boxes that a medium fills, the sampler. Each case is
//! one of slab-flux but for that, so that all integrators and numbers of wavelengths meet each of them.

use super::{
    Family, Tolerance,
    slab_flux::{FLUX, ROUNDING, medium_of},
    varying,
};
use crate::validate::{
    bands::{Bands, Dialect},
    case::Case,
    scene,
    table::Table,
};

pub(super) const FAMILY: Family = Family {
    name: "invariance",
    title: "What must not matter: majorants x 2 and x 10, two boxes of one medium, independent random numbers",
    source: "adding-doubling, as slab-flux",
    tolerance: Tolerance::Absolute(3e-4),
    cases,
};

fn cases(dialect: Dialect) -> Vec<Case> {
    let mut out = Vec::new();
    for scale in [2, 10] {
        let more = format!(" \"float majorantscale\" {scale}");
        let cases = varying::uneven(dialect, "hg", "1.0", &more);
        out.extend(cases.map(|c| Case { name: format!("majorant x{scale}, {}", c.name), ..c }));
    }
    let media = |medium: &str| medium.to_owned() + &medium.replace("\"m\"", "\"n\"");
    // one upon the other, sharing a plane, and side by side
    let stacked = scene::layers(&[(0.0, "m"), (-0.3, "n"), (-1.0, "")]);
    let beside = scene::halves("m", "n");
    for (name, slabs) in [("two boxes, stacked", stacked), ("two boxes, side by side", beside)] {
        out.extend(flux(dialect, name, &slabs, media));
    }
    let slab = scene::slab("m", scene::INTERFACE);
    let independent = flux(dialect, "independent sampler", &slab, str::to_owned);
    out.extend(independent.map(|c| Case { text: scene::independent(&c.text), ..c }));
    out
}

/// Reflectance and transmittance of isotropic slabs.
fn flux(dialect: Dialect, name: &str, slabs: &str, media: impl Fn(&str) -> String) -> [Case; 2] {
    let table = Table::parse(FLUX).only("phase", "isotropic").only("mu0", "0.5");
    let bands = Bands::of(table.len(), dialect);
    let media = media(&medium_of(&bands, &table, "isotropic"));
    let case = |quantity: &str, column: &str, text: String| {
        Case::new(format!("{name}, {quantity}"), bands, text, table.column(column))
            .labels(table.labels(&["tau", "albedo"]))
            .uncertainty(ROUNDING)
    };
    [
        case("R", "R", scene::reflectance(&bands, 0.5, &media, slabs)),
        case("T", "T_total", scene::transmittance(&bands, 0.5, &media, slabs)),
    ]
}
