//! What all commands that read a scene share: its source, its options, its warnings.

use std::collections::HashSet;
use std::io::Write as _;
use std::path::Path;

use tyndall::pbrt::{Diagnostic, Severity};
use tyndall::spectral::LambdaRange;
use tyndall::{Options, Source};

use crate::args::value::Range;
use crate::args::{LogArgs, LogFormat, SceneArgs};
use crate::exit::Failure;
use crate::log::Console;

/// The scene of a path, or the built-in one.
pub fn source(scene: Option<&Path>) -> Source<'_> {
    scene.map_or(Source::BuiltIn, Source::File)
}

/// The options of how a scene is read.
///
/// # Errors
/// When the spectral range cannot be.
pub fn reading(args: &SceneArgs) -> Result<Options, Failure> {
    let mut options = Options {
        strict: args.strict,
        set: args.overrides.iter().map(ToString::to_string).collect(),
        ..Options::default()
    };
    if let Some(range) = args.range {
        options.range = lambda_range(range)?;
    }
    Ok(options)
}

fn lambda_range(Range(range): Range) -> Result<LambdaRange, Failure> {
    LambdaRange::new(range.from as f32, range.to as f32).map_err(|e| Failure::of(e.into()))
}

/// Prints every warning and note once; with `strict`, a warning is a failure.
///
/// # Errors
/// With `strict`, when there is a warning.
pub fn tell(
    diagnostics: &[Diagnostic],
    strict: bool,
    log: &LogArgs,
    console: &Console,
) -> Result<(), Failure> {
    let mut told = HashSet::new();
    for diagnostic in diagnostics {
        if told.insert(diagnostic.to_string()) {
            tell_one(diagnostic, log, console);
        }
    }
    let warnings = diagnostics.iter().filter(|d| d.severity == Severity::Warning).count();
    if strict && warnings > 0 {
        return Err(Failure::input(
            format!("the scene has {warnings} warning{}, and --strict makes them errors", plural(warnings)),
            Some("mend the scene, or leave out --strict"),
        ));
    }
    Ok(())
}

const fn plural(n: usize) -> &'static str {
    if n == 1 { "" } else { "s" }
}

fn tell_one(d: &Diagnostic, log: &LogArgs, console: &Console) {
    if log.quiet {
        return;
    }
    if log.log == LogFormat::Plain {
        let hint = d.hint.as_deref().map_or_else(String::new, |h| format!("\nhint: {h}"));
        // nothing to be done if nobody reads it
        let _ = writeln!(console.clone(), "{d}{hint}");
        return;
    }
    let place = d.place.as_ref().map(|p| p.to_string());
    let (message, hint, place) = (d.message.as_str(), d.hint.as_deref(), place.as_deref());
    match d.severity {
        Severity::Warning => tracing::warn!(place, hint, "{message}"),
        Severity::Note => tracing::info!(place, hint, "{message}"),
    }
}
