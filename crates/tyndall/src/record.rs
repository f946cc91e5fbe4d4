//! `NAME.run.json`: what was done, how long it took, and the error.

use crate::{Error, Provenance};
use serde::{Deserialize, Serialize, Serializer};
use std::path::Path;
use tyndall_film::{ErrorSummary, Film};

/// The record of a run; its fields are the file's keys, in this order.
#[derive(Clone, Debug, Serialize, Deserialize, PartialEq)]
pub struct Record {
    /// Version of the program.
    pub version: String,
    /// The command as it was given.
    pub command: String,
    /// The scene's file, or the name of the built-in scene; `null` where only its hash is known.
    pub scene: Option<String>,
    /// Hash of the scene and all that it refers to.
    pub scene_hash: String,
    /// Seed of all random numbers.
    pub seed: u64,
    /// The integrator.
    pub integrator: String,
    /// The spectral strategy.
    pub spectral: String,
    /// Wavelengths of a path, or size of the fixed set; `null` for the continuum.
    pub wavelengths: Option<u32>,
    /// Size of the whole image \[pixels\].
    pub resolution: [u32; 2],
    /// Mean samples per pixel that are in the image; an integer in the file where it is whole.
    #[serde(serialize_with = "integer_if_whole")]
    pub spp: f64,
    /// Whether the job was done; false where the run was interrupted, or its time was up. Written only where it is false.
    #[serde(default = "done", skip_serializing_if = "is_done")]
    pub complete: bool,
    /// Times \[s\].
    pub seconds: Seconds,
    /// Samples per second of rendering.
    pub samples_per_second: f64,
    /// Threads.
    pub threads: usize,
    /// The errors in short.
    pub error: ErrorRecord,
    /// Samples that were dropped because they were not finite.
    pub non_finite: u64,
    /// Spectral range \[nm\].
    pub range_nm: [f32; 2],
    /// Unit of spectral radiance.
    pub units: String,
}

/// Times \[s\].
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize, PartialEq)]
pub struct Seconds {
    /// Reading the scene.
    pub load: f64,
    /// Building the acceleration structure.
    pub build: f64,
    /// Rendering, earlier runs of the job included.
    pub render: f64,
}

/// Relative standard errors of luminance over the pixels; `null` while unknown.
#[derive(Clone, Debug, Serialize, Deserialize, PartialEq)]
pub struct ErrorRecord {
    /// `conservative` or `replicated`.
    pub mode: String,
    /// Median.
    pub median_rel_se_y: Option<f64>,
    /// The worst pixel's.
    pub max_rel_se_y: Option<f64>,
}

impl ErrorRecord {
    fn of(summary: &ErrorSummary) -> Self {
        let known = |v: f64| v.is_finite().then_some(v);
        Self {
            mode: summary.mode.name().into(),
            median_rel_se_y: known(summary.median_rel_se_y),
            max_rel_se_y: known(summary.max_rel_se_y),
        }
    }
}

/// What a record needs beside film and provenance.
#[derive(Clone, Debug, Default)]
pub struct Circumstances {
    /// The command as it was given.
    pub command: String,
    /// The scene's name.
    pub scene: Option<String>,
    /// Times \[s\].
    pub seconds: Seconds,
    /// Whether the job is done.
    pub complete: bool,
    /// Threads.
    pub threads: usize,
    /// All samples that were taken, those of a pilot included.
    pub samples: u64,
}

/// Every f64 below this is exact as an integer.
const EXACT: f64 = 9_007_199_254_740_992.0;

fn done() -> bool {
    true
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "the signature that serde asks for")]
fn is_done(complete: &bool) -> bool {
    *complete
}

fn integer_if_whole<S: Serializer>(v: &f64, s: S) -> Result<S::Ok, S::Error> {
    if v.fract() == 0.0 && v.abs() < EXACT { s.serialize_i64(*v as i64) } else { s.serialize_f64(*v) }
}

impl Record {
    /// The record of a film.
    pub fn new(film: &Film, summary: &ErrorSummary, p: &Provenance, c: Circumstances) -> Self {
        let area = film.spec().bounds.area().max(1) as f64;
        Self {
            version: env!("CARGO_PKG_VERSION").into(),
            command: c.command,
            scene: c.scene,
            scene_hash: p.scene_hash.clone(),
            seed: p.seed,
            integrator: p.integrator.clone(),
            spectral: p.spectral.clone(),
            wavelengths: p.wavelengths,
            resolution: film.spec().resolution,
            spp: film.samples() as f64 / area,
            complete: c.complete,
            seconds: c.seconds,
            samples_per_second: if c.seconds.render > 0.0 {
                c.samples as f64 / c.seconds.render
            } else {
                0.0
            },
            threads: c.threads,
            error: ErrorRecord::of(summary),
            non_finite: film.diagnostics().non_finite,
            range_nm: p.range,
            units: p.units.clone(),
        }
    }

    /// Writes the record, whole or not at all.
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        let mut text = serde_json::to_string_pretty(self)
            .map_err(|e| Error::options(format!("{}: {e}", path.display()), None))?;
        text.push('\n');
        Ok(tyndall_files::atomic::write_bytes_atomic(path, text.as_bytes())?)
    }

    /// Reads a record; `None` when the file is none.
    pub fn read(path: &Path) -> Option<Self> {
        serde_json::from_slice(&std::fs::read(path).ok()?).ok()
    }
}
