//! What a render tells while it runs: progress, images so far, the display.

use std::time::{Duration, Instant};

use tyndall::engine::{Outcome, Progress as EngineProgress, Sink};
use tyndall::film::Film;

use super::Job;
use super::tev::Display;
use super::write::Writer;
use crate::args::LogArgs;
use crate::log::Console;
use crate::progress::{Progress, Samples, Status};

/// Watches a render.
pub struct Watcher<'w> {
    progress: Option<Progress>,
    status: Status,
    spp_end: Option<u32>,
    display: Option<Display>,
    every: Option<Duration>,
    written: Instant,
    writer: &'w Writer<'w>,
}

impl<'w> Watcher<'w> {
    /// Shows the start.
    pub fn new(job: &Job<'_>, writer: &'w Writer<'w>, log: &LogArgs, console: &Console) -> Self {
        let address = job.args.output.display_server.as_ref();
        Self {
            progress: Some(Progress::start(console, log)),
            status: Status::default(),
            spp_end: job.plan.job.mean_spp().map(|spp| spp.round() as u32),
            display: address.and_then(|a| Display::open(a, &job.names.images[0], &job.plan.job.film)),
            every: job.args.output.write_every.map(|d| d.0),
            written: Instant::now(),
            writer,
        }
    }

    /// Shows the end.
    pub fn finish(&mut self, outcome: Option<&Outcome>) {
        // after an error there is no end to show
        let (Some(progress), Some(outcome)) = (self.progress.take(), outcome) else { return };
        let state = &outcome.state;
        let area = state.film.spec().bounds.area().max(1) as f64;
        self.status.elapsed = Duration::from_millis(state.position.millis);
        let spp = state.film.samples() as f64 / area;
        let last = self.status.samples.unwrap_or_default();
        self.status.samples = Some(Samples { spp, ..last });
        self.status.left = None;
        if state.position.is_finished() {
            self.status.done = 1.0;
        }
        progress.finish(&self.status);
    }
}

impl Sink for Watcher<'_> {
    fn progress(&mut self, p: &EngineProgress) {
        self.status = Status {
            done: p.fraction,
            elapsed: p.elapsed,
            left: p.remaining,
            samples: Some(Samples { spp: p.spp, end: self.spp_end, per_second: p.samples_per_second }),
            median_rel_se: p.errors.as_ref().map(|e| e.median_rel_se_y).filter(|e| e.is_finite()),
        };
        if let Some(progress) = &mut self.progress {
            progress.update(&self.status);
        }
    }

    fn round(&mut self, film: &Film) {
        if let Some(display) = &mut self.display {
            display.show(film);
        }
        if self.every.is_some_and(|every| self.written.elapsed() >= every) {
            if let Err(e) = self.writer.images(film) {
                tracing::warn!("the image so far was not written: {}", e);
            }
            self.written = Instant::now();
        }
    }

    fn warning(&mut self, text: &str) {
        tracing::warn!("{text}");
    }
}
