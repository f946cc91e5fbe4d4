//! How many bytes of memory a file of a given size can justify.

use crate::{FileError, Result};
use std::path::Path;

/// Deflate's largest expansion: a 258-byte match in two bits, 1032 : 1 (Deutsch, RFC 1951, 1996).
pub(crate) const DEFLATE_RATIO: u64 = 1032;

/// Anything below this many bytes is granted without looking at the file's size.
const SMALL: u128 = 1 << 20;

/// Refuses `announced` bytes of `what` when a file of `file_bytes` bytes, each of which can stand for at
/// most `ratio` bytes, cannot hold them. Called before any allocation of that size.
pub(crate) fn justify(
    path: &Path,
    what: &'static str,
    announced: u128,
    file_bytes: u64,
    ratio: u64,
) -> Result<()> {
    let justified = u128::from(file_bytes) * u128::from(ratio);
    if announced <= justified.max(SMALL) {
        return Ok(());
    }
    Err(FileError::Oversized { path: path.to_path_buf(), what, announced, justified, file_bytes })
}
