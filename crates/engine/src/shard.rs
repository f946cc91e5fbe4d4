//! Parts of a job as files, and their union.

use std::path::{Path, PathBuf};

use tyndall_film::Film;

use crate::atomic::NoFaults;
use crate::container::{self, Header};
use crate::{EngineError, Job, State, job};

/// Writes a finished film or shard.
///
/// # Errors
/// Whatever the system says.
pub fn save(path: &Path, job: &Job, state: &State) -> Result<(), EngineError> {
    container::write(path, false, &NoFaults, job, &state.film, &state.guide, &state.position)
}

/// The union of all shards of a job.
#[derive(Clone, Debug)]
pub struct Merged {
    /// Same bits as of one run.
    pub film: Film,
    /// Identity of the job, see [`Job::identity`].
    pub identity: Vec<(String, String)>,
    /// Milliseconds of all shards together.
    pub millis: u64,
}

/// Adds up the shards of one job, in any order; `limit` is the most memory a film may take \[bytes\].
///
/// # Errors
/// When a file is damaged or belongs to another job, or when files hold the same samples, or some are missing.
pub fn merge(paths: &[PathBuf], limit: u64) -> Result<Merged, EngineError> {
    let mut merged: Option<(Header, State)> = None;
    let mut parts = Vec::new();
    let mut millis = 0;
    for path in paths {
        let first = merged.as_ref().map(|(header, _)| header);
        let (header, state) = container::read(path, limit, |h| accept(h, first, path, &parts))?;
        parts.push(Part { samples: header.samples, path: path.clone() });
        millis += header.position.millis;
        match &mut merged {
            None => merged = Some((header, state)),
            Some((_, sum)) => sum.film.merge_film(&state.film)?,
        }
    }
    let Some((header, state)) = merged else {
        return Err(EngineError::Merge { what: "no films given".into() });
    };
    check_whole(&header, parts)?;
    Ok(Merged { film: state.film, identity: header.identity, millis })
}

struct Part {
    samples: [u32; 2],
    path: PathBuf,
}

/// Refuses a film of another job, an unfinished one, and one whose samples are there already.
fn accept(header: &Header, first: Option<&Header>, path: &Path, parts: &[Part]) -> Result<(), EngineError> {
    if let Some(first) = first {
        let differences = job::differences(&header.identity, &first.identity);
        if !differences.is_empty() {
            return Err(EngineError::OtherJob { path: path.into(), differences });
        }
    }
    if !header.position.is_finished() {
        let what = format!("{} is not finished: {:?}", path.display(), header.position.stage);
        return Err(EngineError::Merge { what });
    }
    let [a, b] = header.samples;
    match parts.iter().find(|p| p.samples[0] < b && a < p.samples[1]) {
        None => Ok(()),
        Some(p) => {
            let what = format!(
                "{} and {} both hold samples {} to {}",
                p.path.display(),
                path.display(),
                a.max(p.samples[0]),
                b.min(p.samples[1]) - 1
            );
            Err(EngineError::Merge { what })
        }
    }
}

fn check_whole(header: &Header, mut parts: Vec<Part>) -> Result<(), EngineError> {
    parts.sort_by_key(|p| p.samples[0]);
    let [mut at, end] = header.all_samples;
    for start in parts.iter().map(|p| p.samples[0]).chain([end]) {
        if start > at {
            let what = format!("samples {at} to {} are in none of the films", start - 1);
            return Err(EngineError::Merge { what });
        }
        at = parts.iter().filter(|p| p.samples[0] == start).map(|p| p.samples[1]).max().unwrap_or(at);
    }
    Ok(())
}
