//! How the work is done: threads, checkpoints, shards.

use std::convert::Infallible;
use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::Conflict;
use crate::args::value::{Duration, Shard};

/// How the work is done.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Work")]
pub struct RunArgs {
    /// Threads [default: what the machine, its cgroup included, allows]
    #[arg(long, value_name = "N", value_parser = threads)]
    pub threads: Option<NonZeroUsize>,
    /// Instructions to use; every set gives the same bits
    #[arg(long, value_enum, value_name = "SET", default_value_t = InstructionSet::Auto)]
    pub isa: InstructionSet,
    /// Where the state goes that --resume starts from, or `off` [default: NAME.ckpt]
    #[arg(long, value_name = "FILE|off", value_parser = CheckpointFile::parse)]
    pub checkpoint: Option<CheckpointFile>,
    /// Time between checkpoints; 0s writes one after every piece of work, whatever that costs
    #[arg(long, value_name = "TIME", default_value = "60s", value_parser = Duration::parse_or_none)]
    pub checkpoint_every: Duration,
    /// Go on from the checkpoint of the same job, to the same bits as without an interruption
    #[arg(long)]
    pub resume: bool,
    /// Do the K-th of N parts of the work (K from 1) and write a film for `tyndall merge`
    #[arg(long, value_name = "K/N", value_parser = Shard::parse)]
    pub shard: Option<Shard>,
    /// Sample counts per pixel that a run with --until has learned, from its film (-o NAME.film); shards of one job
    /// share it
    #[arg(long, value_name = "FILE")]
    pub guide: Option<PathBuf>,
}

/// More threads than any machine runs at once.
const MAX_THREADS: usize = 4096;

fn threads(text: &str) -> Result<NonZeroUsize, String> {
    let number = text.parse().ok().filter(|n: &NonZeroUsize| n.get() <= MAX_THREADS);
    number.ok_or_else(|| format!("expected a number from 1 to {MAX_THREADS}, got `{text}`"))
}

/// Instructions to use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum InstructionSet {
    /// The fastest that this processor has
    #[default]
    Auto,
    /// None beyond those that every processor has
    Portable,
    /// AVX2 (x86-64)
    Avx2,
    /// AVX-512 (x86-64)
    Avx512,
}

/// Where checkpoints go.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CheckpointFile {
    /// Nowhere.
    Off,
    /// Into this file.
    File(PathBuf),
}

impl CheckpointFile {
    fn parse(text: &str) -> Result<Self, Infallible> {
        Ok(if text == "off" { Self::Off } else { Self::File(text.into()) })
    }
}

impl RunArgs {
    /// Refuses what cannot be combined.
    pub(super) fn check(&self) -> Result<(), Conflict> {
        if self.resume && self.checkpoint == Some(CheckpointFile::Off) {
            return Err(Conflict::new(
                "--resume with --checkpoint off: there is nothing to go on from",
                "name the checkpoint, or leave out --checkpoint for NAME.ckpt",
            ));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::render;
    use super::*;

    #[test]
    fn checkpoints() {
        let file = |options: &str| render(options).expect("valid").run.checkpoint;
        assert_eq!(file(""), None);
        assert_eq!(file("--checkpoint off"), Some(CheckpointFile::Off));
        assert_eq!(file("--checkpoint a.ckpt --resume"), Some(CheckpointFile::File("a.ckpt".into())));
        assert!(render("--checkpoint off --resume").is_err());
        assert_eq!(render("").expect("valid").run.checkpoint_every.0.as_secs(), 60);
    }

    #[test]
    fn threads_are_positive() {
        assert_eq!(render("--threads 3").expect("valid").run.threads, NonZeroUsize::new(3));
        for wrong in ["0", "-1", "x", "1000000", "4097"] {
            let error = render(&format!("--threads={wrong}")).expect_err(wrong);
            assert!(error.contains("from 1 to 4096"), "{error}");
        }
    }
}
