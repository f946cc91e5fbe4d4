//! `tyndall validate`.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::Args;

/// Arguments of `tyndall validate`.
#[derive(Args, Clone, Debug)]
#[command(
    long_about = "\
Render scenes with known answers, and compare.

Known answers come from solvers and formulas of radiative transfer that share nothing with this program. Scenes are \
swept in wavelength, one row of a table a band, and rendered by every integrator and spectral strategy that has no \
bias. Prints ours, the known answer, the standard error and the score z = (ours - known) / error by family, and the \
distribution of all scores; writes rows.csv and a page with charts, index.html. Ends with 1 when a score is beyond what \
chance explains (99.99 % of all runs pass).",
    after_help = "\
Examples:
  tyndall validate                                   some minutes
  tyndall validate --quick                           half a minute
  tyndall validate --family slab-flux --family sphere --rows
  tyndall validate --scene-dir cases                 the scenes and expected.csv, for other renderers"
)]
pub struct ValidateArgs {
    /// Every case in two ways only, few samples: half a minute
    #[arg(long, conflicts_with = "full")]
    pub quick: bool,
    /// Sixteen times the samples: an hour
    #[arg(long)]
    pub full: bool,
    /// This family only; may be repeated [default: all]
    #[arg(long, value_name = "NAME")]
    pub family: Vec<String>,
    /// Print every row, not only the worst ones of each family
    #[arg(long)]
    pub rows: bool,
    /// Folder of rows.csv and index.html
    #[arg(long, short, value_name = "DIR", default_value = "validate")]
    pub output: PathBuf,
    /// Write the scenes and their answers into a folder instead of rendering them
    #[arg(long, value_name = "DIR", conflicts_with_all = ["quick", "full", "rows", "output"])]
    pub scene_dir: Option<PathBuf>,
    /// Seed of all random numbers
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Threads [default: what the machine, its cgroup included, allows]
    #[arg(long, value_name = "N")]
    pub threads: Option<NonZeroUsize>,
}

#[cfg(test)]
mod tests {
    use super::super::Command;
    use super::super::tests::parse;

    #[test]
    fn depth_and_families() {
        let Ok(Command::Validate(v)) = parse("tyndall validate --quick --family sphere --family furnace")
        else {
            panic!("valid");
        };
        assert!(v.quick && !v.full && v.family == ["sphere", "furnace"]);
        assert!(parse("tyndall validate --quick --full").is_err());
        assert!(parse("tyndall validate --scene-dir x --quick").is_err());
    }
}
