//! CIE illuminants: A, D50, D60 (the ACES white), D65, E, the lamps F1 to F12, and daylight of any temperature.
//!
//! Relative spectral power, straight lines between the CIE's 5 nm values, zero outside the tables (A and D: 300 to
//! 830 nm, F: 380 to 780 nm). The tables differ from those in pbrt-v4 in D50 (pbrt's is another spectrum, 14 % less at
//! 670 nm), D60 (0.05 %) and single values of F5, F6, F9, F10 and F12 (up to 0.5, misprints there): the CIE's are used.

use std::sync::OnceLock;

use crate::cie::{CIE_Y_INTEGRAL, y_integral};
use crate::curve::Curve;
use crate::error::{SpectralError, require};
use crate::range::Outside;
use crate::table::Table;

fn tables() -> &'static [Table; 2] {
    static TABLES: OnceLock<[Table; 2]> = OnceLock::new();
    TABLES.get_or_init(|| {
        [
            Table::parse(include_str!("../data/illuminants_a_d.csv")),
            Table::parse(include_str!("../data/illuminants_f.csv")),
        ]
    })
}

/// Names of all illuminants.
pub fn names() -> impl Iterator<Item = &'static str> {
    tables().iter().flat_map(|t| t.value_names().iter().copied()).chain(["E"])
}

/// The illuminant `name` (`A`, `D50`, `D60`, `D65`, `E`, `F1` ... `F12`) as tabulated, with `outside` beyond the table.
pub fn illuminant(name: &str, outside: Outside) -> Result<Curve, SpectralError> {
    if name == "E" {
        return Ok(Curve::ONE);
    }
    let column = tables().iter().find_map(|t| Some((t.lambda(), t.column(name)?)));
    let (lambda, values) = column
        .filter(|_| name != "lambda_nm")
        .ok_or_else(|| SpectralError::Unknown { what: "illuminant", name: name.to_owned() })?;
    Curve::linear(lambda, values, outside)
}

/// `curve` scaled so that its integral with ybar is that of ybar itself: Y = 1 in pbrt-v4's film.
pub fn normalized(curve: &Curve) -> Curve {
    curve.scaled((f64::from(CIE_Y_INTEGRAL) / y_integral(curve)) as f32)
}

/// Chromaticity (x, y) of daylight with the correlated colour temperature `kelvin` of 4000 to 25000 K. CIE 15:2018.
pub fn daylight_chromaticity(kelvin: f64) -> Result<[f64; 2], SpectralError> {
    require((4000.0..=25000.0).contains(&kelvin), "daylight temperature [K]", "4000 to 25000", kelvin)?;
    let t = 1e3 / kelvin;
    let x = if kelvin <= 7000.0 {
        0.244063 + t * (0.09911 + t * (2.9678 - t * 4.6070))
    } else {
        0.237040 + t * (0.24748 + t * (1.9018 - t * 2.0064))
    };
    Ok([x, -3.0 * x * x + 2.870 * x - 0.275])
}

/// Daylight of the correlated colour temperature `kelvin`, 1 at about 560 nm times 100: `S0 + M1 S1 + M2 S2` with M1 and
/// M2 not rounded. The nominal D50, D60, D65 have `kelvin = nominal * 1.4388 / 1.4380`. CIE 15:2018.
pub fn daylight(kelvin: f64) -> Result<Curve, SpectralError> {
    let [x, y] = daylight_chromaticity(kelvin)?;
    let m = 0.0241 + 0.2562 * x - 0.7341 * y;
    let m1 = (-1.3515 - 1.7703 * x + 5.9114 * y) / m;
    let m2 = (0.0300 - 31.4424 * x + 30.0717 * y) / m;
    static COMPONENTS: OnceLock<Table> = OnceLock::new();
    let table = COMPONENTS.get_or_init(|| Table::parse(include_str!("../data/daylight_components.csv")));
    let column = |name| table.column(name).expect("the table has S0, S1 and S2");
    let (s0, s1, s2) = (column("S0"), column("S1"), column("S2"));
    let values: Vec<f32> = (0..s0.len())
        .map(|i| f64::from(s0[i]) + m1 * f64::from(s1[i]) + m2 * f64::from(s2[i]))
        .map(|v| v as f32)
        .collect();
    Curve::linear(table.lambda(), &values, Outside::Zero)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cie::{xyz, xyz_over};
    use crate::range::LambdaRange;

    /// White points by 1 nm sums on 360-830 and 380-780 nm (independent computation; Y = 100).
    const WHITES: [(&str, [f64; 3], [f64; 3]); 6] = [
        ("A", [109.8486, 100.0, 35.591], [109.8479, 100.0, 35.5873]),
        ("D50", [96.4238, 100.0, 82.5129], [96.4215, 100.0, 82.5017]),
        ("D65", [95.0469, 100.0, 108.883], [95.0423, 100.0, 108.861]),
        ("E", [100.008, 100.0, 100.0331], [99.9987, 100.0, 99.9903]),
        ("F2", [99.1461, 100.0, 67.3148], [99.1461, 100.0, 67.3148]),
        ("F11", [100.8995, 100.0, 64.264], [100.8995, 100.0, 64.264]),
    ];

    #[test]
    fn white_points() {
        let inner = LambdaRange { min: 380.0, max: 780.0 };
        for (name, full, part) in WHITES {
            let curve = illuminant(name, Outside::Zero).unwrap();
            for (got, expected) in [(xyz(&curve), full), (xyz_over(&curve, inner), part)] {
                for c in 0..3 {
                    let value = 100.0 * got[c] / got[1];
                    assert!(
                        (value - expected[c]).abs() < 0.01,
                        "{name}[{c}]: {value} against {}",
                        expected[c]
                    );
                }
            }
        }
    }

    #[test]
    fn daylight_formula_gives_the_standard_tables() {
        for (name, nominal) in [("D50", 5000.0), ("D60", 6000.0), ("D65", 6500.0)] {
            let formula = daylight(nominal * 1.4388 / 1.4380).unwrap();
            let table = illuminant(name, Outside::Zero).unwrap();
            for nm in 300u16..=830 {
                let l = f32::from(nm);
                // the tables use M1 and M2 rounded to three decimals
                assert!((formula.eval(l) - table.eval(l)).abs() < 0.02, "{name} at {l}");
            }
        }
        assert!(daylight(3999.0).is_err() && daylight(25001.0).is_err());
    }

    #[test]
    fn every_name_works_and_others_do_not() {
        assert_eq!(names().count(), 17);
        for name in names() {
            let curve = normalized(&illuminant(name, Outside::Hold).unwrap());
            assert!((y_integral(&curve) - 106.856895).abs() < 1e-4, "{name}");
        }
        assert!(matches!(illuminant("D99", Outside::Hold), Err(SpectralError::Unknown { .. })));
        assert!(illuminant("lambda_nm", Outside::Hold).is_err());
    }
}
