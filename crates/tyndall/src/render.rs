//! Runs a plan on this machine's threads.

use crate::{Error, Plan, memory};
use tyndall_engine::{Cancel, Checkpoints, EngineError, Outcome, Run, Sink, Threads};

/// How the work is done; the bits do not depend on it.
#[derive(Clone, Debug, Default)]
pub struct RunOptions {
    /// Threads; what the machine allows if `None`.
    pub threads: Option<usize>,
    /// Asks to stop.
    pub cancel: Cancel,
    /// Where the state is saved.
    pub checkpoints: Option<Checkpoints>,
    /// Go on from the checkpoint.
    pub resume: bool,
}

impl RunOptions {
    /// The backend asked for.
    pub fn backend(&self) -> Threads {
        self.threads.map_or_else(Threads::available, Threads::new)
    }
}

/// Renders.
///
/// # Errors
/// When the film does not fit into memory, the job contradicts itself, the checkpoint is of another job, or a unit fails.
pub fn render(plan: &Plan, run: &RunOptions, sink: &mut dyn Sink) -> Result<Outcome, Error> {
    memory::check(&plan.job.film)?;
    let backend = run.backend();
    let checkpoints = run.checkpoints.as_ref();
    let engine =
        Run { job: &plan.job, pass: &plan.pass, backend: &backend, cancel: &run.cancel, checkpoints };
    let Some(checkpoints) = checkpoints.filter(|_| run.resume) else { return Ok(engine.start(sink)?) };
    let resumed = checkpoints.load(&plan.job).map_err(nothing_to_resume)?;
    resumed.notes.iter().for_each(|note| sink.warning(note));
    Ok(engine.resume(resumed.state, sink)?)
}

fn nothing_to_resume(e: EngineError) -> Error {
    match e {
        EngineError::Io { path, source, .. } if source.kind() == std::io::ErrorKind::NotFound => {
            Error::options(
                format!("{}: there is no checkpoint to resume from", path.display()),
                Some("leave out --resume, or name the checkpoint by --checkpoint FILE".into()),
            )
        }
        other => other.into(),
    }
}
