//! `tyndall merge`.

use std::path::PathBuf;

use clap::Args;

use super::Conflict;
use super::render::needs_picture;
use super::value::ImageFile;

/// Arguments of `tyndall merge`.
#[derive(Args, Clone, Debug)]
#[command(
    long_about = "\
Join the films of all shards of one job.

The result has the same bits as one run without shards, in whatever order the films are given. A film that stands \
twice, one that is missing and one of another job are refused by name.",
    after_help = "\
Example, three machines and one picture:
  tyndall render fog.pbrt --shard 1/3      (on each machine its own: 1/3, 2/3, 3/3)
  tyndall merge fog.1-of-3.film fog.2-of-3.film fog.3-of-3.film -o fog.exr"
)]
pub struct MergeArgs {
    /// The films, one of each shard
    #[arg(value_name = "FILM", required = true)]
    pub films: Vec<PathBuf>,
    /// Where the result goes; may be repeated (.exr, .png, .csv, .nc)
    #[arg(long, short, value_name = "FILE", required = true, value_parser = ImageFile::parse)]
    pub output: Vec<ImageFile>,
    /// Replace results of another job
    #[arg(long)]
    pub force: bool,
    /// Take the noise out of pictures (.png), by the standard errors; numbers stay as they are
    #[arg(long)]
    pub denoise: bool,
}

impl MergeArgs {
    /// Refuses what cannot be combined.
    pub(super) fn check(&self) -> Result<(), Conflict> {
        if self.denoise { needs_picture(&self.output) } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Command;
    use super::super::tests::parse;

    #[test]
    fn films_and_outputs() {
        let Ok(Command::Merge(merge)) = parse("tyndall merge a.film b.film -o x.exr -o x.png") else {
            panic!("valid");
        };
        assert_eq!((merge.films.len(), merge.output.len(), merge.force), (2, 2, false));
        assert!(parse("tyndall merge -o x.exr").is_err(), "no film");
        assert!(parse("tyndall merge a.film").is_err(), "no output");
        assert!(parse("tyndall merge a.film -o x.exr --denoise").is_err(), "no picture");
        assert!(parse("tyndall merge a.film -o x.png --denoise").is_ok());
    }
}
