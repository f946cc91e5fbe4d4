//! `tyndall paper`.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::Args;

/// Reproduces the figures of Wang and Chern (2001): pictures, plots and tables on a page that stands alone.
///
/// Renders keep checkpoints in the folder: the same command goes on after an interruption and repeats nothing that is
/// finished.
#[derive(Args, Clone, Debug)]
pub struct PaperArgs {
    /// Where page, tables and scenes go
    #[arg(short, long, value_name = "DIR", default_value = "paper")]
    pub output: PathBuf,
    /// About a minute: smaller pictures, more noise
    #[arg(long, conflicts_with = "full")]
    pub quick: bool,
    /// The paper's 12100 samples per pixel and wavelength, by its algorithm alone: hours
    #[arg(long)]
    pub full: bool,
    /// Threads [default: what the machine and its cgroup allow]
    #[arg(long, value_name = "N")]
    pub threads: Option<NonZeroUsize>,
}
