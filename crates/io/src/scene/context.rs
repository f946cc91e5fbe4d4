//! What all readers of directives share.

use super::files::FoundFile;
use std::{cell::RefCell, path::PathBuf};
use tyndall_pbrt::{Diagnostics, Error, ErrorKind, ParamSet, Resolver, Text};
use tyndall_spectral::{Curve, LambdaRange, SpectralError};

/// Range of the job, rules, and where warnings go.
#[derive(Clone, Copy, Debug)]
pub struct Context<'a> {
    /// Wavelengths that the film will see.
    pub range: LambdaRange,
    /// Warnings about tables become errors.
    pub strict: bool,
    /// Warnings.
    pub warnings: &'a Diagnostics,
    /// Finds files.
    pub resolver: &'a Resolver,
    /// Files that were found, for the scene's hash.
    pub files: &'a RefCell<Vec<FoundFile>>,
}

/// Turns any error of a model's constructor into one at a directive.
pub fn at(params: &ParamSet, e: impl std::fmt::Display) -> Error {
    params.error(format!("{}: {e}", params.owner()))
}

/// The error of a value at a parameter.
pub fn refuse(params: &ParamSet, name: &str, expected: &str, got: impl std::fmt::Display) -> Error {
    params.error_at(name, expected, &got.to_string())
}

impl Context<'_> {
    /// The file named by `text`, a value of parameter `name`.
    pub fn file(&self, params: &ParamSet, name: &str, text: &Text) -> Result<PathBuf, Error> {
        let place = params.value_place(name);
        let beside = place.source.path().and_then(|p| p.parent()).map(PathBuf::from);
        match self.resolver.find(text, beside.as_deref()) {
            Ok(found) => {
                if let Some(note) = found.note {
                    self.warnings.note(place, note);
                }
                self.files.borrow_mut().push(FoundFile::new(found.path.clone()));
                Ok(found.path)
            }
            Err(missing) => {
                let kind = ErrorKind::FileNotFound { path: text.as_str().into(), tried: missing.list() };
                Err(Error::new(kind, place))
            }
        }
    }

    /// Warns of, or with `strict` refuses, a table that does not cover the job's range.
    pub fn check_range(&self, params: &ParamSet, name: &str, curve: &Curve) -> Result<(), Error> {
        match curve.check_range(self.range) {
            Ok(None) => Ok(()),
            // who says how to go on beyond the table knows that it ends
            Ok(Some(_)) if params.contains("extrapolate") => Ok(()),
            Ok(Some(gap)) if !self.strict => {
                params.warn_at(name, format!("{name}: {gap}"), self.warnings);
                Ok(())
            }
            Ok(Some(gap)) => Err(params.error(format!("{name}: {gap} (--strict)"))),
            Err(e) => {
                let e: SpectralError = e;
                let hint = "give values over the whole range, or \"string extrapolate\" \"hold\" or \"zero\"";
                Err(params.error(format!("{name}: {e}")).hint(hint))
            }
        }
    }

    /// Marks what a reader left over: a warning each, and unsupported in the inventory.
    pub fn finish(&self, params: &ParamSet, known: &[&str]) {
        params.warn_unused(known, self.warnings);
        params.unsupported_rest("not a parameter of this class");
    }
}
