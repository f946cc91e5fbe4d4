//! Where a job stands: all that a checkpoint must hold.

use serde::{Deserialize, Serialize};
use tyndall_film::{Film, Guide};

use crate::{EngineError, Job};

/// Stages of a job.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Stage {
    /// The only stage of a job without target.
    Plain,
    /// The samples that fix the counts of the next stage; they are left out of the result.
    Pilot,
    /// Samples by the counts of the guide, after this many looks at the errors.
    Adaptive {
        /// Looks at the errors that led to the guide, the pilot's included.
        looks: u32,
    },
    /// Nothing is left to do.
    Finished {
        /// Looks at the errors, 0 without target.
        looks: u32,
        /// Whether the target was met; true without target.
        met: bool,
    },
}

/// A position in the schedule.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Position {
    /// Stage.
    pub stage: Stage,
    /// Round within the stage.
    pub round: u32,
    /// Units of the round that are in the film, one bit each, lowest first; empty at the start of a round.
    pub done: Vec<u8>,
    /// Samples that went into films so far, those of the pilot included.
    pub samples: u64,
    /// Milliseconds spent.
    pub millis: u64,
}

impl Position {
    /// The start of a job.
    pub fn start(job: &Job) -> Self {
        let stage = if job.target.is_some() { Stage::Pilot } else { Stage::Plain };
        Self { stage, round: 0, done: Vec::new(), samples: 0, millis: 0 }
    }

    /// True when nothing is left to do.
    pub fn is_finished(&self) -> bool {
        matches!(self.stage, Stage::Finished { .. })
    }

    pub(crate) fn is_done(&self, unit: usize) -> bool {
        self.done.get(unit / 8).is_some_and(|byte| byte >> (unit % 8) & 1 == 1)
    }

    pub(crate) fn set_done(&mut self, unit: usize) {
        if self.done.len() <= unit / 8 {
            self.done.resize(unit / 8 + 1, 0);
        }
        self.done[unit / 8] |= 1 << (unit % 8);
    }

    pub(crate) fn enter(&mut self, stage: Stage) {
        self.stage = stage;
        self.round = 0;
        self.done.clear();
    }
}

/// A film, the guide it is rendered by, and the position it has reached.
#[derive(Clone, Debug)]
pub struct State {
    /// Sums so far.
    pub film: Film,
    /// Guide of the stage.
    pub guide: Guide,
    /// Position.
    pub position: Position,
}

impl State {
    /// The start of a job: an empty film.
    ///
    /// # Errors
    /// When the job is refused, or there is no memory for its film.
    pub fn start(job: &Job) -> Result<Self, EngineError> {
        job.validate()?;
        Ok(Self { film: Film::new(&job.film)?, guide: job.guide.clone(), position: Position::start(job) })
    }
}
