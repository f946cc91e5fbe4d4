//! Chromatic adaptation.

use super::matrix::Matrix3;
use super::space::xyz_from_xy;

/// Cone responses of Lam and Rigg ("Bradford"), as pbrt-v4 uses them.
const LMS_FROM_XYZ: Matrix3 =
    Matrix3([[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]]);

/// The matrix on X, Y, Z that takes the white of chromaticity `from` to that of `to`, by the linear Bradford transform.
/// Source: K. M. Lam, "Metamerism and colour constancy", thesis, University of Bradford, 1985.
pub fn white_balance(from: [f64; 2], to: [f64; 2]) -> Matrix3 {
    let source = LMS_FROM_XYZ.apply(xyz_from_xy(from));
    let target = LMS_FROM_XYZ.apply(xyz_from_xy(to));
    let gain = Matrix3::diagonal([0, 1, 2].map(|i| target[i] / source[i]));
    let xyz_from_lms = LMS_FROM_XYZ.inverse().expect("the Bradford matrix is regular");
    xyz_from_lms.times(&gain).times(&LMS_FROM_XYZ)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whites_map_to_whites_and_nothing_changes_without_a_change() {
        let (a, d65) = ([0.44757, 0.40745], [0.31271, 0.32902]);
        let got = white_balance(a, d65).apply(xyz_from_xy(a));
        assert!(got.iter().zip(xyz_from_xy(d65)).all(|(g, e)| (g - e).abs() < 1e-12));
        let same = white_balance(d65, d65);
        for i in 0..3 {
            for j in 0..3 {
                assert!((same.0[i][j] - Matrix3::IDENTITY.0[i][j]).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn d65_to_d50_is_the_published_matrix() {
        // Lindbloom's Bradford matrix, whites 0.95047/1/1.08883 and 0.96422/1/0.82521
        let published = [
            [1.0478112, 0.0228866, -0.0501270],
            [0.0295424, 0.9904844, -0.0170491],
            [-0.0092345, 0.0150436, 0.7521316],
        ];
        let xy = |w: [f64; 3]| super::super::chromaticity(w);
        let m = white_balance(xy([0.95047, 1.0, 1.08883]), xy([0.96422, 1.0, 0.82521]));
        for i in 0..3 {
            for j in 0..3 {
                assert!((m.0[i][j] - published[i][j]).abs() < 1e-6, "{} {}", m.0[i][j], published[i][j]);
            }
        }
    }
}
