//! Standard errors: against the textbook formulas and against the truth.
#![allow(clippy::unwrap_used)] // a failure here is a failed test

use std::sync::Arc;

use tyndall_film::{ErrorMode, Film, FilmSpec, Patch, Weights, WorkUnit};
use tyndall_testkit::{Rng, Welford};

fn spec(mode: ErrorMode, weights: Weights) -> Arc<FilmSpec> {
    let mut spec = FilmSpec::xyz([1, 1], mode);
    spec.weights = weights;
    // Y from all three channels: its error needs their covariance
    spec.luminance = vec![0.2, 0.5, 0.3];
    Arc::new(spec)
}

fn film(spec: &Arc<FilmSpec>, samples: &[(f32, [f32; 3])]) -> Film {
    let unit = WorkUnit { window: spec.bounds, samples: 0..samples.len() as u32, round: 0 };
    let mut patch = Patch::new(spec, unit);
    for (i, (w, v)) in samples.iter().enumerate() {
        patch.add_sample(0, 0, i as u32, *w, v);
    }
    let mut film = Film::new(spec).unwrap();
    film.merge(&patch).unwrap();
    film
}

fn luma(v: &[f32; 3]) -> f64 {
    0.2f32 as f64 * v[0] as f64 + 0.5 * v[1] as f64 + 0.3f32 as f64 * v[2] as f64
}

fn draw(n: usize) -> Vec<(f32, [f32; 3])> {
    let mut rng = Rng::new(4);
    (0..n)
        .map(|_| {
            let common = rng.f32();
            (1.0, [common + rng.f32(), 2.0 * common, 3.0 - common * rng.f32()])
        })
        .collect()
}

fn close(got: f32, expected: f64) {
    assert!((f64::from(got) / expected - 1.0).abs() < 1e-5, "{got} {expected}");
}

#[test]
fn conservative_errors_are_the_plain_variance() {
    let samples = draw(37);
    let d = film(&spec(ErrorMode::Conservative, Weights::Unit), &samples).develop();
    for c in 0..3 {
        let mut w = Welford::default();
        samples.iter().for_each(|s| w.add(f64::from(s.1[c])));
        close(d.mean[c][0], w.mean());
        close(d.error[c][0], w.se());
    }
    let mut w = Welford::default();
    samples.iter().for_each(|s| w.add(luma(&s.1)));
    close(d.y[0], w.mean());
    close(d.y_error[0], w.se());
    assert_eq!(d.dof[0], 36);
}

#[test]
fn replicated_errors_are_the_spread_of_the_replicates() {
    let samples = draw(64);
    let d = film(&spec(ErrorMode::REPLICATED, Weights::Unit), &samples).develop();
    let mut y = Welford::default();
    let mut x = Welford::default();
    for b in 0..8 {
        let members: Vec<_> = samples.iter().skip(b).step_by(8).collect();
        y.add(members.iter().map(|s| luma(&s.1)).sum::<f64>() / 8.0);
        x.add(members.iter().map(|s| f64::from(s.1[0])).sum::<f64>() / 8.0);
    }
    close(d.y[0], y.mean());
    close(d.y_error[0], y.se());
    close(d.error[0][0], x.se());
    assert_eq!((d.dof[0], d.pooled[0]), (7, false));
}

/// The error of a small signal on a large one survives: sums are exact, only the last steps are rounded.
#[test]
fn small_errors_of_large_values_are_resolved() {
    for mode in [ErrorMode::Conservative, ErrorMode::REPLICATED] {
        let noise = |i: usize| (i * 7 % 16) as f32 * 0.0625;
        let samples: Vec<_> = (0..64).map(|i| (1.0, [10_000.0 + noise(i); 3])).collect();
        let shifted: Vec<_> = (0..64).map(|i| (1.0, [noise(i); 3])).collect();
        let at = |s: &[_]| film(&spec(mode, Weights::Unit), s).develop().error[0][0];
        assert!((at(&samples) / at(&shifted) - 1.0).abs() < 1e-4, "{mode:?}");
    }
}

/// Constant radiance under a filter with negative lobes has no error: the ratio cancels the weights.
#[test]
fn the_ratio_of_a_constant_is_exact() {
    for mode in [ErrorMode::Conservative, ErrorMode::REPLICATED] {
        let samples: Vec<_> =
            (0..64).map(|i| (if i % 9 == 0 { -1.0 } else { 1.0 }, [2.0, 4.0, 8.0])).collect();
        let d = film(&spec(mode, Weights::Signed), &samples).develop();
        assert_eq!([d.mean[0][0], d.mean[1][0], d.mean[2][0]], [2.0, 4.0, 8.0]);
        assert!(d.error[0][0] < 1e-6 && d.y_error[0] < 1e-6, "{mode:?} {}", d.error[0][0]);
    }
}

/// The variance of the ratio estimator over many pixels agrees with the mean of its estimates.
#[test]
fn signed_errors_match_the_spread_over_pixels() {
    for mode in [ErrorMode::Conservative, ErrorMode::REPLICATED] {
        let spec = spec(mode, Weights::Signed);
        let mut rng = Rng::new(21);
        let (mut value, mut variance) = (Welford::default(), Welford::default());
        for _ in 0..4000 {
            let samples: Vec<_> = (0..128)
                .map(|_| {
                    let w = if rng.below(10) == 0 { -1.0 } else { 1.0 };
                    (w, [if w < 0.0 { 3.0 } else { 1.0 } + rng.f32(); 3])
                })
                .collect();
            let d = film(&spec, &samples).develop();
            value.add(f64::from(d.mean[0][0]));
            variance.add(f64::from(d.error[0][0]).powi(2));
        }
        // relative sd of a variance from 4000 values: sqrt(2/4000) = 2.2 %; the linearisation is good to O(1/n)
        let ratio = variance.mean() / value.variance();
        assert!((ratio - 1.0).abs() < 4.0 * 0.0224 + 0.02, "{mode:?} {ratio}");
    }
}

#[test]
fn one_dominating_sample_is_flagged() {
    for mode in [ErrorMode::Conservative, ErrorMode::REPLICATED] {
        let mut samples = draw(256);
        assert!(!film(&spec(mode, Weights::Unit), &samples).develop().flagged[0], "{mode:?}");
        samples[100].1 = [900.0; 3];
        let d = film(&spec(mode, Weights::Unit), &samples).develop();
        assert!(d.flagged[0], "{mode:?}");
        assert_eq!((d.largest[0].1, d.summary.flagged), (100, 1));
    }
}

#[test]
fn unknown_errors_are_infinite_not_zero() {
    let d = film(&spec(ErrorMode::Conservative, Weights::Unit), &draw(1)).develop();
    assert!(d.y_error[0].is_infinite() && d.summary.unknown == 1);
    let d = film(&spec(ErrorMode::REPLICATED, Weights::Unit), &draw(1)).develop();
    assert!(d.error[2][0].is_infinite() && d.luminance(0, 0).half_width(0.95).is_infinite());
    let d = Film::new(&spec(ErrorMode::Conservative, Weights::Unit)).unwrap().develop();
    assert!(d.mean[0][0] == 0.0 && d.error[0][0].is_infinite());
}

/// Four samples a pixel: one replicate each. The tile's pooled error is right on average, and marked.
#[test]
fn sparse_replicates_pool_their_tile() {
    let spec = Arc::new(FilmSpec::xyz([16, 16], ErrorMode::REPLICATED));
    let mut rng = Rng::new(8);
    let unit = WorkUnit { window: spec.bounds, samples: 0..4, round: 0 };
    let mut patch = Patch::new(&spec, unit);
    for (x, y) in spec.bounds.pixels() {
        (0..4).for_each(|i| patch.add_sample(x, y, i, 1.0, &[rng.f32(); 3]));
    }
    let mut film = Film::new(&spec).unwrap();
    film.merge(&patch).unwrap();
    let d = film.develop();
    let expected = (1.0f64 / 12.0 / 4.0).sqrt();
    assert!((f64::from(d.y_error[17]) / expected - 1.0).abs() < 0.06, "{}", d.y_error[17]);
    assert_eq!((d.summary.pooled, d.dof[0]), (256, 3 * 256));
}

#[test]
fn pooled_covariances_agree_with_the_errors_and_see_what_channels_share() {
    let samples = draw(64);
    let film = film(&spec(ErrorMode::REPLICATED, Weights::Unit), &samples);
    let (d, p) = (film.develop(), film.pooled());
    assert_eq!(p.dof, 7);
    for c in 0..3 {
        close(d.mean[c][0], p.mean[c]);
        close(d.error[c][0], p.se(c));
    }
    let replicate = |b: usize, c: usize| -> f64 {
        let all: Vec<f64> = samples.iter().skip(b).step_by(8).map(|s| f64::from(s.1[c])).collect();
        all.iter().sum::<f64>() / all.len() as f64
    };
    let by_hand = |a: usize, c: usize| -> f64 {
        (0..8).map(|b| (replicate(b, a) - p.mean[a]) * (replicate(b, c) - p.mean[c])).sum::<f64>() / 56.0
    };
    for (a, c) in [(0, 1), (0, 2), (1, 2)] {
        assert!((p.covariance(a, c) / by_hand(a, c) - 1.0).abs() < 1e-5);
        assert!((p.covariance(a, c) / p.covariance(c, a) - 1.0).abs() < 1e-12);
    }
    let unknown = self::film(&spec(ErrorMode::Conservative, Weights::Unit), &samples).pooled();
    assert!(unknown.covariance(0, 1).is_infinite());
}
