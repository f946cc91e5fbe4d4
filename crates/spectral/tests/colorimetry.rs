//! Colours with known answers.
#![allow(clippy::unwrap_used)] // all of this is test code

use tyndall_spectral::cie::{LUMENS_PER_WATT, matching_functions, xyz, xyz_over};
use tyndall_spectral::colour::{ColourSpace, SpaceName, chromaticity, delta_e_2000, lab, white_balance};
use tyndall_spectral::curve::planck;
use tyndall_spectral::illuminant::illuminant;
use tyndall_spectral::strategy::{FixedSet, Rule};
use tyndall_spectral::{Curve, LambdaRange, Outside};

const INNER: LambdaRange = LambdaRange { min: 380.0, max: 780.0 };

/// Rows of a table: the first field and the numbers after it.
fn rows(text: &str) -> Vec<(&str, Vec<f64>)> {
    let lines = text.lines().filter(|l| !l.starts_with('#')).skip(1);
    let numbers = |fields: std::str::Split<'_, char>| fields.map(|f| f.parse().unwrap()).collect();
    lines.map(|l| l.split(',')).map(|mut f| (f.next().unwrap(), numbers(f))).collect()
}

/// Reflectances of the 24 patches.
fn patches() -> Vec<Curve> {
    let rows = rows(include_str!("../data/tests/colorchecker_reflectances.csv"));
    let lambda: Vec<f32> = rows.iter().map(|r| r.0.parse().unwrap()).collect();
    let column = |i: usize| rows.iter().map(|r| r.1[i] as f32).collect::<Vec<f32>>();
    (0..24).map(|i| Curve::linear(&lambda, &column(i), Outside::Hold).unwrap()).collect()
}

#[test]
fn colour_checker() {
    let expected = rows(include_str!("../data/tests/colorchecker_xyz.csv"));
    for (i, patch) in patches().iter().enumerate() {
        for (j, name) in ["D50", "D65", "A"].into_iter().enumerate() {
            let light = illuminant(name, Outside::Zero).unwrap();
            let white = xyz_over(&light, INNER)[1];
            let got = xyz_over(&patch.times(&light), INNER).map(|v| 100.0 * v / white);
            for k in 0..3 {
                let known = expected[i].1[3 * j + k];
                assert!(
                    (got[k] - known).abs() < 2e-3,
                    "{} under {name}: {} against {known}",
                    expected[i].0,
                    got[k]
                );
            }
        }
    }
}

#[test]
fn black_bodies() {
    let known = [
        (1000.0, [0.652751, 0.344462], 2.68697),
        (1500.0, [0.585718, 0.393121], 7740.31),
        (1900.0, [0.537777, 0.411202], 241721.0),
        (2856.0, [0.447535, 0.407428], 19749800.0),
        (4000.0, [0.38044, 0.376747], 252807000.0),
        (5000.0, [0.345101, 0.351608], 918111000.0),
        (6500.0, [0.313526, 0.323628], 3072530000.0),
        (10000.0, [0.280634, 0.288288], 13260500000.0),
    ];
    for (kelvin, xy, luminance) in known {
        let got = xyz(&Curve::blackbody_absolute(kelvin as f32).unwrap());
        let [x, y] = chromaticity(got);
        assert!((x - xy[0]).abs() < 2e-6 && (y - xy[1]).abs() < 2e-6, "{kelvin} K: {x} {y}");
        let candela = f64::from(LUMENS_PER_WATT) * got[1];
        assert!((candela / luminance - 1.0).abs() < 1e-5, "{kelvin} K: {candela} cd/m2");
        let sum: f64 = (360..=830).map(|nm| planck(kelvin, f64::from(nm))).sum();
        assert!(sum > 0.0);
    }
}

/// X, Y, Z (light's Y = 100) behind an absorber of the thickness 0.5, 1, 2, 5.
const BEER_LAMBERT: [(f32, [f64; 3], [f64; 3]); 4] = [
    (0.5, [60.05918, 64.13042, 85.47036], [44.91086, 50.34352, 98.83337]),
    (1.0, [38.67836, 41.41463, 67.23774], [27.92275, 31.52291, 97.81839]),
    (2.0, [17.08635, 17.63433, 41.87398], [19.56823, 18.22357, 96.10675]),
    (5.0, [2.44541, 1.60574, 10.60454], [16.6909, 8.91587, 92.24062]),
];

#[test]
fn light_behind_chromatic_absorbers() {
    let range: Vec<f32> = (360u16..=830).map(f32::from).collect();
    let behind = |light: &Curve, sigma: &dyn Fn(f32) -> f32| {
        let transmittance: Vec<f32> = range.iter().map(|&l| (-sigma(l)).exp()).collect();
        let white = xyz(light)[1];
        xyz(&light.times(&Curve::dense(360, &transmittance, Outside::Zero).unwrap()))
            .map(|v| 100.0 * v / white)
    };
    let d65 = illuminant("D65", Outside::Zero).unwrap();
    for (d, linear, gaussian) in BEER_LAMBERT {
        let ramp = move |l: f32| d * (0.1 + 1.9 * (l - 360.0) / 470.0);
        let bump = move |l: f32| d * 3.0 * (-0.5 * ((l - 600.0) / 40.0) * ((l - 600.0) / 40.0)).exp();
        for (got, known) in [(behind(&d65, &ramp), linear), (behind(&Curve::ONE, &bump), gaussian)] {
            for k in 0..3 {
                assert!((got[k] - known[k]).abs() < 1e-3, "d = {d}: {} against {}", got[k], known[k]);
            }
        }
    }
}

/// Linear sRGB of every patch under `light`, by a fixed set of wavelengths.
fn patch_colours(light: &Curve, count: usize, rule: Rule) -> Vec<f64> {
    let set = FixedSet::new(INNER, count, rule).unwrap();
    let space = ColourSpace::get(SpaceName::Srgb);
    let white = xyz_over(light, INNER)[1];
    let integral = |patch: &Curve, k: usize| -> f64 {
        let value = |l: f32| f64::from(matching_functions()[k].eval(l) * light.eval(l) * patch.eval(l));
        set.lambda().iter().map(|&l| value(l) * f64::from(set.weight())).sum()
    };
    let colour = |patch: &Curve| space.rgb_from_xyz.apply([0, 1, 2].map(|k| integral(patch, k) / white));
    patches().iter().flat_map(colour).collect()
}

#[test]
fn fixed_sets_have_the_predicted_colour_error() {
    let rms = |a: &[f64], b: &[f64]| {
        let sum: f64 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
        (sum / a.len() as f64).sqrt()
    };
    let table = include_str!("../data/tests/quadrature_error.csv");
    let rows: Vec<Vec<&str>> =
        table.lines().filter(|l| !l.starts_with('#')).skip(1).map(|l| l.split(',').collect()).collect();
    assert_eq!(rows.len(), 60);
    for (name, light) in [("D65", "D65"), ("A", "A"), ("FL11", "F11")] {
        let light = illuminant(light, Outside::Zero).unwrap();
        for (word, rule) in [("midpoint", Rule::Midpoint), ("endpoints", Rule::Endpoints)] {
            let reference = patch_colours(&light, 80, rule);
            for row in rows.iter().filter(|r| r[0] == name && r[1] == word) {
                let count = row[2].parse().unwrap();
                let got = rms(&patch_colours(&light, count, rule), &reference);
                let known: f64 = row[3].parse().unwrap();
                // six decimals, and under FL11 a white that differs by 3.5e-5 between the two computations
                assert!(
                    (got - known).abs() < 1e-6 + 1e-4 * known,
                    "{name}, {word}, {count}: {got} against {known}"
                );
            }
        }
    }
}

#[test]
fn white_balance_keeps_patches_close() {
    // a patch under A, balanced to D65, is nearer to the patch under D65 than without balancing
    let [a, d65] = ["A", "D65"].map(|name| illuminant(name, Outside::Zero).unwrap());
    let (white_a, white_d65) = (xyz(&a), xyz(&d65));
    let balance = white_balance(chromaticity(white_a), chromaticity(white_d65));
    let (mut plain, mut balanced) = (0.0, 0.0);
    for patch in patches() {
        let target = xyz(&patch.times(&d65)).map(|v| v / white_d65[1]);
        let seen = xyz(&patch.times(&a)).map(|v| v / white_a[1]);
        let white = white_d65.map(|v| v / white_d65[1]);
        let in_lab = |v: [f64; 3]| lab(v, white);
        plain += delta_e_2000(in_lab(seen), in_lab(target)) / 24.0;
        balanced += delta_e_2000(in_lab(balance.apply(seen)), in_lab(target)) / 24.0;
    }
    assert!(balanced < 5.0 && plain > 3.0 * balanced, "mean Delta E 2000: {balanced} against {plain}");
}
