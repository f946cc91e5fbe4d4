//! Intervals hold the truth as often as they say: at least 2,000 pixel-seed intervals a case, flagged pixels included.
//!
//! `cargo test -p tyndall-engine --test coverage -- --nocapture` prints the table.
#![allow(clippy::unwrap_used)] // a failure here is a failed test

mod common;

use common::{Hashed, Shape, run, spec};
use tyndall_engine::{Job, Target};
use tyndall_film::ErrorMode;

/// Pixels per side; with two seeds 2,048 intervals.
const SIDE: u32 = 32;

#[derive(Default)]
struct Coverage {
    /// Of 95 % intervals.
    plain: f64,
    /// Of intervals at the confidence that is left after all looks.
    spent: f64,
    /// What 95 % intervals hold when those of no width around an exact 0 always hold.
    expected: f64,
    flagged: u64,
    flagged_held: u64,
    spp: f64,
    met: bool,
}

fn measure(shape: Shape, mode: ErrorMode, spp: u32, target: Option<f64>) -> Coverage {
    let total = f64::from(2 * SIDE * SIDE);
    let mut c = Coverage { expected: 0.95, met: true, ..Coverage::default() };
    for seed in [101, 202] {
        let job = Job { target: target.map(Target::luminance), ..Job::new(spec(SIDE, SIDE, mode), spp) };
        let pass = Hashed::new(seed, shape);
        let outcome = run(&job, &pass, 2).unwrap();
        let d = outcome.state.film.develop();
        for (x, y) in d.bounds.pixels() {
            let estimate = d.luminance(x, y);
            let error = (f64::from(estimate.value) - pass.mean(x, y)).abs();
            let held = error <= estimate.half_width(0.95);
            c.plain += f64::from(u8::from(held)) / total;
            c.spent += f64::from(u8::from(error <= estimate.half_width(outcome.confidence))) / total;
            c.expected += 0.05 * f64::from(u8::from(pass.mean(x, y) == 0.0)) / total;
            if d.flagged[d.bounds.index(x, y)] {
                c.flagged += 1;
                c.flagged_held += u64::from(held);
            }
        }
        c.spp += outcome.samples as f64 / total;
        c.met &= outcome.met.unwrap_or(true);
    }
    c
}

fn check(name: &str, shape: Shape, mode: ErrorMode, spp: u32, target: Option<f64>) {
    let c = measure(shape, mode, spp, target);
    println!(
        "{name:12} {:11} {:6.0} spp  95 % intervals hold {:5.2} %, with alpha spent {:5.2} %  flagged {:3}, hold {:3}",
        format!("{shape:?}"),
        c.spp,
        100.0 * c.plain,
        100.0 * c.spent,
        c.flagged,
        c.flagged_held,
    );
    assert!(c.met, "{name} {shape:?}: the target was not met");
    // 2 % are four standard errors of a coverage from 2,048 intervals
    assert!((c.plain - c.expected).abs() <= 0.02, "{name} {shape:?}: coverage {}", c.plain);
    assert!(c.spent >= c.plain);
}

#[test]
fn intervals_of_a_fixed_count() {
    for mode in [ErrorMode::Conservative, ErrorMode::REPLICATED] {
        for shape in [Shape::Smooth, Shape::Exponential] {
            check(mode.name(), shape, mode, 256, None);
        }
        // skewness 6 and 5: the mean of 4096 samples is near normal
        for shape in [Shape::Lognormal, Shape::Rare] {
            check(mode.name(), shape, mode, 4096, None);
        }
    }
}

#[test]
fn intervals_of_adaptive_counts() {
    for shape in [Shape::Smooth, Shape::Exponential, Shape::Lognormal, Shape::Rare] {
        check("until rel=5%", shape, ErrorMode::REPLICATED, 200_000, Some(0.05));
    }
}

/// Over an image with black pixels, whose intervals of no width hold the truth.
#[test]
fn intervals_over_a_mixed_image() {
    check("until rel=3%", Shape::Mixed, ErrorMode::REPLICATED, 200_000, Some(0.03));
}

/// The same number of samples, spread evenly, does not meet the target that adaptive counts meet.
#[test]
fn adaptive_counts_go_where_the_errors_are() {
    let job = Job {
        target: Some(Target::luminance(0.03)),
        ..Job::new(spec(SIDE, SIDE, ErrorMode::REPLICATED), 200_000)
    };
    let pass = Hashed::new(1, Shape::Mixed);
    let outcome = run(&job, &pass, 2).unwrap();
    assert_eq!(outcome.met, Some(true));
    let d = outcome.state.film.develop();
    // inside the 4 x 4 blocks, where no neighbour of another kind takes part in the planning
    let mean_count = |kind: u32| {
        let inner = |v: u32| (1..3).contains(&(v % 4));
        let of_kind = |&(x, y): &(u32, u32)| {
            inner(x) && inner(y) && (x / 4 + 2 * (y / 4)) % 3 == kind && pass.mean(x, y) >= 1.0
        };
        let count = |(x, y): (u32, u32)| f64::from(d.samples[d.bounds.index(x, y)]);
        let counts: Vec<f64> = d.bounds.pixels().filter(of_kind).map(count).collect();
        counts.iter().sum::<f64>() / counts.len() as f64
    };
    // variances over squared means: 1/3 (uniform) and 1.72 (lognormal)
    let (smooth, heavy) = (mean_count(0), mean_count(2));
    assert!(heavy > 3.0 * smooth, "{heavy} {smooth}");
    let even = (outcome.samples / job.film.bounds.area()) as u32;
    let plain = run(&Job { target: None, spp: even, ..job }, &pass, 2).unwrap().state.film.summary();
    assert!(plain.p95_rel_se_y > 0.03 && d.summary.p95_rel_se_y <= 0.03, "{}", plain.p95_rel_se_y);
}

/// Only the probes count, all of them.
#[test]
fn probes_alone_decide_where_asked() {
    let probes = vec![(4, 4), (20, 9)];
    let target = Target { probes: probes.clone(), ..Target::luminance(0.02) };
    let job = Job { target: Some(target), ..Job::new(spec(SIDE, SIDE, ErrorMode::REPLICATED), 200_000) };
    let outcome = run(&job, &Hashed::new(1, Shape::Exponential), 2).unwrap();
    assert_eq!(outcome.met, Some(true));
    let d = outcome.state.film.develop();
    for (x, y) in d.bounds.pixels() {
        let n = d.samples[d.bounds.index(x, y)];
        assert!(if probes.contains(&(x, y)) { n > 1000 } else { n == 16 }, "({x}, {y}): {n}");
    }
    for (x, y) in probes {
        assert!(d.luminance(x, y).se <= 0.02 * d.luminance(x, y).value);
    }
}

/// A ceiling too low: the run ends, and says that the target was not met.
#[test]
fn a_ceiling_ends_a_hopeless_target() {
    let job =
        Job { target: Some(Target::luminance(0.001)), ..Job::new(spec(8, 8, ErrorMode::REPLICATED), 300) };
    let outcome = run(&job, &Hashed::new(1, Shape::Lognormal), 2).unwrap();
    assert_eq!(outcome.met, Some(false));
    assert!(outcome.state.film.develop().samples.iter().all(|&n| n <= 300 - 64));
}
