//! Errors of the engine.

use std::path::PathBuf;

use tyndall_film::{FilmError, WorkUnit};

/// What can go wrong while a job runs, or when its files are read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EngineError {
    /// The film cannot be made or added to.
    #[error(transparent)]
    Film(#[from] FilmError),
    /// The job contradicts itself.
    #[error("{what}\nhint: {hint}")]
    Job {
        /// What is asked that cannot be.
        what: String,
        /// What to do instead.
        hint: &'static str,
    },
    /// A worker failed in the middle of a unit.
    #[error("rendering failed at {}: {message}\nhint: this is a bug in the renderer; the sample can be replayed alone", place(.at, .unit))]
    Worker {
        /// Pixel (x, y) and sample, when the pass said where it was.
        at: Option<(u32, u32, u32)>,
        /// Unit.
        unit: WorkUnit,
        /// The panic's message.
        message: String,
    },
    /// A backend delivered a unit that was not asked for, or twice, or lost one.
    #[error("the backend broke its contract: {what}")]
    Backend {
        /// What it did.
        what: String,
    },
    /// A file could not be read or written.
    #[error("{}: cannot {action}: {source}", path.display())]
    Io {
        /// File.
        path: PathBuf,
        /// `read`, `write` ...
        action: &'static str,
        /// The system's reason.
        source: std::io::Error,
    },
    /// A file is damaged or is none of ours.
    #[error("{}: {what}", path.display())]
    Damaged {
        /// File.
        path: PathBuf,
        /// What is wrong.
        what: String,
    },
    /// A file belongs to another job, scene or version.
    #[error("{}: belongs to another job:\n  {}", path.display(), differences.join("\n  "))]
    OtherJob {
        /// File.
        path: PathBuf,
        /// What differs: `name: there and here`.
        differences: Vec<String>,
    },
    /// Shards that do not make up one film.
    #[error("cannot merge: {what}")]
    Merge {
        /// What is wrong, with file names.
        what: String,
    },
}

fn place(at: &Option<(u32, u32, u32)>, unit: &WorkUnit) -> String {
    match at {
        Some((x, y, sample)) => format!("pixel ({x}, {y}), sample {sample}"),
        None => format!("the start of {unit:?}"),
    }
}

impl EngineError {
    pub(crate) fn io(path: &std::path::Path, action: &'static str, source: std::io::Error) -> Self {
        Self::Io { path: path.into(), action, source }
    }

    pub(crate) fn damaged(path: &std::path::Path, what: impl Into<String>) -> Self {
        Self::Damaged { path: path.into(), what: what.into() }
    }
}
