//! Spectra have the colours they were made from.

use super::*;
use crate::cie::{CIE_Y_INTEGRAL, xyz};
use crate::range::LambdaRange;

/// RGB of a reflectance under the white of the space, or of a light when `lit` is already a product with it.
fn rgb_of(space: &ColourSpace, lit: &Curve) -> [f64; 3] {
    space.rgb_from_xyz.apply(xyz(lit).map(|v| v / f64::from(CIE_Y_INTEGRAL)))
}

fn error(a: [f64; 3], b: [f32; 3]) -> f64 {
    (0..3).map(|i| (a[i] - f64::from(b[i])).abs()).fold(0.0, f64::max)
}

fn grid(n: usize, low: f32, high: f32) -> impl Iterator<Item = [f32; 3]> {
    let value = move |i: usize| low + (high - low) * i as f32 / (n - 1) as f32;
    (0..n * n * n).map(move |i| [value(i % n), value(i / n % n), value(i / n / n)])
}

#[test]
fn reflectances_come_back_in_srgb() {
    let space = ColourSpace::get(SpaceName::Srgb);
    let (mut worst, mut at) = (0.0, [0.0; 3]);
    for rgb in grid(9, 0.02, 0.98) {
        let curve = albedo(SpaceName::Srgb, rgb).unwrap();
        let [low, high] = curve.bounds(LambdaRange::VISIBLE);
        assert!(low >= 0.0 && high <= 1.0);
        let e = error(rgb_of(space, &curve.times(&space.illuminant)), rgb);
        if e > worst {
            (worst, at) = (e, rgb);
        }
    }
    assert!(worst < 1e-3, "{worst} at {at:?}");
}

#[test]
fn moderate_colours_come_back_in_wide_spaces() {
    // the primaries of ACES are not colours of any surface, so less of its cube is
    for (name, high) in [(SpaceName::DciP3, 0.7), (SpaceName::Rec2020, 0.7), (SpaceName::Aces2065, 0.45)] {
        let space = ColourSpace::get(name);
        let (mut worst, mut at) = (0.0, [0.0; 3]);
        for rgb in grid(6, 0.2, high) {
            let curve = albedo(name, rgb).unwrap();
            let e = error(rgb_of(space, &curve.times(&space.illuminant)), rgb);
            if e > worst {
                (worst, at) = (e, rgb);
            }
        }
        assert!(worst < 1e-3, "{name:?}: {worst} at {at:?}");
    }
}

#[test]
fn lights_and_unbounded_values_keep_their_colour_and_size() {
    for name in SpaceName::ALL {
        let space = ColourSpace::get(name);
        for rgb in [[3.0f32, 2.0, 1.0], [0.01, 0.02, 0.03], [20.0, 20.0, 20.0], [0.5, 0.8, 0.6]] {
            let size = f64::from(rgb[0].max(rgb[2]));
            let light = illuminant(name, rgb).unwrap();
            assert!(error(rgb_of(space, &light), rgb) < 1e-3 * size, "{name:?} {rgb:?}");
        }
    }
    assert_eq!(unbounded(SpaceName::Srgb, [0.0; 3]), Ok(Curve::ZERO));
    assert!((unbounded(SpaceName::Srgb, [3.0; 3]).unwrap().eval(500.0) - 3.0).abs() < 1e-6);
    assert!((albedo(SpaceName::Srgb, [0.18; 3]).unwrap().eval(700.0) - 0.18).abs() < 1e-6);
}

#[test]
fn the_table_follows_the_solution() {
    let space = ColourSpace::get(SpaceName::Srgb);
    let table = RgbTable::get(SpaceName::Srgb);
    let mut worst: f64 = 0.0;
    for rgb in [[0.3, 0.5, 0.7], [0.8, 0.35, 0.4], [0.31, 0.62, 0.33], [0.79, 0.1, 0.12], [0.05, 0.04, 0.045]]
    {
        let curve = Curve::Sigmoid(table.coefficients(rgb));
        worst = worst.max(error(rgb_of(space, &curve.times(&space.illuminant)), rgb));
    }
    assert!(worst < 2e-3, "{worst}");
}

#[test]
fn the_table_reaches_the_corners_of_srgb() {
    let space = ColourSpace::get(SpaceName::Srgb);
    let table = RgbTable::get(SpaceName::Srgb);
    // brightest components between the table's last points, too
    for rgb in [1.0, 0.9999, 0.998, 0.99].into_iter().flat_map(|most| grid(14, 0.0, most)) {
        let curve = Curve::Sigmoid(table.coefficients(rgb));
        let worst = error(rgb_of(space, &curve.times(&space.illuminant)), rgb);
        assert!(worst < 6e-3, "{rgb:?}: {worst}");
    }
}

#[test]
fn coarse_nodes_are_good_enough_for_the_table() {
    let space = ColourSpace::get(SpaceName::Srgb);
    let (fine, coarse) = (Quadrature::new(space, 1), Quadrature::new(space, 5));
    for rgb in [[0.9, 0.1, 0.1], [0.1, 0.8, 0.3], [0.2, 0.2, 0.9], [0.9, 0.85, 0.05]] {
        let c = fine.solve(rgb, fine.start(rgb), Effort::EXACT);
        let (a, b) = (fine.rgb(c), coarse.rgb(c));
        assert!((0..3).all(|k| (a[k] - b[k]).abs() < 5e-4), "{a:?} {b:?}");
    }
}

#[test]
fn impossible_values_are_refused() {
    assert!(albedo(SpaceName::Srgb, [1.01, 0.0, 0.0]).is_err());
    assert!(albedo(SpaceName::Srgb, [f32::NAN, 0.0, 0.0]).is_err());
    assert!(unbounded(SpaceName::Srgb, [-0.1, 0.0, 0.0]).is_err());
    assert!(illuminant(SpaceName::Srgb, [f32::INFINITY, 0.0, 0.0]).is_err());
}
