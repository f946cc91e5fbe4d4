//! RGB colour spaces.

use std::sync::OnceLock;

use super::matrix::Matrix3;
use crate::cie::{CIE_Y_INTEGRAL, xyz};
use crate::curve::Curve;
use crate::error::SpectralError;
use crate::illuminant::{illuminant, normalized};
use crate::range::Outside;

/// The colour spaces that scenes can name, with the primaries that pbrt-v4 gives them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SpaceName {
    /// ITU-R BT.709 primaries, D65.
    Srgb,
    /// P3 primaries with the display white D65.
    DciP3,
    /// ITU-R BT.2020 primaries, D65.
    Rec2020,
    /// ACES AP0 primaries, the ACES white near D60.
    Aces2065,
}

impl SpaceName {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Srgb, Self::DciP3, Self::Rec2020, Self::Aces2065];

    /// The name in scene files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Srgb => "srgb",
            Self::DciP3 => "dci-p3",
            Self::Rec2020 => "rec2020",
            Self::Aces2065 => "aces2065-1",
        }
    }

    /// Chromaticities of red, green and blue, and the name of the white's illuminant.
    fn definition(self) -> ([[f64; 2]; 3], &'static str) {
        match self {
            Self::Srgb => ([[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]], "D65"),
            Self::DciP3 => ([[0.68, 0.32], [0.265, 0.690], [0.15, 0.06]], "D65"),
            Self::Rec2020 => ([[0.708, 0.292], [0.170, 0.797], [0.131, 0.046]], "D65"),
            Self::Aces2065 => ([[0.7347, 0.2653], [0.0, 1.0], [0.0001, -0.077]], "D60"),
        }
    }
}

impl std::str::FromStr for SpaceName {
    type Err = SpectralError;

    /// Upper and lower case are the same.
    fn from_str(name: &str) -> Result<Self, SpectralError> {
        let known = Self::ALL.into_iter().find(|s| s.name().eq_ignore_ascii_case(name));
        known.ok_or_else(|| SpectralError::Unknown { what: "colour space", name: name.to_owned() })
    }
}

/// Primaries, white and matrices of an RGB space. RGB (1, 1, 1) is the white with Y = 1.
#[derive(Clone, Debug)]
pub struct ColourSpace {
    /// Which one.
    pub name: SpaceName,
    /// Chromaticities of red, green, blue.
    pub primaries: [[f64; 2]; 3],
    /// X, Y = 1, Z of the white, by 1 nm sums over its spectrum.
    pub white: [f64; 3],
    /// The white's spectrum, scaled to Y = 1 (its integral with ybar is 106.856895 nm).
    pub illuminant: Curve,
    /// RGB to XYZ.
    pub xyz_from_rgb: Matrix3,
    /// XYZ to RGB.
    pub rgb_from_xyz: Matrix3,
}

impl ColourSpace {
    /// The space `name`, made once.
    pub fn get(name: SpaceName) -> &'static Self {
        static SPACES: OnceLock<[ColourSpace; 4]> = OnceLock::new();
        &SPACES.get_or_init(|| SpaceName::ALL.map(ColourSpace::build))[name as usize]
    }

    fn build(name: SpaceName) -> Self {
        let (primaries, white_name) = name.definition();
        let table = illuminant(white_name, Outside::Hold).expect("the whites are tabulated");
        let illuminant = normalized(&table);
        let white = xyz(&illuminant).map(|v| v / f64::from(CIE_Y_INTEGRAL));
        let columns = Matrix3::from_columns(primaries.map(xyz_from_xy));
        let weights = columns.inverse().expect("primaries are independent").apply(white);
        let xyz_from_rgb = columns.times(&Matrix3::diagonal(weights));
        let rgb_from_xyz = xyz_from_rgb.inverse().expect("primaries are independent");
        Self { name, primaries, white, illuminant, xyz_from_rgb, rgb_from_xyz }
    }
}

/// X, Y = 1, Z of a chromaticity; zero where y is.
pub fn xyz_from_xy([x, y]: [f64; 2]) -> [f64; 3] {
    if y == 0.0 { [0.0; 3] } else { [x / y, 1.0, (1.0 - x - y) / y] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_matrix_by_independent_computation() {
        // from a white rounded to 95.0469, 108.883: hence no closer than 2e-5
        let expected = [
            [3.2404548, -1.5371389, -0.4985315],
            [-0.9692664, 1.8760109, 0.0415561],
            [0.0556434, -0.2040259, 1.0572252],
        ];
        let got = ColourSpace::get(SpaceName::Srgb).rgb_from_xyz.0;
        for i in 0..3 {
            for j in 0..3 {
                assert!((got[i][j] - expected[i][j]).abs() < 2e-5, "{} {}", got[i][j], expected[i][j]);
            }
        }
    }

    #[test]
    fn round_trips_and_whites_in_all_spaces() {
        for name in SpaceName::ALL {
            let space = ColourSpace::get(name);
            assert_eq!(space.name, name);
            assert_eq!(name.name().to_uppercase().parse::<SpaceName>(), Ok(name));
            let white = space.xyz_from_rgb.apply([1.0; 3]);
            assert!(white.iter().zip(space.white).all(|(a, b)| (a - b).abs() < 1e-12));
            assert!((space.white[1] - 1.0).abs() < 1e-6);
            for rgb in [[0.2, 0.5, 0.9], [1.0, 0.0, 0.0], [-0.1, 3.0, 0.4]] {
                let back = space.rgb_from_xyz.apply(space.xyz_from_rgb.apply(rgb));
                assert!(rgb.iter().zip(back).all(|(a, b)| (a - b).abs() < 1e-12), "{name:?}");
            }
        }
        assert!("adobe".parse::<SpaceName>().is_err());
    }
}
