//! How often the intervals of a case hold its truth.

use super::scenes::Case;
use std::sync::Arc;
use tyndall::{Plan, RunOptions, render};
use tyndall_engine::{Outcome, Silent, Target};
use tyndall_film::ErrorMode;

/// How errors are found, and when the run ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mode {
    Conservative,
    Replicated,
    /// `--until` with this relative error.
    Until(f64),
}

impl Mode {
    pub fn name(self) -> String {
        match self {
            Self::Conservative => "conservative".into(),
            Self::Replicated => "replicated".into(),
            Self::Until(rel) => format!("until rel={}%", 100.0 * rel),
        }
    }

    pub fn errors(self) -> ErrorMode {
        if self == Self::Conservative { ErrorMode::Conservative } else { ErrorMode::REPLICATED }
    }

    pub fn target(self) -> Option<Target> {
        if let Self::Until(rel) = self { Some(Target::luminance(rel)) } else { None }
    }
}

/// What came of it.
#[derive(Clone, Debug, Default)]
pub struct Measured {
    pub intervals: u32,
    /// Share of 95 % intervals that hold the truth.
    pub coverage: f64,
    /// The same of intervals at the confidence that all looks at the errors leave.
    pub spent: f64,
    /// Mean samples per pixel that are in the image.
    pub spp: f64,
    pub flagged: u32,
    pub flagged_held: u32,
}

/// Renders with one seed after the other until there are enough intervals.
pub fn measure(case: &Case, mode: Mode, spp: u32, intervals: u32) -> Measured {
    let mut plan = case.plan(mode, spp);
    let mut m = Measured::default();
    let (mut held, mut spent) = (0, 0);
    for seed in 1.. {
        if m.intervals >= intervals {
            break;
        }
        reseed(&mut plan, seed);
        let outcome = run(&plan);
        let d = outcome.state.film.develop();
        for (p, (x, y)) in d.bounds.pixels().enumerate() {
            let (e, truth) = (d.luminance(x, y), case.truth[p]);
            let error = (f64::from(e.value) - truth).abs();
            // products of f32 along the path round
            let rounding = 1e-6 * truth;
            let holds = |confidence: f64| u32::from(error <= e.half_width(confidence) + rounding);
            held += holds(0.95);
            spent += holds(outcome.confidence.max(0.95));
            m.intervals += 1;
            m.spp += f64::from(d.samples[p]);
            m.flagged += u32::from(d.flagged[p]);
            m.flagged_held += if d.flagged[p] { holds(0.95) } else { 0 };
        }
    }
    let n = f64::from(m.intervals);
    (m.coverage, m.spent, m.spp) = (f64::from(held) / n, f64::from(spent) / n, m.spp / n);
    m
}

/// The same plan with other random numbers.
pub fn reseed(plan: &mut Plan, seed: u64) {
    plan.pass.seed = seed;
    Arc::make_mut(&mut plan.job.film).seed = seed;
}

pub fn run(plan: &Plan) -> Outcome {
    let outcome = render(plan, &RunOptions::default(), &mut Silent).unwrap_or_else(|e| panic!("{e}"));
    assert!(outcome.state.film.diagnostics().is_clean());
    outcome
}
