//! Time and rates of a run.

use std::time::{Duration, Instant};

use crate::Position;

/// Time and samples, earlier runs of the job included.
pub(super) struct Clock {
    start: Instant,
    before: Duration,
    pub samples_before: u64,
    round_start: (Instant, u64),
    round_rate: f64,
    pub reported: Instant,
}

impl Clock {
    pub fn start(position: &Position) -> Self {
        let now = Instant::now();
        Self {
            start: now,
            before: Duration::from_millis(position.millis),
            samples_before: position.samples,
            round_start: (now, position.samples),
            round_rate: f64::INFINITY,
            reported: now,
        }
    }

    pub fn run(&self) -> Duration {
        self.start.elapsed()
    }

    pub fn elapsed(&self) -> Duration {
        self.before + self.run()
    }

    pub fn stamp(&self, position: &mut Position) {
        position.millis = self.elapsed().as_millis() as u64;
    }

    /// Samples per second of this run.
    pub fn run_rate(&self, position: &Position) -> f64 {
        (position.samples - self.samples_before) as f64 / self.run().as_secs_f64().max(1e-9)
    }

    pub fn end_round(&mut self, position: &Position) {
        let (start, samples) = self.round_start;
        self.round_rate = (position.samples - samples) as f64 / start.elapsed().as_secs_f64().max(1e-9);
        self.round_start = (Instant::now(), position.samples);
    }

    /// Samples per second of the last round; infinite before there was one.
    pub fn rate(&self) -> f64 {
        self.round_rate
    }
}
