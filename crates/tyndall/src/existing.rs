//! An existing result is replaced only by the same job, or by force.
//!
//! Every result says which job it belongs to: images, PNG files and tables by the hash of the job, films by the identity in
//! their header, the record of a run by its fields. What says nothing, or belongs to another job, stays.

use crate::{Error, Provenance, Record, cube, image::attribute, table};
use std::path::Path;
use tyndall_engine::{EngineError, container};
use tyndall_files::image::{MetaValue, probe_exr, read_png_texts};

/// Refuses when a file is there that does not belong to the job.
///
/// # Errors
/// With the file's name and what to do.
pub fn check(path: &Path, ours: &Provenance) -> Result<(), Error> {
    if !is_file(path) || belongs(path, ours) {
        return Ok(());
    }
    Err(Error::options(
        format!("{}: exists and is not the result of this job", path.display()),
        Some("--force replaces it, -o NAME writes elsewhere".into()),
    ))
}

/// Only regular files hold results: a device or pipe takes whatever comes.
fn is_file(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|m| m.is_file())
}

/// True when the file at `path` says that it belongs to the job.
pub fn belongs(path: &Path, ours: &Provenance) -> bool {
    match path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase).as_deref() {
        Some("exr") => exr_job(path).as_deref() == Some(&ours.job),
        Some("png") => read_png_texts(path).is_ok_and(|t| t.get(attribute::JOB) == Some(&ours.job)),
        Some("csv") => table::job_of(path).as_deref() == Some(&ours.job),
        Some("nc") => cube::job_of(path).as_deref() == Some(&ours.job),
        Some("film") => is_film_of(path, ours),
        Some("json") => Record::read(path).is_some_and(|r| same_run(&r, ours)),
        _ => false,
    }
}

fn exr_job(path: &Path) -> Option<String> {
    match probe_exr(path).ok()?.frame.meta.remove(attribute::JOB) {
        Some(MetaValue::Text(job)) => Some(job),
        _ => None,
    }
}

/// Whether a film's header names the job, and the same part of it; the film itself is not read.
fn is_film_of(path: &Path, ours: &Provenance) -> bool {
    let mut same = false;
    let stop = |header: &container::Header| {
        same = header.identity == ours.settings && header.shard == ours.shard;
        Err(EngineError::Merge { what: String::new() })
    };
    // always an error: ours, or that the file is none of ours
    let _ = container::read(path, u64::MAX, stop);
    same
}

fn same_run(r: &Record, p: &Provenance) -> bool {
    let settings =
        (r.integrator == p.integrator) && (r.spectral == p.spectral) && r.wavelengths == p.wavelengths;
    r.scene_hash == p.scene_hash && r.seed == p.seed && settings && r.range_nm == p.range
}
