//! What a render writes.

use std::path::Path;

use tyndall::engine::{End, Outcome, shard};
use tyndall::files::FileError;
use tyndall::files::image::{ExrOptions, write_exr, write_png};
use tyndall::film::{ErrorSummary, Film};
use tyndall::image::error_path;
use tyndall::record::{Circumstances, Seconds};
use tyndall::spectral::SpaceName;
use tyndall::table::{self, Rows};
use tyndall::{Error, Image, Look, Record, RunOptions, cube, picture};

use super::Job;
use crate::args::value::{FileKind, ImageFile};
use crate::exit::Failure;

/// Writes the results of a job.
pub struct Writer<'j> {
    job: &'j Job<'j>,
    threads: usize,
}

impl<'j> Writer<'j> {
    /// For a job that runs this way.
    pub fn new(job: &'j Job<'j>, run: &RunOptions) -> Self {
        Self { job, threads: tyndall::engine::Backend::width(&run.backend()) }
    }

    /// Everything: images, errors, films, the record. Tells how good the errors are, if there are any.
    pub fn write(&self, outcome: &Outcome) -> Result<Option<ErrorSummary>, Failure> {
        let film = &outcome.state.film;
        if film.samples() == 0 {
            tracing::warn!("no sample was taken: no image is written");
            return Ok(None);
        }
        // one file that cannot be written is no reason to lose the others
        let images = self.images(film);
        if let Ok(true) = images {
            tell_denoised(&self.job.files);
        }
        let films = self.films(outcome);
        images.and(films)?;
        let summary = film.summary();
        self.record(outcome, &summary).write(&self.job.names.run_json)?;
        Ok(Some(summary))
    }

    /// The images, with the errors beside an EXR: all that can be written. The record goes first, for it speaks of the images
    /// beside it. Tells whether a picture was denoised.
    pub fn images(&self, film: &Film) -> Result<bool, Error> {
        self.remove_record()?;
        let image = Image::of_film(film, &self.job.provenance)?;
        let threads = self.job.denoise().then_some(self.threads);
        let write = |file: &ImageFile| write_image(&image, &file.path, file.kind, threads);
        // all of them, before the first failure is told
        let written: Vec<Result<bool, Error>> = self.job.files.iter().map(write).collect();
        let denoised = written.into_iter().collect::<Result<Vec<bool>, Error>>()?;
        Ok(denoised.contains(&true))
    }

    fn films(&self, outcome: &Outcome) -> Result<(), Error> {
        let mut written = Ok(());
        for file in self.job.files.iter().filter(|f| f.kind == FileKind::Film) {
            if self.job.args.run.shard.is_some() && !outcome.state.position.is_finished() {
                tracing::warn!("{}: not written, the shard is not finished", file.path.display());
                continue;
            }
            let saved = shard::save(&file.path, &self.job.plan.job, &outcome.state);
            written = written.and(saved.map_err(Error::from));
        }
        written
    }

    fn remove_record(&self) -> Result<(), Error> {
        let path = &self.job.names.run_json;
        match std::fs::remove_file(path) {
            Err(e) if path.is_file() => Err(FileError::io(path, "write", e).into()),
            _ => Ok(()),
        }
    }

    fn record(&self, outcome: &Outcome, summary: &ErrorSummary) -> Record {
        let job = self.job;
        let [load, build] = job.plan.loaded.seconds;
        let position = &outcome.state.position;
        let circumstances = Circumstances {
            command: command_line(),
            scene: Some(scene_name(job.args.scene.as_deref())),
            seconds: Seconds { load, build, render: position.millis as f64 * 1e-3 },
            complete: outcome.end == End::Complete,
            threads: self.threads,
            samples: position.samples,
        };
        Record::new(&outcome.state.film, summary, &job.provenance, circumstances)
    }
}

fn scene_name(scene: Option<&Path>) -> String {
    let built_in = || format!("{} (built in)", tyndall::plan::BUILT_IN_NAME);
    scene.map_or_else(built_in, |path| path.display().to_string())
}

/// One image file; a film is none. Pictures for the eye are denoised where threads are given for it; tells whether
/// this was one.
///
/// # Errors
/// When the file cannot be written.
pub fn write_image(
    image: &Image,
    path: &Path,
    kind: FileKind,
    denoise: Option<usize>,
) -> Result<bool, Error> {
    match kind {
        FileKind::Exr => {
            let options = ExrOptions { parallel: false, ..ExrOptions::default() };
            write_exr(path, &image.values, &options)?;
            if let Some(errors) = &image.errors {
                write_exr(&error_path(path), errors, &options)?;
            }
        }
        FileKind::Png => return write_picture(image, path, denoise),
        FileKind::Csv => table::write(path, image, &Rows::All)?,
        FileKind::Netcdf => cube::write(path, image)?,
        FileKind::Film => {}
    }
    Ok(false)
}

fn write_picture(image: &Image, path: &Path, denoise: Option<usize>) -> Result<bool, Error> {
    let look = Look { denoise, ..Look::default() };
    let picture = picture(image, &look, SpaceName::Srgb).or_else(|error| {
        if denoise.is_none() {
            return Err(error);
        }
        tracing::warn!("{} is not denoised: {error}", path.display());
        picture(image, &Look::default(), SpaceName::Srgb)
    })?;
    let report = write_png(path, &picture.pixels, &picture.png())?;
    if picture.exposure != 0.0 {
        tracing::debug!("{}: exposure {} stops", path.display(), picture.exposure);
    }
    if report.non_finite > 0 {
        tracing::warn!("{}: {} pixels are not finite, shown in magenta", path.display(), report.non_finite);
    }
    Ok(picture.denoised)
}

/// Nobody shall take a denoised picture for the result.
pub fn tell_denoised(files: &[ImageFile]) {
    let named = |kind| files.iter().find(|f| f.kind == kind).map(|f| f.path.display());
    let Some(png) = named(FileKind::Png) else { return };
    match named(FileKind::Exr) {
        Some(exr) => tracing::info!("{png} is denoised, for looking at; {exr} holds the samples' means"),
        None => tracing::info!("{png} is denoised, for looking at; -o NAME.exr writes the samples' means"),
    }
}

/// The command as it was given, quoted for a shell.
pub fn command_line() -> String {
    std::env::args_os().map(|a| quoted(&a.to_string_lossy())).collect::<Vec<_>>().join(" ")
}

fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./:=,%+@".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::quoted;

    #[test]
    fn words_are_quoted_for_a_shell() {
        assert_eq!(quoted("a/b.pbrt"), "a/b.pbrt");
        assert_eq!(quoted("a b"), "'a b'");
        assert_eq!(quoted("it's"), r"'it'\''s'");
        assert_eq!(quoted(""), "''");
    }
}
