//! Results on standard output.

use std::io::{self, ErrorKind, Write};

use miette::miette;

use crate::exit::Failure;

/// Prints a text.
///
/// # Errors
/// When standard output refuses it; a reader that has seen enough is no error.
pub fn text(text: &str) -> Result<(), Failure> {
    match io::stdout().write_all(text.as_bytes()).and_then(|()| io::stdout().flush()) {
        Err(e) if e.kind() == ErrorKind::BrokenPipe => Ok(()),
        result => result.map_err(|e| Failure::Other(miette!("cannot write to standard output: {e}"))),
    }
}

/// Prints a value as one JSON object.
///
/// # Errors
/// As [`text`].
pub fn json(value: &impl serde::Serialize) -> Result<(), Failure> {
    let mut line = serde_json::to_string_pretty(value)
        .map_err(|e| Failure::Other(miette!("cannot write the result as JSON: {e}")))?;
    line.push('\n');
    text(&line)
}
