//! Intervals of rendered pixels hold the known answer as often as they say: over all pixels, flagged ones included.
//!
//! `cargo test --release -p tyndall --test coverage -- --ignored --nocapture` prints the whole table.

#[path = "../common/mod.rs"]
mod common;
mod measure;
mod scenes;

use measure::{Measured, Mode, measure};
use scenes::{Case, cases};

/// At least this many pixel-seed intervals a row.
const INTERVALS: u32 = 2048;
/// Four standard errors of a coverage of 95 % from that many intervals.
const TOLERANCE: f64 = 0.02;

fn row(case: &Case, mode: Mode, spp: u32) -> Measured {
    let m = measure(case, mode, spp, INTERVALS);
    println!(
        "{:28} {:14} {:6.0} {:6} {:8.2} % {:8.2} % {:8} {:8}",
        case.name,
        mode.name(),
        m.spp,
        m.intervals,
        100.0 * m.coverage,
        100.0 * m.spent,
        m.flagged,
        m.flagged_held
    );
    m
}

fn heading() {
    println!(
        "{:28} {:14} {:>6} {:>6} {:>10} {:>10} {:>8} {:>8}",
        "scene", "errors", "spp", "pixels", "95 % hold", "spent", "flagged", "of these"
    );
}

fn check(case: &Case, mode: Mode, m: &Measured) {
    let name = format!("{}, {}", case.name, mode.name());
    assert!(m.intervals >= INTERVALS, "{name}");
    match mode {
        // an upper estimate may hold more often, never less
        Mode::Conservative => assert!(m.coverage >= 0.95 - TOLERANCE, "{name}: {}", m.coverage),
        _ => assert!((m.coverage - 0.95).abs() <= TOLERANCE, "{name}: {}", m.coverage),
    }
    assert!(m.spent >= m.coverage, "{name}");
}

/// The cheap cases in closed form; the table has them all. In the built-in scene, whose tails are heavy, intervals from 64
/// samples per pixel hold less often than they say (87 %): the manual tells.
#[test]
fn intervals_hold_what_they_say() {
    heading();
    for case in cases(8, 1).iter().filter(|c| c.name.contains("slab")) {
        for mode in [Mode::Conservative, Mode::Replicated] {
            check(case, mode, &row(case, mode, 64));
        }
    }
}

#[test]
fn intervals_of_adaptive_counts_hold_what_they_say() {
    heading();
    let (case, mode) = (&cases(8, 1)[0], Mode::Until(0.04));
    check(case, mode, &row(case, mode, 4096));
}

#[test]
#[ignore = "minutes; the short version runs always"]
fn table() {
    heading();
    for case in cases(16, 1 << 16) {
        for spp in [16, 64, 256] {
            check(&case, Mode::Conservative, &row(&case, Mode::Conservative, spp));
            check(&case, Mode::Replicated, &row(&case, Mode::Replicated, spp));
        }
        for rel in [0.04, 0.02] {
            check(&case, Mode::Until(rel), &row(&case, Mode::Until(rel), 1 << 14));
        }
    }
}
