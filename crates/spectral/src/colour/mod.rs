//! Colour: RGB spaces, white balance, transfer function, Lab and colour differences. All of it in `f64`, off the hot path.

mod adapt;
mod lab;
mod matrix;
mod space;
mod srgb;

pub use adapt::white_balance;
pub use lab::{delta_e_76, delta_e_2000, lab};
pub use matrix::Matrix3;
pub use space::{ColourSpace, SpaceName, xyz_from_xy};
pub use srgb::{srgb_decode, srgb_encode};

/// Chromaticity (x, y) of X, Y, Z.
pub fn chromaticity(xyz: [f64; 3]) -> [f64; 2] {
    let sum = xyz[0] + xyz[1] + xyz[2];
    [xyz[0] / sum, xyz[1] / sum]
}
