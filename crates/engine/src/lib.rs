//! The engine: a job becomes rounds of work units, a backend renders them, their patches add up to a film.
//!
//! The engine knows nothing of scenes. A [`tyndall_film::Pass`] turns a unit into a patch; because a patch depends on nothing
//! but (job, guide, unit) and films are sums without order, every way of running a job gives the same bits: any number of
//! threads, units in any order, a run that was stopped and resumed, shards on several machines.
//!
//! - [`Job`]: what is to be computed; two jobs with the same [`Job::identity`] give the same film.
//! - [`schedule`]: the fixed order of rounds and units; [`pilot`]: the adaptive second stage behind `--until`.
//! - [`Backend`]: who renders units; [`Threads`] does it here.
//! - [`run`]: the loop, with stop rules, progress and checkpoints.
//! - [`checkpoint`], [`shard`]: films on disk, in one container format, written whole or not at all.
#![forbid(unsafe_code)]

pub mod atomic;
pub mod backend;
pub mod checkpoint;
pub mod container;
mod error;
pub mod job;
pub mod pilot;
pub mod progress;
pub mod run;
pub mod schedule;
pub mod shard;
pub mod state;
pub mod threads;

pub use backend::{Backend, Cancel};
pub use checkpoint::Checkpoints;
pub use error::EngineError;
pub use job::{Job, Quantity, Shard, Target};
pub use progress::{Progress, Silent, Sink};
pub use run::{End, Outcome, Run};
pub use schedule::Schedule;
pub use state::{Position, Stage, State};
pub use threads::Threads;
