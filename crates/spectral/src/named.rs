//! The spectra that pbrt-v4 scenes can name.
//!
//! `stdillum-A`, `-D50`, `-D65`, `-F1` ... `-F12`, `illum-acesD60`: CIE illuminants scaled to Y = 1 (integral with ybar
//! 106.856895 nm). `metal-{Ag,Al,Au,Cu,CuZn,MgO,TiO2}-{eta,k}`: measured tables. `glass-{BK7,BAF10,FK51A,LASF9,F5,F10,F11}`:
//! Schott glasses (F5 is SF5, as in pbrt-v4; the true names `glass-SF5` work too) from their Sellmeier formula, within
//! 4e-4 of pbrt-v4's coarser tables. All are held beyond their tables, which is what pbrt-v4 does on 360 to 830 nm.

use std::sync::OnceLock;

use crate::curve::Curve;
use crate::illuminant::{illuminant, normalized};
use crate::range::Outside;
use crate::table::Table;

const METALS: [&str; 7] = ["Ag", "Al", "Au", "Cu", "CuZn", "MgO", "TiO2"];
const GLASSES: [&str; 7] = ["BK7", "BAF10", "FK51A", "LASF9", "SF5", "SF10", "SF11"];

/// The spectrum pbrt-v4 calls `name`, or `None`.
pub fn named_spectrum(name: &str) -> Option<Curve> {
    if let Some(rest) = name.strip_prefix("metal-") {
        let (metal, part) = rest.rsplit_once('-')?;
        return metal_curve(metal, part);
    }
    if let Some(glass) = name.strip_prefix("glass-") {
        return glass_curve(glass);
    }
    let white = match name {
        "illum-acesD60" => "D60",
        _ => name.strip_prefix("stdillum-").filter(|&n| n != "D60" && n != "E")?,
    };
    illuminant(white, Outside::Hold).ok().map(|curve| normalized(&curve))
}

/// All names that [`named_spectrum`] knows.
pub fn names() -> Vec<String> {
    let metals = METALS.iter().flat_map(|m| ["eta", "k"].map(|part| format!("metal-{m}-{part}")));
    let glasses = GLASSES.iter().map(|g| format!("glass-{g}"));
    let aliases = ["glass-F5", "glass-F10", "glass-F11", "illum-acesD60"].map(str::to_owned);
    let plain = crate::illuminant::names().filter(|&n| n != "D60" && n != "E");
    metals.chain(glasses).chain(aliases).chain(plain.map(|n| format!("stdillum-{n}"))).collect()
}

/// Real part `eta` or imaginary part `k` of a metal's refractive index.
fn metal_curve(metal: &str, part: &str) -> Option<Curve> {
    static TABLE: OnceLock<Table> = OnceLock::new();
    let table = TABLE.get_or_init(|| Table::parse_labelled(include_str!("../data/metals.csv")));
    let values = table.column(part).filter(|_| part != "lambda_nm")?;
    let rows = table.rows_of(metal)?;
    Some(
        Curve::linear(&table.lambda()[rows.clone()], &values[rows], Outside::Hold).expect("tables are sound"),
    )
}

/// `n^2 = 1 + sum_i B_i L^2 / (L^2 - C_i)` with L in um (Sellmeier 1871), as a 1 nm table over the formula's range.
fn glass_curve(name: &str) -> Option<Curve> {
    static TABLE: OnceLock<Table> = OnceLock::new();
    let table = TABLE.get_or_init(|| Table::parse_labelled(include_str!("../data/glasses.csv")));
    let glass = match name {
        "F5" => "SF5",
        "F10" => "SF10",
        "F11" => "SF11",
        _ => name,
    };
    let row = table.rows_of(glass)?.start;
    let at = |column: &str| f64::from(table.column(column).expect("all columns are there")[row]);
    let terms = [("B1", "C1"), ("B2", "C2"), ("B3", "C3")].map(|(b, c)| (at(b), at(c)));
    let n = |nm: f64| {
        let square = nm * nm * 1e-6;
        (1.0 + terms.iter().map(|(b, c)| b * square / (square - c)).sum::<f64>()).sqrt()
    };
    let (first, last) = ((at("min_um") * 1e3).round() as u32, (at("max_um") * 1e3).round() as u32);
    let values: Vec<f32> = (first..=last).map(|nm| n(f64::from(nm)) as f32).collect();
    Some(Curve::dense(first, &values, Outside::Hold).expect("the formula is finite on its range"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cie::y_integral;
    use crate::range::LambdaRange;

    #[test]
    fn every_name_gives_a_positive_spectrum_on_the_visible_range() {
        let names = names();
        assert_eq!(names.len(), 14 + 7 + 4 + 15);
        for name in names {
            let curve = named_spectrum(&name).unwrap();
            let [low, high] = curve.bounds(LambdaRange::VISIBLE);
            let dark_ends = name.starts_with("stdillum-F") || name == "metal-MgO-k" || name == "metal-TiO2-k";
            assert!(low >= 0.0 && (low > 0.0 || dark_ends) && high.is_finite(), "{name}: {low} {high}");
            if name.contains("illum") {
                assert!((y_integral(&curve) - 106.856895).abs() < 1e-4, "{name}");
            }
        }
        for name in ["stdillum-D60", "metal-Ag", "metal-Ag-lambda_nm", "metal-Xx-k", "glass-F99", "Ag", ""] {
            assert!(named_spectrum(name).is_none(), "{name}");
        }
    }

    #[test]
    fn known_indices() {
        let index = |name: &str, l: f32| named_spectrum(name).unwrap().eval(l);
        // data sheets: n_d of the glasses at 587.56 nm, their Abbe number from the F and C lines
        for (glass, n_d, abbe) in [
            ("BK7", 1.5168, 64.17),
            ("F5", 1.67271, 32.25),
            ("FK51A", 1.48656, 84.47),
            ("SF11", 1.78472, 25.68),
        ] {
            let name = format!("glass-{glass}");
            assert!((index(&name, 587.56) - n_d).abs() < 1e-5, "{glass}: {}", index(&name, 587.56));
            let dispersion = index(&name, 486.13) - index(&name, 656.27);
            assert!(((n_d - 1.0) / dispersion - abbe).abs() < 0.05, "{glass}");
        }
        // gold is red: little absorption of red light inside, much reflection
        assert!(index("metal-Au-eta", 650.0) < 0.2 && index("metal-Au-eta", 450.0) > 1.3);
        assert!((index("metal-CuZn-eta", 500.0) - 0.686).abs() < 1e-6);
        assert!((index("metal-Ag-k", 600.0) - 3.75).abs() < 0.3);
    }
}
