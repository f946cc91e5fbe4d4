//! Reading of tables: normalisation, order, shape, interpolation.

use super::Tabulated;
use super::tests::wavelengths;
use crate::ScatterError;
use std::f64::consts::PI;
use tyndall_spectral::Outside;

const THETA: [f64; 5] = [0.0, 45.0, 90.0, 135.0, 180.0];

fn grey(value: f64) -> Result<Tabulated, ScatterError> {
    Tabulated::from_degrees(&[550.0], &THETA, &[value; 5], Outside::Hold)
}

#[test]
fn both_normalisations_give_the_same_table() {
    let (one, four_pi) = (grey(0.25 / PI).unwrap(), grey(1.0).unwrap());
    for table in [one, four_pi] {
        assert!((table.eval(0.7, &wavelengths([550.0]))[0] - 0.25 / std::f32::consts::PI).abs() < 1e-8);
        assert!((table.sample(0.25, 550.0).versine - 0.5).abs() < 1e-6);
    }
}

#[test]
fn any_other_normalisation_is_refused() {
    for value in [0.5, 1.02, 0.25, 0.0] {
        assert!(matches!(grey(value), Err(ScatterError::Norm { lambda: 550.0, .. })), "{value}");
    }
    let message = grey(0.5).unwrap_err().to_string();
    assert!(message.contains("1 or 4 pi") && message.contains("6.283185"), "{message}");
}

#[test]
fn wrong_shapes_are_refused() {
    let make = |l: &[f32], t: &[f64], n: usize| Tabulated::from_degrees(l, t, &vec![1.0; n], Outside::Hold);
    assert!(matches!(make(&[550.0], &THETA, 4), Err(ScatterError::Shape { expected: 5, got: 4, .. })));
    assert!(matches!(make(&[], &THETA, 0), Err(ScatterError::Shape { .. })));
    assert!(matches!(make(&[550.0], &[], 0), Err(ScatterError::Shape { .. })));
    assert!(matches!(make(&[550.0], &[0.0, 90.0], 2), Err(ScatterError::Value { got: 90.0, .. })));
    assert!(matches!(
        make(&[550.0], &[0.0, 90.0, 90.0, 180.0], 4),
        Err(ScatterError::Unsorted { index: 2, .. })
    ));
    assert!(matches!(make(&[600.0, 500.0], &THETA, 10), Err(ScatterError::Unsorted { index: 1, .. })));
    assert!(matches!(grey(f64::NAN), Err(ScatterError::Value { .. })));
    assert!(matches!(grey(-1.0), Err(ScatterError::Value { .. })));
}

#[test]
fn cosines_and_degrees_are_the_same_table() {
    let p = [3.0, 1.5, 0.4, 0.3, 0.8];
    let cosines: Vec<f64> = THETA.iter().rev().map(|t| t.to_radians().cos()).collect();
    let norm: f64 = cosines
        .windows(2)
        .zip([0.8, 0.3, 0.4, 1.5, 3.0].windows(2))
        .map(|(c, p)| PI * (c[1] - c[0]) * (p[0] + p[1]))
        .sum();
    let scaled = p.map(|p| p / norm);
    let reversed: Vec<f64> = scaled.iter().rev().copied().collect();
    let a = Tabulated::from_degrees(&[550.0], &THETA, &scaled, Outside::Hold).unwrap();
    let b = Tabulated::from_cosines(&[550.0], &cosines, &reversed, Outside::Hold).unwrap();
    let w = wavelengths([550.0]);
    for v in [0.0_f32, 0.1, 0.9, 1.3, 2.0] {
        assert!((a.eval(v, &w)[0] - b.eval(v, &w)[0]).abs() < 1e-6);
    }
}

#[test]
fn between_wavelengths_it_is_a_mixture_and_outside_held_or_undefined() {
    let p: Vec<f64> =
        [vec![1.0; 5], vec![2.0, 1.0 + 0.5_f64.sqrt(), 1.0, 1.0 - 0.5_f64.sqrt(), 0.0]].concat();
    let table = |rule| Tabulated::from_degrees(&[500.0, 600.0], &THETA, &p, rule).unwrap();
    let w = wavelengths([500.0, 525.0, 600.0, 700.0]);
    let held = table(Outside::Hold).eval(0.0, &w);
    let want = [1.0, 1.25, 2.0, 2.0].map(|x| x * 0.25 / std::f32::consts::PI);
    for k in 0..4 {
        assert!((held[k] - want[k]).abs() < 1e-7, "{held:?}");
    }
    assert!((table(Outside::Hold).mean_cosine(550.0) - 1.0 / 6.0).abs() < 1e-6);
    let strict = table(Outside::Error).eval(0.0, &w);
    assert!(strict[3].is_nan() && strict[2] == held[2]);
}
