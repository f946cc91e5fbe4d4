//! Radiances that leave slabs in sunlight of unit perpendicular irradiance, all orders of scattering; and the first alone.

use super::{Family, Tolerance};
use crate::validate::{
    bands::{Bands, Dialect},
    case::Case,
    scene,
    table::Table,
};
use std::f64::consts::PI;

pub(super) const FAMILY: Family = Family {
    name: "slab-radiance",
    title: "Radiance of slabs in sunlight: isotropic, Henyey-Greenstein, Rayleigh; single scattering",
    source: "adding-doubling by azimuthal modes, agrees with discrete ordinates to 2e-7; Chandrasekhar 1950",
    tolerance: Tolerance::Relative(0.01),
    cases,
};

/// Phase function, cosine and azimuth of the view.
const VIEWS: [(&str, &str, &str); 8] = [
    ("isotropic", "0.8", "0"),
    ("isotropic", "0.25", "0"),
    ("hg", "0.8", "90"),
    ("hg", "0.25", "0"),
    ("hg", "0.5", "180"),
    ("rayleigh", "0.8", "90"),
    ("rayleigh", "0.25", "0"),
    ("rayleigh", "0.5", "180"),
];

fn cases(dialect: Dialect) -> Vec<Case> {
    let mut out: Vec<Case> = VIEWS.iter().flat_map(|view| all_orders(dialect, view)).collect();
    out.extend(single_scattering(dialect));
    out
}

/// The slab from above (`height` 1) or below (-1), the view of cosine `mu` looking along the azimuth `phi` of the light.
fn seen(bands: &Bands, mu0: f64, mu: f64, phi: f64, height: f64, medium: &str) -> String {
    let sin = (1.0 - mu * mu).sqrt();
    // exact where the view lies in the plane of the light
    let (c, s) = ((1e9 * phi.cos()).round() / 1e9, (1e9 * phi.sin()).round() / 1e9);
    let camera = scene::camera(bands, [5.0 * sin * c, 5.0 * sin * s, 5.0 * mu * height], [0.0; 3], 0.01);
    let slab = scene::slab("m", scene::INTERFACE);
    format!("{camera}WorldBegin\n{}{medium}{slab}", scene::sun(bands.dialect, mu0))
}

fn all_orders(dialect: Dialect, &(phase, view, azimuth): &(&str, &str, &str)) -> [Case; 2] {
    let table = Table::parse(include_str!("../../../data/validate/slab_radiance.csv"));
    let table = table.only("phase", phase).only("mu_view", view).only("dphi_deg", azimuth);
    let bands = Bands::of(table.len(), dialect);
    let medium = super::slab_flux::medium_of(&bands, &table, phase);
    let (mu, phi): (f64, f64) = (view.parse().expect("a cosine"), azimuth.parse().expect("an angle"));
    [("R", 1.0, "L_reflected_per_Eperp"), ("T", -1.0, "L_transmitted_diffuse_per_Eperp")].map(
        |(side, height, column)| {
            let text = seen(&bands, 0.6, mu, phi.to_radians(), height, &medium);
            let name = format!("{phase} {side} mu={view} azimuth={azimuth}");
            Case::new(name, bands, text, table.column(column))
                .labels(table.labels(&["tau", "albedo", "g"]))
                .uncertainty(3e-7)
                .brightest(0.1)
                .light_sampling_only()
        },
    )
}

/// Henyey-Greenstein with `cos` the cosine of the scattering angle \[1/sr\].
fn henyey_greenstein(g: f64, cos: f64) -> f64 {
    (1.0 - g * g) / (4.0 * PI * (1.0 + g * g - 2.0 * g * cos).powf(1.5))
}

/// `albedo p mu0 / (mu0 + mu) (1 - exp(-tau (1/mu0 + 1/mu)))` and its counterpart below; the first band is the published
/// pair 0.0256655054, 0.0166023678.
fn single_scattering(dialect: Dialect) -> [Case; 2] {
    let bands = Bands::of(8, dialect);
    let tau: [f64; 8] = [1.0, 0.2, 3.0, 0.5, 2.0, 0.1, 1.5, 0.8];
    let albedo = [0.8, 1.0, 0.5, 0.9, 0.3, 0.95, 0.7, 0.6];
    let g = [0.0, 0.5, -0.4, 0.8, 0.0, -0.7, 0.3, 0.6];
    let (mu0, mu) = (0.5f64, 0.7f64);
    let sines = (1.0 - mu0 * mu0).sqrt() * (1.0 - mu * mu).sqrt();
    let reflected = |i: usize| {
        let path = -(-tau[i] * (1.0 / mu0 + 1.0 / mu)).exp_m1();
        albedo[i] * henyey_greenstein(g[i], sines - mu * mu0) * mu0 / (mu0 + mu) * path
    };
    let transmitted = |i: usize| {
        let beams = (-tau[i] / mu).exp() - (-tau[i] / mu0).exp();
        albedo[i] * henyey_greenstein(g[i], sines + mu * mu0) * mu0 / (mu - mu0) * beams
    };
    let medium = scene::medium(&bands, "m", &tau, &albedo, &scene::asymmetry(&bands, &g));
    let labels: Vec<String> =
        (0..8).map(|i| format!("tau {}, albedo {}, g {}", tau[i], albedo[i], g[i])).collect();
    let case = |name: &str, height: f64, expected: Vec<f64>| {
        let text = seen(&bands, mu0, mu, 0.0, height, &medium);
        Case::new(name, bands, text, expected)
            .labels(labels.clone())
            .depth(1)
            .brightest(0.1)
            .light_sampling_only()
    };
    [
        case("single scattering R", 1.0, (0..8).map(reflected).collect()),
        case("single scattering T", -1.0, (0..8).map(transmitted).collect()),
    ]
}
