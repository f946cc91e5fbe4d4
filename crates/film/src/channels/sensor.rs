//! The sensor: three response curves and the matrix from its RGB to XYZ.
//!
//! pbrt-v4's `cie1931` sensor is XYZ itself, `integral of L xbar` and so on *without* the factor 1/106.857 (pbrt-v4 normalises
//! its lights instead), times the imaging ratio `exposure time * ISO / 100`, which is 1 by default.

use tyndall_spectral::{Curve, LambdaRange, cie};

use super::dense::Dense;
use crate::FilmError;

type Matrix = [[f64; 3]; 3];

/// A sensor's curves, its matrix to XYZ (which holds the white balance), and its imaging ratio.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensor {
    curves: [Curve; 3],
    xyz_from_sensor: Matrix,
    imaging_ratio: f64,
    range: LambdaRange,
}

impl Sensor {
    /// pbrt-v4's `cie1931`: XYZ times the imaging ratio, no white balance.
    pub fn cie1931(imaging_ratio: f64) -> Self {
        let curves = cie::matching_functions().clone();
        Self { curves, xyz_from_sensor: super::IDENTITY, imaging_ratio, range: LambdaRange::VISIBLE }
    }

    /// Any sensor: responses over `range`, and the matrix that takes them to XYZ.
    pub fn new(curves: [Curve; 3], xyz_from_sensor: Matrix, imaging_ratio: f64, range: LambdaRange) -> Self {
        Self { curves, xyz_from_sensor, imaging_ratio, range }
    }

    /// With a white balance: a matrix on XYZ (Bradford or von Kries).
    pub fn balanced(mut self, xyz_from_xyz: &Matrix) -> Self {
        self.xyz_from_sensor = product(xyz_from_xyz, &self.xyz_from_sensor);
        self
    }

    /// pbrt-v4's imaging ratio: exposure time \[s\] times ISO over 100; both at their defaults (1 s, ISO 100) give 1.
    pub fn imaging_ratio(exposure_time: f64, iso: f64) -> f64 {
        exposure_time * iso / 100.0
    }

    /// Dense channels R, G, B of the colour space `rgb_from_xyz`.
    pub(super) fn responses(&self, rgb_from_xyz: &Matrix) -> Result<Dense, FilmError> {
        let refuse = |what: &str| FilmError::Channels { what: what.into() };
        if !(self.imaging_ratio > 0.0 && self.imaging_ratio.is_finite()) {
            return Err(refuse(&format!("expected an imaging ratio > 0, got {}", self.imaging_ratio)));
        }
        if self.range.width() > 10_000.0 {
            return Err(refuse(&format!("a sensor's range is at most 10000 nm, got {}", self.range)));
        }
        let xyz_from_rgb =
            inverse(rgb_from_xyz).ok_or_else(|| refuse("the matrix from XYZ to RGB is singular"))?;
        let mix = product(rgb_from_xyz, &self.xyz_from_sensor).map(|row| row.map(|v| v * self.imaging_ratio));
        let luminance = xyz_from_rgb[1].map(|v| v as f32);
        let dense = Dense::mixed(["R", "G", "B"], luminance, &self.curves, &mix, self.range);
        if dense.is_finite() {
            Ok(dense)
        } else {
            Err(refuse("a response curve is not finite over its range"))
        }
    }
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let entry = |i: usize, j: usize| (0..3).map(|k| a[i][k] * b[k][j]).sum();
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)))
}

/// By cofactors; `None` for a singular matrix.
fn inverse(m: &Matrix) -> Option<Matrix> {
    let cofactor = |i: usize, j: usize| {
        let (a, b) = ((i + 1) % 3, (i + 2) % 3);
        let (c, d) = ((j + 1) % 3, (j + 2) % 3);
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    let det: f64 = (0..3).map(|j| m[0][j] * cofactor(0, j)).sum();
    (det != 0.0 && det.is_finite()).then(|| [0, 1, 2].map(|i| [0, 1, 2].map(|j| cofactor(j, i) / det)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_times_matrix_is_identity() {
        let m = [[3.24, -1.54, -0.5], [-0.97, 1.88, 0.04], [0.06, -0.2, 1.06]];
        let id = product(&inverse(&m).unwrap(), &m);
        for (i, row) in id.iter().enumerate() {
            for (j, v) in row.iter().enumerate() {
                assert!((v - f64::from(u8::from(i == j))).abs() < 1e-12);
            }
        }
        assert!(inverse(&[[1.0, 2.0, 3.0]; 3]).is_none());
    }
}
