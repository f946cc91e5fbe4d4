//! Media that vary in space, with the answers of those that do not.
//!
//! A plane medium with one albedo and one phase function is known by its optical thickness alone, however that is shared
//! out over the height: uneven slabs answer as the even ones of the tables do. What neither absorbs nor emits cannot be
//! seen in a uniform sky, whatever its densities.

use super::{
    Family, Tolerance,
    slab_flux::{FLUX, ROUNDING},
};
use crate::validate::{
    bands::{Bands, Dialect},
    case::Case,
    scene::{self, Voxels},
    table::Table,
};

pub(super) const FAMILY: Family = Family {
    name: "uniformgrid",
    title: "Grids: uneven slabs, Beer-Lambert through them, furnace",
    source: "invariance to the profile of a plane medium, adding-doubling as slab-flux; closed form; uniform radiance",
    tolerance: Tolerance::Absolute(3e-4),
    cases,
};

/// Bands of the cases that no table fills.
const N: usize = 8;

fn cases(dialect: Dialect) -> Vec<Case> {
    let mut out = vec![absorber(dialect), furnace(dialect)];
    for phase in ["isotropic", "hg", "rayleigh"] {
        out.extend(uneven(dialect, phase, "0.5", ""));
    }
    out
}

/// Reflectance and transmittance of uneven slabs seen at the cosine `mu`; `more` goes to the medium.
pub(super) fn uneven(dialect: Dialect, phase: &str, mu: &str, more: &str) -> [Case; 2] {
    let table = Table::parse(FLUX).only("phase", phase).only("mu0", mu);
    let bands = Bands::of(table.len(), dialect);
    let more = scene::phase(&bands, phase, &table.column("g")) + more;
    let medium = scene::uneven(&bands, &table.column("tau"), &table.column("albedo"), &more);
    let slab = scene::slab("m", scene::INTERFACE);
    let cos = mu.parse().expect("a cosine");
    let case = |quantity: &str, column: &str, text: String| {
        Case::new(format!("{phase} {quantity} mu={mu}"), bands, text, table.column(column))
            .labels(table.labels(&["tau", "albedo", "g"]))
            .uncertainty(ROUNDING)
    };
    [
        case("R", "R", scene::reflectance(&bands, cos, &medium, &slab)),
        case("T", "T_total", scene::transmittance(&bands, cos, &medium, &slab)),
    ]
}

/// The sky through an uneven absorber.
fn absorber(dialect: Dialect) -> Case {
    let bands = Bands::of(N, dialect);
    let tau: Vec<f64> = (0..N).map(|i| 0.1 + 0.35 * (i * 3 % N) as f64).collect();
    let medium = scene::uneven(&bands, &tau, &[0.0; N], "");
    let text = scene::over_ground(&bands, 0.5, &medium, &scene::slab("m", scene::INTERFACE), "");
    let labels = tau.iter().map(|t| format!("tau {t:.2}")).collect();
    let expected = tau.iter().map(|t| (-t / 0.5).exp()).collect();
    Case::new("sky mu=0.5", bands, text, expected).labels(labels).effort(4)
}

/// A conservative cube of many voxels, a quarter of them empty, in a sky of radiance 1.
fn furnace(dialect: Dialect) -> Case {
    let bands = Bands::of(N, dialect);
    let density = |i: usize| ((i * 2_654_435_761) >> 7) % 1000;
    let densities: Vec<f64> =
        (0..210).map(density).map(|d| if d < 250 { 0.0 } else { 0.002 * d as f64 }).collect();
    let voxels = Voxels { counts: [6, 5, 7], densities: &densities, low: [-1.0; 3], high: [1.0; 3] };
    let sigma: Vec<f64> = (0..N).map(|i| 0.4 + 0.5 * (i * 5 % N) as f64).collect();
    let g: Vec<f64> = (0..N).map(|i| -0.6 + 0.2 * i as f64).collect();
    let medium = scene::grid(&bands, &sigma, &[1.0; N], &voxels, &scene::asymmetry(&bands, &g));
    let cube = scene::cuboid([-1.0; 3], [1.0; 3]);
    let text = format!(
        "{}WorldBegin\n{}{medium}AttributeBegin\nMediumInterface \"m\" \"\"\n{}\n{cube}AttributeEnd\n",
        scene::camera(&bands, [3.0, 2.5, 4.0], [0.0; 3], 1.1),
        scene::sky(dialect),
        scene::INTERFACE
    );
    Case::new("furnace", bands, text, vec![1.0; N])
}
