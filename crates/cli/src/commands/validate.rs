//! `tyndall validate`.

use std::path::Path;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use miette::miette;
use tyndall::engine::{Backend, Threads};
use tyndall::validate::{Depth, Outcome, Plan, Report, Watch, files, run as validate, scenes};

use super::{print, render::command_line};
use crate::args::{LogArgs, LogFormat, ValidateArgs};
use crate::exit::Failure;
use crate::log::Console;
use crate::signal::{self, Stop};

/// Time between two lines in a log.
const LOG_EVERY: Duration = Duration::from_secs(10);

/// Renders what is known, and compares.
pub fn run(args: &ValidateArgs, log: &LogArgs, console: &Console) -> Result<(), Failure> {
    let depth = match (args.quick, args.full) {
        (true, _) => Depth::Quick,
        (_, true) => Depth::Full,
        _ => Depth::Usual,
    };
    let threads = args.threads.map_or_else(Threads::available, |n| Threads::new(n.get()));
    let plan = Plan { seed: args.seed, ..Plan::new(depth, &args.family, Backend::width(&threads))? };
    if let Some(dir) = &args.scene_dir {
        return write_scenes(dir, &plan);
    }
    let stop = signal::watch().map_err(|e| Failure::Other(miette!("cannot watch for signals: {e}")))?;
    let watch = Progress::start(console, log, stop);
    let outcome = validate(&plan, &watch);
    watch.end();
    let Outcome::Done(report) = outcome? else { return Err(Failure::Interrupted) };
    files::write(&args.output, &report, &command_line())?;
    tell(args, &report, log)
}

fn write_scenes(dir: &Path, plan: &Plan) -> Result<(), Failure> {
    let written = scenes::write(dir, &plan.families)?;
    print::text(&format!(
        "{} scenes in {}, {} of them in the plain format of pbrt-v4; expected.csv lists the answers\n",
        written.scenes,
        dir.display(),
        written.plain
    ))
}

fn tell(args: &ValidateArgs, report: &Report, log: &LogArgs) -> Result<(), Failure> {
    let failures = report.failures();
    if !log.quiet {
        let rows = if args.rows { report.rows_text() } else { report.worst_text(3) };
        print::text(&format!("{rows}\n{}", report.summary_text()))?;
        print::text(&format!("{} and rows.csv beside it\n", args.output.join("index.html").display()))?;
    }
    if failures.is_empty() {
        return Ok(());
    }
    failures.iter().for_each(|f| tracing::error!("{f}"));
    tracing::error!("{} of the comparisons fail", failures.len());
    Err(Failure::Disagreement)
}

/// A line at the bottom of the terminal, or lines in the log.
struct Progress {
    stop: Stop,
    place: Option<Place>,
}

enum Place {
    Terminal(ProgressBar),
    Log(Mutex<Instant>),
}

impl Progress {
    fn start(console: &Console, log: &LogArgs, stop: Stop) -> Self {
        let place = match log.log {
            _ if log.quiet => None,
            LogFormat::Plain if console.is_terminal() => {
                let style = ProgressStyle::with_template(
                    "{percent:>3} %  {elapsed_precise} elapsed  {eta} left  {pos}/{len} renders",
                );
                let style = style.expect("the template is well formed");
                Some(Place::Terminal(console.lines().add(ProgressBar::no_length().with_style(style))))
            }
            _ => Some(Place::Log(Mutex::new(Instant::now()))),
        };
        Self { stop, place }
    }

    fn end(&self) {
        if let Some(Place::Terminal(bar)) = &self.place {
            bar.finish_and_clear();
        }
    }
}

impl Watch for Progress {
    fn rendered(&self, done: usize, of: usize) {
        match &self.place {
            None => {}
            Some(Place::Terminal(bar)) => {
                bar.set_length(of as u64);
                bar.set_position(done as u64);
            }
            Some(Place::Log(last)) => {
                let Ok(mut last) = last.lock() else { return };
                if last.elapsed() >= LOG_EVERY {
                    *last = Instant::now();
                    tracing::info!("{done} of {of} renders");
                }
            }
        }
    }

    fn stop(&self) -> bool {
        self.stop.requested()
    }
}
