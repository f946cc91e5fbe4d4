//! A net under third-party decoders: a panic on a hostile file becomes an error about that file.

use crate::{FileError, Place, Result};
use std::{
    panic::{AssertUnwindSafe, catch_unwind},
    path::Path,
};

/// Runs a decoder. What it had built is dropped when it panics, so nothing half-built escapes.
pub(super) fn guarded<T>(path: &Path, what: &str, read: impl FnOnce() -> Result<T>) -> Result<T> {
    catch_unwind(AssertUnwindSafe(read)).unwrap_or_else(|_| {
        Err(FileError::malformed(
            path,
            Place::File,
            what,
            "contents that contradict each other",
            "the file is damaged; copy or export it again",
        ))
    })
}
