//! Watching a job.

use std::time::Duration;

use tyndall_film::{ErrorSummary, Film, Patch};

use crate::Stage;

/// How far a job is.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// Stage of the job.
    pub stage: Stage,
    /// Part of the work that is done, 0 to 1; against the ceiling while no target fixes the end.
    pub fraction: f64,
    /// Time spent, earlier runs of the same job included.
    pub elapsed: Duration,
    /// Time left by the rate so far; `None` before there is one.
    pub remaining: Option<Duration>,
    /// Mean samples per pixel taken so far, those of a pilot included.
    pub spp: f64,
    /// Samples per second of this run.
    pub samples_per_second: f64,
    /// Errors at the end of the last round.
    pub errors: Option<ErrorSummary>,
    /// Samples per pixel at which the target would be met, by 1/sqrt(N) from the errors so far.
    pub projected_spp: Option<f64>,
}

/// Watches a job: a terminal, a log, a viewer. Called on the merging thread; whatever takes long belongs elsewhere.
pub trait Sink {
    /// Some patches later, at most ten times a second, and at every end of a round.
    fn progress(&mut self, _progress: &Progress) {}

    /// A patch arrived.
    fn patch(&mut self, _patch: &Patch) {}

    /// A round is complete.
    fn round(&mut self, _film: &Film) {}

    /// Something went wrong that does not stop the job.
    fn warning(&mut self, _text: &str) {}
}

/// Watches nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Sink for Silent {}
