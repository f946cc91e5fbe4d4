//! `tyndall merge`.

use std::path::{Path, PathBuf};

use tyndall::engine::shard::{self, Merged};
use tyndall::engine::{Backend, Threads};
use tyndall::film::ErrorSummary;
use tyndall::image::error_path;
use tyndall::record::{Circumstances, Seconds};
use tyndall::{Error, Image, Provenance, Record, existing, memory};

use super::doubts;
use super::render::{command_line, tell_denoised, write_image};
use crate::args::MergeArgs;
use crate::args::value::FileKind;
use crate::exit::Failure;

/// Joins the films of all shards of a job.
pub fn run(args: &MergeArgs) -> Result<(), Failure> {
    if let Some(film) = args.output.iter().find(|f| f.kind == FileKind::Film) {
        return Err(Failure::input(
            format!("{}: the whole of a job is written as images", film.path.display()),
            Some("write .exr, which holds every number of the film"),
        ));
    }
    let merged = shard::merge(&args.films, memory::available()).map_err(Error::from)?;
    let provenance = Provenance::from_identity(&merged.identity)?;
    let record = args.output[0].path.with_extension("run.json");
    if !args.force {
        results(args, &record).iter().try_for_each(|path| existing::check(path, &provenance))?;
    }
    let image = Image::of_film(&merged.film, &provenance)?;
    let threads = args.denoise.then(|| Threads::available().width());
    let mut denoised = false;
    for file in &args.output {
        denoised |= write_image(&image, &file.path, file.kind, threads)?;
    }
    if denoised {
        tell_denoised(&args.output);
    }
    let summary = merged.film.summary();
    describe(&merged, &summary, &provenance).write(&record)?;
    doubts::tell(&summary);
    Ok(())
}

fn results(args: &MergeArgs, record: &Path) -> Vec<PathBuf> {
    let images = args.output.iter().map(|f| f.path.clone());
    let errors = args.output.iter().filter(|f| f.kind == FileKind::Exr).map(|f| error_path(&f.path));
    images.chain(errors).chain([record.to_path_buf()]).collect()
}

fn describe(merged: &Merged, summary: &ErrorSummary, provenance: &Provenance) -> Record {
    let circumstances = Circumstances {
        command: command_line(),
        scene: None,
        seconds: Seconds { render: merged.millis as f64 * 1e-3, ..Seconds::default() },
        complete: true,
        threads: 0,
        samples: merged.film.samples(),
    };
    Record::new(&merged.film, summary, provenance, circumstances)
}
