//! Film channels: what a sample's expectation is, for continua, lines and bands.
#![allow(clippy::unwrap_used)] // a failure here is a failed test

use tyndall_film::{Channels, Sensor};
use tyndall_spectral::wavelengths::CONTINUUM;
use tyndall_spectral::{Spectrum, Wavelengths, cie};
use tyndall_testkit::{Rng, Welford};

const RANGE: [f32; 2] = [360.0, 830.0];
const SRGB: [[f64; 3]; 3] = [
    [3.2404542, -1.5371385, -0.4985314],
    [-0.969266, 1.8760108, 0.041556],
    [0.0556434, -0.2040259, 1.0572252],
];

/// A chromatic radiance, so that no error in the treatment of wavelengths cancels.
fn radiance(lambda: f32) -> f32 {
    0.2 + 3.0 * ((lambda - 360.0) / 470.0) * ((lambda - 360.0) / 470.0)
}

fn hero<const N: usize>(u: f32) -> Wavelengths<N> {
    let width = RANGE[1] - RANGE[0];
    let at = |k: usize| (u + k as f32 / N as f32).fract();
    Wavelengths {
        lambda: std::array::from_fn(|k| RANGE[0] + width * at(k)),
        pdf: [1.0 / width; N],
        line: [CONTINUUM; N],
    }
}

fn means<const N: usize>(channels: &Channels, n: usize) -> Vec<Welford> {
    let mut rng = Rng::new(11);
    let mut stats = vec![Welford::default(); channels.len()];
    let mut sample = vec![0.0; channels.len()];
    for _ in 0..n {
        let w = hero::<N>(rng.f32());
        channels.respond(&Spectrum::from_fn(|k| radiance(w.lambda[k])), &w, &mut sample);
        stats.iter_mut().zip(&sample).for_each(|(s, &v)| s.add(f64::from(v)));
    }
    stats
}

fn integral(f: impl Fn(f64) -> f64, a: f32, b: f32) -> f64 {
    let n = 20_000;
    let h = f64::from(b - a) / n as f64;
    (0..n).map(|i| f(f64::from(a) + (i as f64 + 0.5) * h) * h).sum()
}

fn xyz_of_radiance() -> [f64; 3] {
    let curves = cie::matching_functions();
    [0, 1, 2].map(|c| {
        integral(|l| f64::from(radiance(l as f32)) * f64::from(curves[c].eval(l as f32)), RANGE[0], RANGE[1])
    })
}

#[test]
fn xyz_is_the_integral_with_the_matching_functions() {
    let expected = xyz_of_radiance();
    for stats in
        [means::<1>(&Channels::xyz().unwrap(), 100_000), means::<8>(&Channels::xyz().unwrap(), 20_000)]
    {
        for c in 0..3 {
            stats[c].z_test(expected[c]).assert_ok("XYZ", 6);
        }
    }
}

#[test]
fn rgb_is_the_matrix_times_xyz_and_the_imaging_ratio() {
    let channels = Channels::rgb(&Sensor::cie1931(Sensor::imaging_ratio(0.5, 400.0)), &SRGB).unwrap();
    let xyz = xyz_of_radiance();
    let stats = means::<8>(&channels, 20_000);
    let expected = SRGB.map(|row| 2.0 * (0..3).map(|j| row[j] * xyz[j]).sum::<f64>());
    for c in 0..3 {
        stats[c].z_test(expected[c]).assert_ok("RGB", 3);
    }
    let y: f64 = channels.luminance().iter().zip(expected).map(|(&w, v)| f64::from(w) * v).sum();
    assert!((y / (2.0 * xyz[1]) - 1.0).abs() < 1e-5);
}

#[test]
fn a_band_holds_the_mean_radiance_per_nm() {
    let edges = [380.0, 400.5, 430.0, 500.0, 620.0, 780.0];
    let channels = Channels::xyz().unwrap().with_bands(&edges).unwrap();
    assert_eq!(channels.group("u").channels[3..5], ["380-400.5nm", "400.5-430nm"]);
    let stats = means::<4>(&channels, 100_000);
    for (b, e) in edges.windows(2).enumerate() {
        let mean = integral(|l| f64::from(radiance(l as f32)), e[0], e[1]) / f64::from(e[1] - e[0]);
        stats[3 + b].z_test(mean).assert_ok("band", 5);
    }
}

/// A line of power 3 drawn with probability 1/4 beside the continuum's slots.
#[test]
fn a_line_counts_its_power_over_the_width() {
    let channels = Channels::bands(&[500.0, 520.0, 560.0]).unwrap();
    let mut w = hero::<4>(0.1);
    w.lambda[2] = 546.1;
    w.pdf[2] = 0.25;
    w.line[2] = 0;
    let mut out = [0.0; 2];
    channels.respond(&Spectrum([0.0, 0.0, 3.0, 0.0]), &w, &mut out);
    assert!((out[1] - 3.0 / 0.25 / 4.0 / 40.0).abs() < 1e-6 && out[0] == 0.0);
}

#[test]
fn terminated_and_outside_wavelengths_weigh_nothing() {
    let channels = Channels::xyz().unwrap().with_bands(&[400.0, 700.0]).unwrap();
    let mut w = hero::<4>(0.3);
    w.pdf = [0.0, 0.01, 0.0, 0.0];
    w.lambda[1] = 900.0;
    let mut out = [1.0; 4];
    channels.respond(&Spectrum([f32::MAX, 1.0, 1.0, 1.0]), &w, &mut out);
    assert_eq!(out, [0.0; 4]);
}

/// Any edges: each wavelength falls into the band that a linear search finds.
#[test]
fn band_search_agrees_with_the_definition() {
    let edges = [380.25, 380.5, 380.75, 381.5, 400.0, 400.125, 555.5, 780.0];
    let channels = Channels::bands(&edges).unwrap();
    let mut rng = Rng::new(5);
    for i in 0..20_000 {
        let lambda = if i < 8 { edges[i] } else { 375.0 + 410.0 * rng.f32() };
        let w = Wavelengths { lambda: [lambda], pdf: [1.0], line: [CONTINUUM] };
        let mut out = [0.0; 7];
        channels.respond(&Spectrum([1.0]), &w, &mut out);
        let inside =
            |b: usize| lambda >= edges[b] && (lambda < edges[b + 1] || (b == 6 && lambda == edges[7]));
        for b in 0..7 {
            let expected = if inside(b) { 1.0 / (edges[b + 1] - edges[b]) } else { 0.0 };
            assert_eq!(out[b], expected, "{lambda} nm, band {b}");
        }
    }
}

#[test]
fn bad_tables_are_refused() {
    assert!(Channels::bands(&[500.0]).is_err());
    assert!(Channels::bands(&[500.0, 500.0]).is_err());
    assert!(Channels::bands(&[500.0, f32::NAN, 600.0]).is_err());
    assert!(Channels::bands(&[1.0, 1e30]).is_err());
    assert!(Channels::rgb(&Sensor::cie1931(0.0), &SRGB).is_err());
    assert!(Channels::rgb(&Sensor::cie1931(1.0), &[[1.0; 3]; 3]).is_err());
}
