//! What happens to a patch: it is merged, ticked off, reported, and now and then the state is saved.

use std::collections::HashMap;
use std::ops::{ControlFlow, Range};
use std::time::{Duration, Instant};

use tyndall_film::{ErrorSummary, Film, Guide, Patch, WorkUnit};

use super::Run;
use super::clock::Clock;
use crate::checkpoint::Timer;
use crate::progress::{Progress, Sink};
use crate::{EngineError, Job, Position, Stage, schedule};

/// Least time between two reports of progress within a round.
const REPORT: Duration = Duration::from_millis(100);

/// Receives the patches of a round.
pub(super) struct Delivery<'d> {
    pub run: Run<'d>,
    pub film: &'d mut Film,
    pub guide: &'d Guide,
    pub position: &'d mut Position,
    pub open: &'d mut HashMap<WorkUnit, usize>,
    pub timer: &'d mut Timer,
    pub clock: &'d mut Clock,
    pub sink: &'d mut dyn Sink,
    /// Samples of the job after this round.
    pub left: u64,
    pub round_left: u64,
    pub errors: &'d Option<ErrorSummary>,
    pub projected: Option<f64>,
    pub failure: Option<EngineError>,
}

impl Delivery<'_> {
    pub fn take(&mut self, patch: &Patch) -> ControlFlow<()> {
        let Some(index) = self.open.remove(patch.unit()) else {
            let what = format!("{:?} was not asked for, or came twice", patch.unit());
            self.failure = Some(EngineError::Backend { what });
            return ControlFlow::Break(());
        };
        if let Err(error) = self.film.merge(patch) {
            self.failure = Some(error.into());
            return ControlFlow::Break(());
        }
        self.position.set_done(index);
        let cost = schedule::cost(&patch.unit().window, &patch.unit().samples, self.guide);
        self.position.samples += cost;
        self.round_left = self.round_left.saturating_sub(cost);
        self.sink.patch(patch);
        self.report();
        self.save_if_due();
        ControlFlow::Continue(())
    }

    fn report(&mut self) {
        if self.clock.reported.elapsed() < REPORT {
            return;
        }
        self.clock.reported = Instant::now();
        let left = self.left + self.round_left;
        let progress = report(&self.run, self.position, self.clock, left, self.errors, self.projected);
        self.sink.progress(&progress);
    }

    fn save_if_due(&mut self) {
        let Some(checkpoints) = self.run.checkpoints.filter(|c| self.timer.is_due(c)) else { return };
        self.clock.stamp(self.position);
        let saved = self.timer.time(|| checkpoints.save(self.run.job, self.film, self.guide, self.position));
        warn(self.sink, saved);
    }
}

/// A checkpoint that cannot be written is no reason to lose the run.
pub(super) fn warn(sink: &mut dyn Sink, saved: Result<(), EngineError>) {
    if let Err(error) = saved {
        sink.warning(&format!("no checkpoint was written: {error}"));
    }
}

/// Samples of the job after a round; up to the ceiling while no target has fixed the end.
pub(super) fn left_after(job: &Job, position: &Position, round: &Range<u32>, guide: &Guide) -> u64 {
    let window = &job.film.bounds;
    let end = match (position.stage, &guide.counts) {
        (Stage::Pilot, _) => job.spp,
        (Stage::Adaptive { .. }, Some(counts)) => counts.span(window).end,
        _ => job.samples().end,
    };
    schedule::cost(window, &(round.end..end.max(round.end)), guide)
}

pub(super) fn report(
    run: &Run<'_>,
    position: &Position,
    clock: &Clock,
    left: u64,
    errors: &Option<ErrorSummary>,
    projected: Option<f64>,
) -> Progress {
    let rate = clock.run_rate(position);
    Progress {
        stage: position.stage,
        fraction: position.samples as f64 / (position.samples + left).max(1) as f64,
        elapsed: clock.elapsed(),
        remaining: (rate > 0.0)
            .then(|| Duration::try_from_secs_f64(left as f64 / rate).unwrap_or(Duration::MAX)),
        spp: position.samples as f64 / run.job.film.bounds.area() as f64,
        samples_per_second: rate,
        errors: errors.clone(),
        projected_spp: projected,
    }
}
