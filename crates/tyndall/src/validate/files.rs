//! Results on disk: `rows.csv` and `index.html`.

use super::{Report, page};
use crate::Error;
use std::path::Path;
use tyndall_files::atomic::write_bytes_atomic;

/// Writes both into a folder, which is made if it is not there.
///
/// # Errors
/// When the folder or a file cannot be written.
pub fn write(dir: &Path, report: &Report, command: &str) -> Result<(), Error> {
    std::fs::create_dir_all(dir).map_err(|e| {
        Error::options(
            format!("{}: cannot make the folder: {e}", dir.display()),
            Some("name another by -o DIR".into()),
        )
    })?;
    let (csv, html) = (report.csv(), page::html(report, command));
    write_bytes_atomic(&dir.join("rows.csv"), csv.as_bytes())?;
    write_bytes_atomic(&dir.join("index.html"), html.as_bytes())?;
    Ok(())
}
