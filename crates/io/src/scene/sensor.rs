//! Measured camera sensors: their curves, and the matrix that takes their RGB to XYZ.
//!
//! The matrix is the best in the mean square over the 24 patches of a colour chart: seen by the sensor under the white
//! that it is balanced for, and by the eye under the white of the film's colour space (Karaimer & Brown 2018; pbrt-v4).

use std::sync::LazyLock;
use tyndall_film::Sensor;
use tyndall_spectral::{ColourSpace, Curve, LambdaRange, Outside, cie, illuminant};

type Matrix = [[f64; 3]; 3];

struct Measured {
    name: String,
    curves: [Curve; 3],
}

static SENSORS: LazyLock<Vec<Measured>> = LazyLock::new(|| {
    let text = include_str!("../../data/camera_sensors.csv");
    let rows: Vec<Vec<&str>> = text.lines().skip(2).map(|l| l.split(',').collect()).collect();
    let of_one = |rows: &[Vec<&str>]| {
        let column = |k: usize| -> Vec<f32> {
            rows.iter().map(|r| r[k].parse().expect("the table holds numbers")).collect()
        };
        let lambda = column(1);
        let curve = |k| Curve::linear(&lambda, &column(k), Outside::Zero).expect("the table ascends");
        Measured { name: rows[0][0].into(), curves: [curve(2), curve(3), curve(4)] }
    };
    rows.chunk_by(|a, b| a[0] == b[0]).map(of_one).collect()
});

/// Reflectances of the patches.
static PATCHES: LazyLock<Vec<Curve>> = LazyLock::new(|| {
    let text = include_str!("../../data/colorchecker_reflectances.csv");
    let rows = text.lines().filter(|l| !l.starts_with('#')).skip(1);
    let rows: Vec<Vec<f32>> =
        rows.map(|l| l.split(',').map(|v| v.parse().expect("the table holds numbers")).collect()).collect();
    let column = |k: usize| rows.iter().map(|r| r[k]).collect::<Vec<f32>>();
    let lambda = column(0);
    let patch = |k| Curve::linear(&lambda, &column(k), Outside::Hold).expect("the table ascends");
    (1..rows[0].len()).map(patch).collect()
});

/// Names of all measured sensors.
pub fn names() -> impl Iterator<Item = &'static str> {
    SENSORS.iter().map(|s| s.name.as_str())
}

/// The sensor `name`, balanced for daylight of `kelvin`; `None` for names and temperatures that do not exist.
pub fn sensor(name: &str, kelvin: f64, space: &ColourSpace, imaging_ratio: f64) -> Option<Sensor> {
    let measured = SENSORS.iter().find(|s| s.name == name)?;
    let white = illuminant::daylight(kelvin).ok()?;
    let seen: Vec<_> = PATCHES.iter().map(|p| projected(p, &white, &measured.curves)).collect();
    // the sensor's green and the eye's luminance agree on white
    let scale = inner(&white, cie::y_bar()) / inner(&white, &measured.curves[1]);
    let eye = cie::matching_functions();
    let wanted: Vec<_> =
        PATCHES.iter().map(|p| projected(p, &space.illuminant, eye).map(|v| v * scale)).collect();
    let matrix = least_squares(&seen, &wanted)?;
    Some(Sensor::new(measured.curves.clone(), matrix, imaging_ratio, LambdaRange::VISIBLE))
}

fn nanometres() -> impl Iterator<Item = f32> {
    (360..=830).map(|l| l as f32)
}

fn inner(a: &Curve, b: &Curve) -> f64 {
    nanometres().map(|l| f64::from(a.eval(l)) * f64::from(b.eval(l))).sum()
}

/// What the curves see of a patch under a light, over what the second sees of the light.
fn projected(patch: &Curve, light: &Curve, curves: &[Curve; 3]) -> [f64; 3] {
    let all = inner(light, &curves[1]);
    [0, 1, 2].map(|k| {
        let at = |l: f32| f64::from(curves[k].eval(l)) * f64::from(patch.eval(l)) * f64::from(light.eval(l));
        nanometres().map(at).sum::<f64>() / all
    })
}

/// `M` with the least `sum |M a - b|^2`: `M = (sum b a^T)(sum a a^T)^-1`.
fn least_squares(a: &[[f64; 3]], b: &[[f64; 3]]) -> Option<Matrix> {
    let moments = |x: &[[f64; 3]]| -> Matrix {
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| x.iter().zip(a).map(|(x, a)| x[i] * a[j]).sum()))
    };
    let (ba, aa) = (moments(b), moments(a));
    let cofactor = |i: usize, j: usize| {
        let (r, s) = ((i + 1) % 3, (i + 2) % 3);
        let (c, d) = ((j + 1) % 3, (j + 2) % 3);
        aa[r][c] * aa[s][d] - aa[r][d] * aa[s][c]
    };
    let determinant: f64 = (0..3).map(|j| aa[0][j] * cofactor(0, j)).sum();
    if !(determinant.abs() > 0.0 && determinant.is_finite()) {
        return None;
    }
    let inverse: Matrix = [0, 1, 2].map(|i| [0, 1, 2].map(|j| cofactor(j, i) / determinant));
    Some([0, 1, 2].map(|i| [0, 1, 2].map(|j| (0..3).map(|k| ba[i][k] * inverse[k][j]).sum())))
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_spectral::SpaceName;

    #[test]
    fn seventeen_cameras_and_a_chart() {
        assert_eq!((names().count(), PATCHES.len()), (17, 24));
        assert!(names().any(|n| n == "canon_eos_5d_mkiv"));
        let space = ColourSpace::get(SpaceName::Srgb);
        assert!(sensor("polaroid", 6500.0, space, 1.0).is_none());
    }

    /// Every camera sees the chart's patches nearly as the eye does.
    #[test]
    fn cameras_see_the_chart() {
        let space = ColourSpace::get(SpaceName::Srgb);
        for measured in SENSORS.iter() {
            let white = illuminant::daylight(6500.0).unwrap();
            let seen: Vec<_> = PATCHES.iter().map(|p| projected(p, &white, &measured.curves)).collect();
            let eye = cie::matching_functions();
            let wanted: Vec<_> = PATCHES.iter().map(|p| projected(p, &space.illuminant, eye)).collect();
            let m = least_squares(&seen, &wanted).unwrap();
            let apply = |v: &[f64; 3]| m.map(|r| r[0] * v[0] + r[1] * v[1] + r[2] * v[2]);
            let off =
                |(s, w): (&[f64; 3], &[f64; 3])| (0..3).map(|k| (apply(s)[k] - w[k]).powi(2)).sum::<f64>();
            let rms = (seen.iter().zip(&wanted).map(off).sum::<f64>() / 72.0).sqrt();
            assert!(rms < 0.02, "{}: {rms}", measured.name);
        }
    }

    #[test]
    fn exact_relations_are_found() {
        let a = [[1.0, 0.2, 0.0], [0.0, 1.0, 0.5], [0.3, 0.0, 2.0], [1.0, 1.0, 1.0]];
        let m = [[2.0, 0.1, 0.0], [0.0, 3.0, -1.0], [0.5, 0.0, 1.0]];
        let b = a.map(|a| m.map(|r: [f64; 3]| r[0] * a[0] + r[1] * a[1] + r[2] * a[2]));
        let found = least_squares(&a, &b).unwrap();
        assert!((0..9).all(|n| (found[n / 3][n % 3] - m[n / 3][n % 3]).abs() < 1e-9));
    }
}
