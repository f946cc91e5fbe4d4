//! The sRGB transfer function, IEC 61966-2-1:1999.

use tyndall_base::math::f64::pow;

/// Linear value to display value; odd in its argument, so that values below zero survive a round trip.
pub fn srgb_encode(linear: f64) -> f64 {
    let v = linear.abs();
    let encoded = if v <= 0.0031308 { 12.92 * v } else { 1.055 * pow(v, 1.0 / 2.4) - 0.055 };
    encoded.copysign(linear)
}

/// Display value to linear value.
pub fn srgb_decode(encoded: f64) -> f64 {
    let v = encoded.abs();
    let linear = if v <= 0.04045 { v / 12.92 } else { pow((v + 0.055) / 1.055, 2.4) };
    linear.copysign(encoded)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn encode_and_decode_are_inverse() {
        for i in -100..=300 {
            let v = 0.01 * f64::from(i);
            assert!((srgb_decode(srgb_encode(v)) - v).abs() < 1e-6, "{v}");
        }
        assert!(srgb_encode(0.0) == 0.0 && (srgb_encode(1.0) - 1.0).abs() < 1e-15);
        assert!((srgb_encode(0.18) - 0.461_356).abs() < 1e-6);
    }
}
