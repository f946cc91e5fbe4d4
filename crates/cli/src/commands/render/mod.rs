//! `tyndall render`.

mod files;
mod options;
mod replay;
mod tev;
mod watch;
mod write;

use std::path::{Path, PathBuf};
use std::time::Duration;

use miette::miette;
use tyndall::engine::atomic::beside;
use tyndall::engine::{Cancel, Checkpoints, End, EngineError, Outcome};
use tyndall::files::FileError;
use tyndall::files::atomic::remove_stale_temporaries;
use tyndall::image::error_path;
use tyndall::{Error, Plan, Provenance, Record, RunOptions, existing, memory, plan};

use super::{doubts, scene};
use crate::args::value::{FileKind, ImageFile};
use crate::args::{CheckpointFile, LogArgs, Names, RenderArgs, Switch};
use crate::exit::Failure;
use crate::log::Console;
use crate::signal;
use watch::Watcher;
use write::Writer;
pub use write::{command_line, tell_denoised, write_image};

/// A film of more bytes is announced.
const LARGE: u128 = 1 << 30;

/// Renders, or follows one path.
pub fn run(args: &RenderArgs, log: &LogArgs, console: &Console) -> Result<(), Failure> {
    let options = options::options(args)?;
    let plan = plan(scene::source(args.scene.as_deref()), &options)?;
    scene::tell(&plan.loaded.diagnostics.to_vec(), args.reading.strict, log, console)?;
    plan.notes.iter().for_each(|note| tracing::warn!("{note}"));
    if let Some((pixel, sample)) = args.replay.path() {
        return replay::run(&plan, pixel, sample, log);
    }
    let job = Job::new(args, plan)?;
    job.check_files()?;
    job.announce();
    if job.is_done_already() {
        tracing::info!("the job is done: {}", job.names.images[0].display());
        return Ok(());
    }
    job.refuse_to_replace().map_err(|failure| job.refusal_of_checkpoint().unwrap_or(failure))?;
    job.probe_folders()?;
    job.render(log, console)
}

/// A render about to run.
struct Job<'a> {
    args: &'a RenderArgs,
    plan: Plan,
    provenance: Provenance,
    names: Names,
    files: Vec<ImageFile>,
}

impl<'a> Job<'a> {
    fn new(args: &'a RenderArgs, plan: Plan) -> Result<Self, Failure> {
        memory::check(&plan.job.film)?;
        let provenance = Provenance::of(&plan)?;
        let names = args.names();
        let named =
            |path: &PathBuf| ImageFile::parse(&path.to_string_lossy()).map_err(|e| Failure::input(e, None));
        let files = names.images.iter().map(named).collect::<Result<_, _>>()?;
        Ok(Self { args, plan, provenance, names, files })
    }

    fn announce(&self) {
        let needed = memory::needed(&self.plan.job.film);
        if needed >= LARGE {
            tracing::info!("the film needs {:.1} GiB of memory", needed as f64 / (1u64 << 30) as f64);
        }
    }

    /// Whether pictures for the eye are denoised: by the option, else as the scene's film says.
    fn denoise(&self) -> bool {
        self.args.output.denoise.map_or(self.plan.loaded.film.denoise, |switch| switch == Switch::On)
    }

    /// Files that the run will write.
    fn results(&self) -> Vec<PathBuf> {
        let errors = self.files.iter().filter(|f| f.kind == FileKind::Exr).map(|f| error_path(&f.path));
        let record = self.names.run_json.clone();
        self.names.images.iter().cloned().chain(errors).chain([record]).collect()
    }

    fn checkpoint(&self) -> Option<&Path> {
        match &self.args.run.checkpoint {
            None => Some(&self.names.checkpoint),
            Some(CheckpointFile::Off) => None,
            Some(CheckpointFile::File(path)) => Some(path),
        }
    }

    /// A job that was resumed to its end leaves no checkpoint but its results.
    fn is_done_already(&self) -> bool {
        let gone = self.checkpoint().is_none_or(|c| !c.exists() && !beside(c, ".1").exists());
        let complete = || Record::read(&self.names.run_json).is_some_and(|record| record.complete);
        let mine = |path: &PathBuf| existing::belongs(path, &self.provenance);
        self.args.run.resume && gone && complete() && self.names.images.iter().all(mine)
    }

    fn refuse_to_replace(&self) -> Result<(), Failure> {
        if self.args.output.force {
            return Ok(());
        }
        Ok(self.results().iter().try_for_each(|path| existing::check(path, &self.provenance))?)
    }

    /// To whoever resumes, a checkpoint of another job says more than a result of another job: it tells what differs.
    fn refusal_of_checkpoint(&self) -> Option<Failure> {
        let path = self.checkpoint().filter(|_| self.args.run.resume)?;
        let refused = Checkpoints::new(path, Duration::ZERO).load(&self.plan.job).err()?;
        matches!(refused, EngineError::OtherJob { .. }).then(|| Failure::of(refused.into()))
    }

    /// No file of the run may be one that it reads, or another one of its own.
    fn check_files(&self) -> Result<(), Failure> {
        let scene = self.args.scene.iter().map(|path| ("the scene", path.clone()));
        let guide = self.args.run.guide.iter().map(|path| ("the guide", path.clone()));
        let read: Vec<_> = scene.chain(guide).collect();
        let results = self.results().into_iter().map(|path| ("a result", path));
        let states = self.checkpoint().into_iter().flat_map(|c| [c.to_path_buf(), beside(c, ".1")]);
        let written: Vec<_> = results.chain(states.map(|path| ("a checkpoint", path))).collect();
        files::check(&read, &written)?;
        let replaced = self.checkpoint().filter(|_| !self.args.run.resume);
        replaced.map_or(Ok(()), files::check_checkpoint)
    }

    /// Hours of work shall not end in a folder that cannot be written to.
    fn probe_folders(&self) -> Result<(), Failure> {
        self.results().iter().map(PathBuf::as_path).chain(self.checkpoint()).try_for_each(probe)
    }

    fn render(&self, log: &LogArgs, console: &Console) -> Result<(), Failure> {
        let cancel = Cancel::default();
        let on_signal = cancel.clone();
        signal::watch_and(move || on_signal.cancel())
            .map_err(|e| Failure::Other(miette!("cannot watch for signals: {e}")))?;
        let run = RunOptions {
            threads: self.args.run.threads.map(Into::into),
            cancel,
            checkpoints: self.checkpoint().map(|c| Checkpoints::new(c, self.args.run.checkpoint_every.0)),
            resume: self.args.run.resume,
        };
        self.mention_checkpoint();
        self.clean_up()?;
        let writer = Writer::new(self, &run);
        let mut watcher = Watcher::new(self, &writer, log, console);
        let outcome = tyndall::render(&self.plan, &run, &mut watcher);
        watcher.finish(outcome.as_ref().ok());
        let outcome = outcome?;
        self.conclude(&outcome, &writer).map_err(|failure| match self.checkpoint() {
            Some(path) if path.is_file() => {
                let path = path.display();
                failure.with_hint(&format!(
                    "nothing is lost: {path} holds what was rendered, and --resume writes it"
                ))
            }
            _ => failure,
        })?;
        match outcome.end {
            End::Cancelled => Err(Failure::Interrupted),
            End::Complete => {
                run.checkpoints.iter().for_each(Checkpoints::remove);
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// Whoever resumes says that the run before is over: what it was writing when it died is of no use.
    fn clean_up(&self) -> Result<(), Failure> {
        let stale = |path: PathBuf| Ok(remove_stale_temporaries(&path).map(|_| ()).map_err(Error::from)?);
        if self.args.run.resume { self.results().into_iter().try_for_each(stale) } else { Ok(()) }
    }

    fn mention_checkpoint(&self) {
        if let Some(path) = self.checkpoint().filter(|p| p.exists() && !self.args.run.resume) {
            tracing::info!("{}: a checkpoint is there; --resume would go on from it", path.display());
        }
    }

    fn conclude(&self, outcome: &Outcome, writer: &Writer<'_>) -> Result<(), Failure> {
        if let Some(summary) = writer.write(outcome)? {
            doubts::tell(&summary);
        }
        report_bad_samples(outcome);
        match outcome.end {
            End::Cancelled => match self.checkpoint() {
                Some(path) => tracing::warn!("interrupted; --resume goes on from {}", path.display()),
                None => tracing::warn!("interrupted, without a checkpoint"),
            },
            _ if outcome.met == Some(false) => {
                tracing::warn!("the error asked for is not reached: raise --spp, which is the ceiling");
            }
            End::TimeUp if self.args.stop.until.is_some() => {
                tracing::warn!("the time is up before the error asked for is reached");
            }
            _ => {}
        }
        Ok(())
    }
}

/// Dropped and clamped samples are never passed over in silence.
fn report_bad_samples(outcome: &Outcome) {
    let d = outcome.state.film.diagnostics();
    if d.non_finite + d.out_of_range > 0 {
        let first = d.first_bad().first();
        let replay = first.map_or_else(String::new, |b| {
            format!("; replay one by --pixel {},{} --sample {} --seed {} --trace", b.x, b.y, b.sample, b.seed)
        });
        let (n, m) = (d.non_finite, d.out_of_range);
        tracing::warn!("{n} samples that were not finite and {m} beyond all range were dropped{replay}");
    }
    if d.clamped > 0 {
        tracing::warn!(
            "the firefly clamp scaled {} samples down and removed a luminance of {:.3e}, summed over them",
            d.clamped,
            d.clamp_removed()
        );
    }
    if d.overflows > 0 {
        tracing::warn!("{} sums of squares overflowed: errors of those pixels mean nothing", d.overflows);
    }
}

/// Tries to write beside a result.
fn probe(path: &Path) -> Result<(), Failure> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    // a device or pipe takes whatever comes
    if path.exists() && !path.is_file() {
        return Ok(());
    }
    let probe = folder.join(format!(".tyndall-probe-{}", std::process::id()));
    let made = std::fs::OpenOptions::new().write(true).create_new(true).open(&probe);
    match made {
        Ok(_) => {
            // what remains of it is an empty file with a telling name
            let _ = std::fs::remove_file(&probe);
            Ok(())
        }
        Err(e) => Err(Failure::of(FileError::io(path, "write", e).into())),
    }
}
