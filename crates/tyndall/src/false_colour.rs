//! A colour map for luminance: lightness rises evenly from dark to bright while the hue turns once around.
//!
//! The map is a helix in CIE L*a*b* (D65): `L* = 10 + 85 t`, hue `h = 300 deg - 300 deg t` (violet, blue, green, yellow,
//! red-white), chroma `C* = 60 sin(pi t)^0.5` reduced until the colour lies in sRGB. Equal ratios of luminance are equal
//! steps of lightness, so the map also reads in grey.

use tyndall_base::math::f64 as math;
use tyndall_spectral::{ColourSpace, SpaceName};

/// Linear sRGB of a luminance on a logarithmic scale from `low` to `high`; black below, white above.
pub fn of(luminance: f64, low: f64, high: f64) -> [f64; 3] {
    if !luminance.is_finite() {
        return [1.0, 0.0, 1.0];
    }
    if luminance <= 0.0 || luminance < low {
        return [0.0; 3];
    }
    if luminance > high {
        return [1.0; 3];
    }
    map(math::ln(luminance / low) / math::ln(high / low))
}

/// The map at `t` from 0 to 1, in linear sRGB.
pub fn map(t: f64) -> [f64; 3] {
    let t = t.clamp(0.0, 1.0);
    let lightness = 10.0 + 85.0 * t;
    let hue = (300.0 - 300.0 * t) * (std::f64::consts::PI / 180.0);
    let mut chroma = 60.0 * math::sin(std::f64::consts::PI * t).max(0.0).sqrt();
    loop {
        let rgb = rgb_from_lab([lightness, chroma * math::cos(hue), chroma * math::sin(hue)]);
        let inside = rgb.iter().all(|v| (0.0..=1.0).contains(v));
        if inside || chroma < 0.5 {
            return rgb.map(|v| v.clamp(0.0, 1.0));
        }
        chroma *= 0.96;
    }
}

/// CIE 1976 L*a*b* to linear sRGB (CIE 15:2004, 8.2.1).
fn rgb_from_lab([l, a, b]: [f64; 3]) -> [f64; 3] {
    let space = ColourSpace::get(SpaceName::Srgb);
    let fy = (l + 16.0) / 116.0;
    let inverse = |f: f64| {
        let cube = f * f * f;
        if cube > 216.0 / 24389.0 { cube } else { (116.0 * f - 16.0) * 27.0 / 24389.0 }
    };
    let f = [fy + a / 500.0, fy, fy - b / 200.0];
    let xyz: [f64; 3] = std::array::from_fn(|i| space.white[i] * inverse(f[i]));
    space.rgb_from_xyz.apply(xyz)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_spectral::colour::lab;

    #[test]
    fn lightness_rises_evenly_and_colours_differ() {
        let space = ColourSpace::get(SpaceName::Srgb);
        let labs: Vec<[f64; 3]> =
            (0..=20).map(|i| lab(space.xyz_from_rgb.apply(map(f64::from(i) / 20.0)), space.white)).collect();
        for pair in labs.windows(2) {
            assert!((pair[1][0] - pair[0][0] - 4.25).abs() < 0.2, "{pair:?}");
        }
        let hue = |c: &[f64; 3]| c[2].atan2(c[1]).to_degrees().rem_euclid(360.0);
        assert!(hue(&labs[2]) > 240.0 && (90.0..200.0).contains(&hue(&labs[11])), "blue to green");
    }

    #[test]
    fn ends_of_the_scale() {
        assert_eq!(of(0.05, 0.1, 100.0), [0.0; 3]);
        assert_eq!(of(101.0, 0.1, 100.0), [1.0; 3]);
        assert_eq!(of(f64::NAN, 0.1, 100.0), [1.0, 0.0, 1.0]);
        assert_eq!(of(10f64.sqrt(), 0.1, 100.0), map(0.5));
    }
}
