//! The CIE 1931 2 degree standard observer.
//!
//! `X = integral of xbar(lambda) L(lambda)`, likewise Y and Z, in the unit of `L` times nm; 683 lm/W times Y is the
//! luminance when `L` is in W m^-2 sr^-1 nm^-1. Source: CIE 018:2019, 1 nm, 360 to 830 nm; zero outside.

use std::sync::OnceLock;

use crate::curve::Curve;
use crate::range::{LambdaRange, Outside};
use crate::table::Table;

/// The integral of ybar that pbrt-v4 divides by \[nm\].
pub const CIE_Y_INTEGRAL: f32 = 106.856895;
/// Luminous efficacy at the maximum of ybar \[lm/W\].
pub const LUMENS_PER_WATT: f32 = 683.0;

/// xbar, ybar, zbar as 1 nm tables.
pub fn matching_functions() -> &'static [Curve; 3] {
    static CURVES: OnceLock<[Curve; 3]> = OnceLock::new();
    CURVES.get_or_init(|| {
        let table = Table::parse(include_str!("../data/cie_1931_2deg_1nm.csv"));
        ["xbar", "ybar", "zbar"].map(|name| {
            let values = table.column(name).expect("the table has xbar, ybar and zbar");
            Curve::dense(table.lambda()[0] as u32, values, Outside::Zero)
                .expect("the table is 1 nm and finite")
        })
    })
}

/// xbar.
pub fn x_bar() -> &'static Curve {
    &matching_functions()[0]
}

/// ybar: the luminous efficiency function.
pub fn y_bar() -> &'static Curve {
    &matching_functions()[1]
}

/// zbar.
pub fn z_bar() -> &'static Curve {
    &matching_functions()[2]
}

/// X, Y, Z of `curve`: sums over whole nanometres from 360 to 830, as the CIE recommends and as pbrt-v4 does.
pub fn xyz(curve: &Curve) -> [f64; 3] {
    xyz_over(curve, LambdaRange::VISIBLE)
}

/// X, Y, Z of `curve`: sums over the whole nanometres in `range`.
pub fn xyz_over(curve: &Curve, range: LambdaRange) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for nm in (360u16..=830).map(f32::from).filter(|&nm| range.contains(nm)) {
        let value = f64::from(curve.eval(nm));
        for (sum, response) in sums.iter_mut().zip(matching_functions()) {
            *sum += value * f64::from(response.eval(nm));
        }
    }
    sums
}

/// `integral of ybar curve` \[curve's unit times nm\].
///
/// pbrt-v4 multiplies the spectrum of every light by the inverse of this number (of the *illuminant* alone for an RGB
/// light, whose RGB factor is left out of the normalisation) before it applies its scale.
pub fn y_integral(curve: &Curve) -> f64 {
    xyz(curve)[1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integrals_of_the_observer() {
        let sums = xyz(&Curve::ONE);
        for (sum, expected) in sums.iter().zip([106.86547, 106.85692, 106.89225]) {
            assert!((sum - expected).abs() < 2e-5, "{sum} {expected}");
        }
        let inner = xyz_over(&Curve::ONE, LambdaRange { min: 380.0, max: 780.0 });
        for (sum, expected) in inner.iter().zip([106.85509, 106.85643, 106.84608]) {
            assert!((sum - expected).abs() < 2e-5, "{sum} {expected}");
        }
        assert!((f64::from(CIE_Y_INTEGRAL) - sums[1]).abs() < 3e-5);
    }
}
