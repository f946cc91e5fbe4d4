//! `tyndall paper`: the figures of the paper on one page.

use std::time::Instant;

use miette::miette;
use tyndall::engine::Cancel;
use tyndall::paper::{Effort, PaperOptions, Step, run as compute};

use crate::args::{LogArgs, PaperArgs};
use crate::exit::Failure;
use crate::log::Console;
use crate::progress::{Progress, Samples, Status};
use crate::signal;

/// Runs the command.
pub fn run(args: &PaperArgs, log: &LogArgs, console: &Console) -> Result<(), Failure> {
    let cancel = Cancel::default();
    let on_signal = cancel.clone();
    signal::watch_and(move || on_signal.cancel())
        .map_err(|e| Failure::Other(miette!("cannot watch for signals: {e}")))?;
    let effort = match (args.quick, args.full) {
        (true, _) => Effort::Quick,
        (_, true) => Effort::Full,
        _ => Effort::Default,
    };
    let options = PaperOptions {
        folder: args.output.clone(),
        effort,
        threads: args.threads.map(Into::into),
        cancel: cancel.clone(),
    };
    let start = Instant::now();
    let mut progress = Progress::start(console, log);
    let mut number = 0;
    let result = compute(&options, &mut |step: &Step| {
        if step.number != number {
            number = step.number;
            tracing::info!("{} of {}: {}", step.number, step.count, step.name);
        }
        progress.update(&status(step, start));
    });
    if result.is_ok() {
        progress.finish(&status(&Step { done: 1.0, ..Step::default() }, start));
    }
    match result {
        Err(_) if cancel.is_cancelled() => {
            tracing::warn!("interrupted; the same command goes on from here");
            Err(Failure::Interrupted)
        }
        Err(e) => Err(e.into()),
        Ok(page) => {
            tracing::info!("{}", page.display());
            Ok(())
        }
    }
}

fn status(step: &Step, start: Instant) -> Status {
    let samples = step.samples.map(|s| Samples { spp: s.spp, end: Some(s.end), per_second: s.per_second });
    Status { done: step.done, elapsed: start.elapsed(), left: step.left, samples, median_rel_se: None }
}
