//! Colours: patches of the ColorChecker under illuminants, and lights behind absorbers, as X, Y, Z (Y of the light = 100).

use super::{Family, Tolerance};
use crate::validate::{
    bands::{Bands, Dialect},
    case::Case,
    scene,
    table::Table,
};
use tyndall_spectral::{Curve, LambdaRange, cie, named::named_spectrum};

pub(super) const FAMILY: Family = Family {
    name: "colorimetry",
    title: "Colours: X, Y, Z of patches under illuminants and of lights behind absorbers",
    source: "1 nm sums over the CIE 1931 functions; reflectances by Ohta 1997",
    tolerance: Tolerance::Absolute(0.05),
    cases,
};

/// How far sums of 1 nm are from integrals.
const SUMMATION: f64 = 1e-3;

fn cases(dialect: Dialect) -> Vec<Case> {
    let mut out = patches(dialect);
    out.extend(absorbers(dialect));
    out
}

/// A uniform sky with the spectrum of an illuminant.
fn sky(dialect: Dialect, light: &str) -> String {
    let spectrum = if light == "E" { "[300 1 900 1]".into() } else { format!("\"stdillum-{light}\"") };
    format!("LightSource \"infinite\"{} \"spectrum L\" {spectrum}\n", scene::absolute(dialect))
}

/// What makes the light's Y 100: `100 / (sum of S y-bar)`; the plain format of pbrt-v4 has divided by its mean already.
fn factor(dialect: Dialect, light: &str, range: LambdaRange) -> f64 {
    if dialect == Dialect::Pbrt {
        return 100.0;
    }
    let curve = match light {
        "E" => Curve::Constant(1.0),
        name => named_spectrum(&format!("stdillum-{name}")).expect("the illuminant is built in"),
    };
    100.0 / cie::xyz_over(&curve, range)[1]
}

fn patches(dialect: Dialect) -> Vec<Case> {
    let range = LambdaRange { min: 380.0, max: 780.0 };
    let reflectances = Table::parse(include_str!("../../../data/validate/colorchecker_reflectances.csv"));
    let known = Table::parse(include_str!("../../../data/validate/colorchecker_xyz.csv"));
    let bands = Bands::of(1, dialect);
    let lambda = reflectances.texts("lambda_nm");
    let mut out = Vec::new();
    for patch in known.texts("patch") {
        let values = reflectances.texts(patch);
        let pairs: Vec<String> = lambda.iter().zip(values).map(|(l, v)| format!("{l} {v}")).collect();
        let card = format!("Material \"diffuse\" \"spectrum reflectance\" [{}]\n", pairs.join(" "));
        for light in ["D50", "D65", "A"] {
            let camera = scene::parallel_camera(&bands, -1.0);
            let text = format!("{camera}WorldBegin\n{}{card}{}", sky(dialect, light), scene::plane(0.0));
            let row = known.only("patch", patch);
            let xyz = ["X", "Y", "Z"].map(|c| row.column(&format!("{light}_{c}"))[0]);
            let case = Case::new(format!("{patch} under {light}"), bands, text, xyz.into());
            out.push(case.xyz(range, factor(dialect, light, range)).uncertainty(SUMMATION).brightest(100.0));
        }
    }
    out
}

/// D65 behind sigma_a from 0.1 at 360 nm to 2 at 830 nm, and E behind `3 exp(-((lambda - 600) / 40)^2 / 2)`.
fn absorbers(dialect: Dialect) -> Vec<Case> {
    let table = Table::parse(include_str!("../../../data/validate/absorbed_light_xyz.csv"));
    let bands = Bands::of(1, dialect);
    let range = LambdaRange::VISIBLE;
    let sigma = |light: &str, nm: f64| match light {
        "E" => 3.0 * (-0.5 * ((nm - 600.0) / 40.0).powi(2)).exp(),
        _ => 0.1 + 1.9 * (nm - 360.0) / 470.0,
    };
    let case = |row: &Table| {
        let (light, distance) = (row.texts("light")[0], row.column("distance")[0]);
        let pairs: Vec<String> =
            (360..=830).map(|nm| format!("{nm} {}", distance * sigma(light, f64::from(nm)))).collect();
        let medium = format!(
            "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"spectrum sigma_s\" [300 0 900 0] \
             \"spectrum sigma_a\" [{}]\n",
            pairs.join(" ")
        );
        let slab = scene::slab("m", scene::INTERFACE);
        let camera = scene::parallel_camera(&bands, -1.0);
        let text = format!("{camera}WorldBegin\n{}{medium}{slab}", sky(dialect, light));
        let xyz = ["X", "Y", "Z"].map(|c| row.column(c)[0]);
        let case = Case::new(format!("{light} behind {distance}"), bands, text, xyz.into());
        case.xyz(range, factor(dialect, light, range)).uncertainty(SUMMATION).brightest(100.0)
    };
    table.chunks(1).iter().map(case).collect()
}
