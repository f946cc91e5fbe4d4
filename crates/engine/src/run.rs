//! The loop that runs a job: rounds, merges, looks at the errors, progress, checkpoints.

mod clock;
mod delivery;

use std::collections::HashMap;
use std::ops::Range;
use std::time::{Duration, Instant};

use clock::Clock;
use delivery::{Delivery, left_after, report, warn};
use tyndall_film::{ErrorSummary, Pass, WorkUnit};

use crate::backend::{Backend, Cancel, Work};
use crate::checkpoint::{Checkpoints, Timer};
use crate::pilot::{self, Look};
use crate::progress::Sink;
use crate::schedule::{self, Schedule};
use crate::{EngineError, Job, Stage, State};

/// A job and all that it is run with.
#[derive(Clone, Copy)]
pub struct Run<'r> {
    /// What is computed.
    pub job: &'r Job,
    /// How a unit is rendered.
    pub pass: &'r dyn Pass,
    /// Who renders units.
    pub backend: &'r dyn Backend,
    /// Asks to stop.
    pub cancel: &'r Cancel,
    /// Where the state is saved.
    pub checkpoints: Option<&'r Checkpoints>,
}

/// Why a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// Nothing is left to do.
    Complete,
    /// The next round would not have fitted into the time.
    TimeUp,
    /// It was asked to stop.
    Cancelled,
}

/// What a run leaves behind.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Film, guide and position.
    pub state: State,
    /// Why it ended.
    pub end: End,
    /// Seconds of this run.
    pub seconds: f64,
    /// Samples of this run.
    pub samples: u64,
    /// Whether the target is met; `None` without target, or when the run ended before it was looked at.
    pub met: Option<bool>,
    /// Confidence at which intervals err in at most 5 % of all cases, after all looks at the errors.
    pub confidence: f64,
}

impl Run<'_> {
    /// Runs the job from its beginning.
    ///
    /// # Errors
    /// When the job is refused or a unit fails.
    pub fn start(&self, sink: &mut dyn Sink) -> Result<Outcome, EngineError> {
        self.resume(State::start(self.job)?, sink)
    }

    /// Goes on from a state, to the same bits as an uninterrupted run.
    ///
    /// # Errors
    /// When the job is refused or a unit fails.
    pub fn resume(&self, state: State, sink: &mut dyn Sink) -> Result<Outcome, EngineError> {
        self.job.validate()?;
        Driver::new(*self, state, sink).drive()
    }
}

/// A run under way.
struct Driver<'r, 's> {
    run: Run<'r>,
    sink: &'s mut dyn Sink,
    schedule: Schedule,
    state: State,
    timer: Timer,
    clock: Clock,
    errors: Option<ErrorSummary>,
    projected: Option<f64>,
    /// When the errors were last summarised, and what that took.
    looked: (Instant, Duration),
}

impl<'r, 's> Driver<'r, 's> {
    fn new(run: Run<'r>, state: State, sink: &'s mut dyn Sink) -> Self {
        let clock = Clock::start(&state.position);
        let schedule = Schedule::new(&run.job.film);
        Self {
            run,
            sink,
            schedule,
            state,
            timer: Timer::start(),
            clock,
            errors: None,
            projected: None,
            looked: (Instant::now(), Duration::ZERO),
        }
    }

    fn drive(mut self) -> Result<Outcome, EngineError> {
        // a finished job is not written again
        if self.state.position.is_finished() {
            return Ok(self.outcome(End::Complete));
        }
        let end = loop {
            if self.state.position.is_finished() {
                break End::Complete;
            }
            if self.run.cancel.is_cancelled() {
                break End::Cancelled;
            }
            let Some(samples) = self.round_samples() else {
                self.next_stage();
                continue;
            };
            if !self.fits(&samples) {
                break End::TimeUp;
            }
            let rendered = self.round(&samples);
            if rendered.is_err() {
                self.save();
            }
            if !rendered? {
                break End::Cancelled;
            }
            self.end_round(&samples);
        };
        self.save();
        Ok(self.outcome(end))
    }

    /// Sample indices of the current stage.
    fn stage_samples(&self) -> Range<u32> {
        match (self.state.position.stage, &self.run.job.target, &self.state.guide.counts) {
            (Stage::Pilot, Some(target), _) => 0..target.pilot,
            (Stage::Adaptive { .. }, _, Some(counts)) => counts.span(&self.run.job.film.bounds),
            _ => self.run.job.samples(),
        }
    }

    /// Sample indices of the current round; `None` when the stage is through.
    fn round_samples(&self) -> Option<Range<u32>> {
        schedule::rounds(self.stage_samples()).nth(self.state.position.round as usize)
    }

    /// Whether a round is expected to end in time. The first round of a job always runs.
    fn fits(&self, samples: &Range<u32>) -> bool {
        let Some(limit) = self.run.job.time else { return true };
        let elapsed = self.clock.elapsed();
        let position = &self.state.position;
        if position.samples == 0 || !position.done.is_empty() {
            return position.samples == 0 || elapsed < limit;
        }
        let cost = schedule::cost(&self.run.job.film.bounds, samples, &self.state.guide) as f64;
        elapsed < limit && elapsed.as_secs_f64() + cost / self.clock.rate() <= limit.as_secs_f64()
    }

    /// Renders what is left of a round; false when it was stopped before its end.
    fn round(&mut self, samples: &Range<u32>) -> Result<bool, EngineError> {
        let State { film, guide, position } = &mut self.state;
        let units = self.schedule.units(position.round, samples, guide);
        let mut open: HashMap<WorkUnit, usize> = units.iter().cloned().zip(0..).collect();
        open.retain(|_, k| !position.is_done(*k));
        let todo: Vec<WorkUnit> = units.into_iter().filter(|u| open.contains_key(u)).collect();
        let left = left_after(self.run.job, position, samples, guide);
        let mut delivery = Delivery {
            run: self.run,
            film,
            guide,
            position,
            open: &mut open,
            timer: &mut self.timer,
            clock: &mut self.clock,
            sink: self.sink,
            left,
            round_left: todo.iter().map(|u| schedule::cost(&u.window, &u.samples, guide)).sum(),
            errors: &self.errors,
            projected: self.projected,
            failure: None,
        };
        let work = Work { pass: self.run.pass, film: &self.run.job.film, guide, cancel: self.run.cancel };
        let result = self.run.backend.run(work, &mut todo.into_iter(), &mut |patch| delivery.take(patch));
        if let Some(failure) = delivery.failure.take() {
            return Err(failure);
        }
        result?;
        if open.is_empty() {
            return Ok(true);
        }
        if self.run.cancel.is_cancelled() {
            return Ok(false);
        }
        Err(EngineError::Backend { what: format!("{} units were not delivered", open.len()) })
    }

    fn end_round(&mut self, samples: &Range<u32>) {
        self.state.position.round += 1;
        self.state.position.done.clear();
        self.clock.end_round(&self.state.position);
        self.look();
        self.sink.round(&self.state.film);
        let left = left_after(self.run.job, &self.state.position, samples, &self.state.guide);
        let progress =
            report(&self.run, &self.state.position, &self.clock, left, &self.errors, self.projected);
        self.sink.progress(&progress);
    }

    /// Summarises the errors for the progress line: at the end of a stage, and else for no more than a twentieth of the
    /// time.
    fn look(&mut self) {
        let (last, cost) = self.looked;
        if last.elapsed() < cost * 20 && self.round_samples().is_some() {
            return;
        }
        let start = Instant::now();
        self.errors = Some(self.state.film.summary());
        if let Some(target) = &self.run.job.target {
            self.projected = Look::new(&self.state.film, target).projected_spp(target);
        }
        self.looked = (Instant::now(), start.elapsed());
    }

    /// Fixes the counts of the next stage, or ends the job.
    fn next_stage(&mut self) {
        let State { film, guide, position } = &mut self.state;
        let (job, target) = match (&self.run.job.target, position.stage) {
            (Some(target), Stage::Pilot | Stage::Adaptive { .. }) => (self.run.job, target),
            _ => return position.enter(Stage::Finished { looks: 0, met: true }),
        };
        let look = Look::new(film, target);
        let looks = match position.stage {
            Stage::Adaptive { looks } => looks,
            _ => {
                *guide = look.first_counts(job, target);
                film.clear();
                return position.enter(Stage::Adaptive { looks: 1 });
            }
        };
        if look.deciding(target) <= 1.0 {
            return position.enter(Stage::Finished { looks, met: true });
        }
        match look.more_counts(job, target, guide).filter(|_| looks < pilot::MAX_LOOKS) {
            Some(more) => {
                *guide = more;
                position.enter(Stage::Adaptive { looks: looks + 1 });
            }
            None => position.enter(Stage::Finished { looks, met: false }),
        }
    }

    fn save(&mut self) {
        self.clock.stamp(&mut self.state.position);
        let Some(checkpoints) = self.run.checkpoints else { return };
        let State { film, guide, position } = &self.state;
        let saved = self.timer.time(|| checkpoints.save(self.run.job, film, guide, position));
        warn(self.sink, saved);
    }

    fn outcome(self, end: End) -> Outcome {
        let (met, looks) = match self.state.position.stage {
            Stage::Finished { looks, met } => (self.run.job.target.as_ref().map(|_| met), looks),
            Stage::Adaptive { looks } => (None, looks),
            _ => (None, 0),
        };
        Outcome {
            end,
            seconds: self.clock.run().as_secs_f64(),
            samples: self.state.position.samples - self.clock.samples_before,
            met,
            confidence: pilot::confidence(looks),
            state: self.state,
        }
    }
}
