//! Probabilities are exact over all uniform numbers, densities pass chi-square, bad weights are refused.

use super::*;
use tyndall_testkit::{Rng, chi2_1d, chi2_2d};

/// How often each entry is drawn over all 2^24 uniform numbers.
fn census(n: usize, sample: impl Fn(f32) -> usize) -> Vec<u32> {
    let mut counts = vec![0; n];
    (0..STEPS).for_each(|i| counts[sample(i as f32 * STEP)] += 1);
    counts
}

fn random_weights(n: usize, seed: u64) -> Vec<f64> {
    let mut rng = Rng::new(seed);
    // eight decades, and every seventh zero
    (0..n).map(|i| if i % 7 == 3 { 0.0 } else { 10_f64.powf(rng.range(-8.0, 0.0)) }).collect()
}

#[test]
fn alias_draws_with_the_probability_it_reports() {
    for n in [1, 2, 3, 5, 64, 1000, 70_000] {
        let weights = random_weights(n, n as u64);
        let alias = Alias::new(&weights).unwrap();
        let counts = census(n, |u| alias.sample(u));
        let sum: f64 = weights.iter().sum();
        for i in 0..n {
            assert_eq!(counts[i] as f32 * STEP, alias.pmf(i), "entry {i} of {n}");
            assert_eq!(counts[i] == 0, weights[i] == 0.0, "entry {i} of {n}");
            // one step for the remainder and up to one more for each entry that was lifted to one step
            let off = f64::from(counts[i]) - weights[i] / sum * f64::from(STEPS);
            assert!(off.abs() <= 2.0 + n as f64 * weights[i] / sum, "entry {i} of {n}: {off} steps off");
        }
    }
}

#[test]
fn remapped_numbers_are_uniform_and_independent_of_the_entry() {
    let alias = Alias::new(&[0.5, 0.2, 0.0, 0.3]).unwrap();
    let draw = |r: &mut Rng| {
        let (entry, u) = alias.sample_remapped(r.f32());
        Some([(entry as f64 + r.f64()) / 4.0, u.into()])
    };
    let pdf = |p: [f64; 2]| 4.0 * f64::from(alias.pmf((p[0] * 4.0) as usize));
    chi2_2d(draw, pdf, [[0.0, 1.0], [0.0, 1.0]], 400_000, 1).assert_ok("remapped", 1);
}

#[test]
fn piecewise_1d_draws_with_the_density_it_reports() {
    let weights = random_weights(300, 2);
    let p = Piecewise1d::new(&weights, 2.0, 5.0).unwrap();
    let bin = |x: f32| (((x - 2.0) / 3.0 * 300.0) as usize).min(299);
    let counts = census(300, |u| bin(p.sample(u).0));
    let expected: Vec<f32> =
        (0..300).map(|i| p.pdf(2.0 + (i as f32 + 0.5) / 100.0) / 100.0 * STEPS as f32).collect();
    for (i, &count) in counts.iter().enumerate() {
        // a point within rounding of an edge may fall to the neighbour: 1e-7 of 3 in a bin of 1e-2
        let near = &expected[i.saturating_sub(1)..(i + 2).min(300)];
        let slack = 1.0 + 1e-4 * near.iter().sum::<f32>();
        assert!((count as f32 - expected[i]).abs() <= slack, "bin {i}: {count} against {}", expected[i]);
    }
    let (x, pdf) = p.sample(0.3);
    assert_eq!(pdf, p.pdf(x));
    assert!((p.invert(x) - 0.3).abs() < 1e-6);
    assert_eq!([p.pdf(1.9), p.pdf(5.1), p.invert(1.0), p.invert(6.0)], [0.0, 0.0, 0.0, 1.0]);
}

#[test]
fn piecewise_1d_passes_chi_square() {
    let p = Piecewise1d::new(&[1.0, 4.0, 0.0, 2.0, 0.5], -1.0, 4.0).unwrap();
    let test =
        chi2_1d(|r| Some(p.sample(r.f32()).0.into()), |x| p.pdf(x as f32).into(), [-1.0, 4.0], 400_000, 3);
    test.assert_ok("Piecewise1d", 1);
}

#[test]
fn piecewise_2d_passes_chi_square() {
    // 8 x 4 bins with an empty row
    let weights: Vec<f32> = (0..32).map(|i| if i / 8 == 2 { 0.0 } else { ((i * 7) % 11) as f32 }).collect();
    let p = Piecewise2d::new(&weights, 8, 4).unwrap();
    let draw = |r: &mut Rng| Some(p.sample(r.f32x2()).0.map(f64::from));
    let pdf = |x: [f64; 2]| f64::from(p.pdf(x.map(|v| v as f32)));
    chi2_2d(draw, pdf, [[0.0, 1.0], [0.0, 1.0]], 400_000, 4).assert_ok("Piecewise2d", 1);
    let (x, pdf) = p.sample([0.7, 0.2]);
    assert_eq!(pdf, p.pdf(x));
    assert_eq!(p.pdf([0.5, 0.6]), 0.0);
    let sum: f32 = weights.iter().sum();
    assert!((p.pdf([3.5 / 8.0, 0.5 / 4.0]) - 32.0 * weights[3] / sum).abs() < 1e-4);
}

#[test]
fn bad_weights_are_refused() {
    use DistributionError as E;
    assert_eq!(Alias::new(&[]).unwrap_err(), E::Empty);
    assert_eq!(Alias::new(&[1.0, -2.0]).unwrap_err(), E::Weight { index: 1, value: -2.0 });
    assert!(matches!(Alias::new(&[f64::NAN]).unwrap_err(), E::Weight { index: 0, .. }));
    assert!(matches!(Alias::new(&[f64::INFINITY]).unwrap_err(), E::Weight { index: 0, .. }));
    assert_eq!(Alias::new(&[0.0; 3]).unwrap_err(), E::AllZero { count: 3 });
    assert_eq!(Alias::new(&vec![1.0; MAX_ENTRIES + 1]).unwrap_err(), E::TooMany { count: MAX_ENTRIES + 1 });
    assert_eq!(Piecewise1d::new(&[1.0], 2.0, 2.0).unwrap_err(), E::Interval { a: 2.0, b: 2.0 });
    assert_eq!(Piecewise2d::new(&[1.0; 5], 2, 3).unwrap_err(), E::Shape { width: 2, height: 3, count: 5 });
    assert_eq!(
        Piecewise2d::new(&[1.0, 1.0, 1.0, -1.0], 2, 2).unwrap_err(),
        E::Weight { index: 3, value: -1.0 }
    );
    assert_eq!(Piecewise2d::new(&[0.0; 4], 2, 2).unwrap_err(), E::AllZero { count: 4 });
    assert_eq!(
        E::Weight { index: 3, value: -1.0 }.to_string(),
        "weight 3: expected a finite number >= 0, got -1"
    );
}

#[test]
fn huge_and_tiny_weights_do_not_overflow() {
    let alias = Alias::new(&[f64::MAX, f64::MAX, f64::MIN_POSITIVE]).unwrap();
    assert!((alias.pmf(0) - 0.5).abs() < 1e-6 && alias.pmf(2) == STEP);
}
