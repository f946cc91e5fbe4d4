//! `tyndall plot`.

use std::path::PathBuf;

use tyndall::files::atomic::write_bytes_atomic;
use tyndall::{Error, plot::plot};

use super::{print, scene};
use crate::args::PlotArgs;
use crate::exit::Failure;

/// Draws curves.
pub fn run(args: &PlotArgs) -> Result<(), Failure> {
    let path = args.output.clone().unwrap_or_else(|| PathBuf::from(args.subject.file_name()));
    if path.extension().is_none_or(|e| e != "svg") {
        return Err(Failure::input(
            format!("{}: drawings are written as .svg", path.display()),
            Some("let the name end with .svg"),
        ));
    }
    if path.exists() && !args.force {
        return Err(Failure::input(
            format!("{}: is there already", path.display()),
            Some("name another file by -o, or replace it with --force"),
        ));
    }
    let svg = plot(&args.subject, &scene::reading(&args.reading)?)?;
    write_bytes_atomic(&path, svg.as_bytes()).map_err(Error::from)?;
    print::text(&format!("{}\n", path.display()))
}
