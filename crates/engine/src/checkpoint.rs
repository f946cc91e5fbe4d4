//! Checkpoints: the state of a job on disk, so that a killed run loses at most one interval.

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use tyndall_film::{Film, Guide};

use crate::atomic::{self, Faults, NoFaults};
use crate::{EngineError, Job, Position, State, container, job};

/// A checkpoint takes at most this part of the time.
const SHARE: u32 = 20;

/// Where and how often checkpoints are written. Two are kept: `NAME` and its predecessor `NAME.1`.
#[derive(Clone)]
pub struct Checkpoints {
    path: PathBuf,
    interval: Duration,
    faults: Arc<dyn Faults>,
}

impl fmt::Debug for Checkpoints {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Checkpoints").field("path", &self.path).field("interval", &self.interval).finish()
    }
}

/// A state read from disk, and what had to be said about the files on the way.
#[derive(Clone, Debug)]
pub struct Resumed {
    /// State to go on from.
    pub state: State,
    /// The file it came from.
    pub path: PathBuf,
    /// Warnings: a damaged file that was passed over.
    pub notes: Vec<String>,
}

impl Checkpoints {
    /// Checkpoints in `path`, one per `interval` (60 s is usual; zero: after every patch, whatever that costs).
    pub fn new(path: impl Into<PathBuf>, interval: Duration) -> Self {
        Self { path: path.into(), interval, faults: Arc::new(NoFaults) }
    }

    /// With injected faults.
    pub fn with_faults(mut self, faults: Arc<dyn Faults>) -> Self {
        self.faults = faults;
        self
    }

    /// File of the newest checkpoint.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes a checkpoint, keeping its predecessor.
    ///
    /// # Errors
    /// Whatever the system says; the files before it stay.
    pub fn save(
        &self,
        job: &Job,
        film: &Film,
        guide: &Guide,
        position: &Position,
    ) -> Result<(), EngineError> {
        container::write(&self.path, true, &*self.faults, job, film, guide, position)
    }

    /// Reads the newest checkpoint that is whole.
    ///
    /// A missing or damaged file falls back to its predecessor; a damaged one is set aside as `NAME.damaged`, so that the
    /// next checkpoint cannot push the good one out.
    ///
    /// # Errors
    /// When there is none, or the newest whole one belongs to another scene, version or job.
    pub fn load(&self, job: &Job) -> Result<Resumed, EngineError> {
        let first = match read(&self.path, job) {
            Ok(state) => return Ok(Resumed { state, path: self.path.clone(), notes: Vec::new() }),
            Err(error) => error,
        };
        let missing =
            matches!(&first, EngineError::Io { source, .. } if source.kind() == std::io::ErrorKind::NotFound);
        if !missing && !matches!(first, EngineError::Damaged { .. }) {
            return Err(first);
        }
        let older = atomic::beside(&self.path, ".1");
        let state = match read(&older, job) {
            Ok(state) => state,
            Err(EngineError::Io { source, .. }) if source.kind() == std::io::ErrorKind::NotFound => {
                return Err(first);
            }
            Err(error) => return Err(error),
        };
        let mut notes = vec![format!("{first}; going on from {}", older.display())];
        if !missing && let Err(e) = std::fs::rename(&self.path, atomic::beside(&self.path, ".damaged")) {
            notes.push(format!("{}: cannot be set aside: {e}", self.path.display()));
        }
        Ok(Resumed { state, path: older, notes })
    }

    /// Removes the checkpoints of a job whose results are written.
    pub fn remove(&self) {
        for suffix in ["", ".1", ".tmp"] {
            let _ = std::fs::remove_file(atomic::beside(&self.path, suffix));
        }
    }
}

fn read(path: &Path, job: &Job) -> Result<State, EngineError> {
    let limit = u64::try_from(job.film.bytes()).unwrap_or(u64::MAX);
    let (_, state) = container::read(path, u64::MAX, |header| {
        let mut differences = job::differences(&header.identity, &job.identity());
        if header.shard != job.shard {
            differences.push(format!("shard: {:?} there, {:?} here", header.shard, job.shard));
        }
        if !differences.is_empty() {
            return Err(EngineError::OtherJob { path: path.into(), differences });
        }
        if let Some(what) = header.film.difference(&job.film) {
            return Err(EngineError::damaged(path, format!("its film is not that of its job: {what}")));
        }
        Ok(header.film.check_size(limit)?)
    })?;
    Ok(state)
}

/// Decides when the next checkpoint is due: after the interval, and never so often that it costs more than a twentieth.
#[derive(Debug)]
pub(crate) struct Timer {
    last: Instant,
    cost: Duration,
}

impl Timer {
    pub fn start() -> Self {
        Self { last: Instant::now(), cost: Duration::ZERO }
    }

    pub fn is_due(&self, checkpoints: &Checkpoints) -> bool {
        let interval = checkpoints.interval;
        interval.is_zero() || self.last.elapsed() >= interval.max(self.cost * SHARE)
    }

    /// Runs a save and takes its time.
    pub fn time<T>(&mut self, save: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let result = save();
        self.cost = start.elapsed();
        self.last = Instant::now();
        result
    }
}
