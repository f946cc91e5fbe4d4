//! `tyndall diff`.

use std::path::PathBuf;

use clap::Args;

use super::value::{fraction, positive};

/// Arguments of `tyndall diff`.
#[derive(Args, Clone, Debug)]
#[command(
    long_about = "\
Compare two images, with their errors where they are known.

Prints MSE, RMSE, relMSE and bias, overall and per channel or band. Where the standard errors of an image are known \
(NAME.error.exr beside it, or a film) it adds z-scores over blocks of pixels and a verdict whether the two agree.",
    after_help = "\
Examples:
  tyndall diff ours.exr reference.exr
  tyndall diff --exit-code --alpha 0.001 a.exr b.exr && echo same"
)]
pub struct DiffArgs {
    /// The image in question (EXR or film)
    #[arg(value_name = "A")]
    pub a: PathBuf,
    /// The image to compare with; relMSE divides by it
    #[arg(value_name = "B")]
    pub b: PathBuf,
    /// Side of the blocks of pixels that are tested as one
    #[arg(long, value_name = "PIXELS", default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..))]
    pub block: u32,
    /// Probability of calling two images different that are the same, over all tests together
    #[arg(long, value_name = "PROBABILITY", default_value_t = 0.01, value_parser = fraction)]
    pub alpha: f64,
    /// Compare B with this many times A (to allow for different units of two renderers)
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = positive)]
    pub scale: f64,
    /// End with 1 if the images do not agree
    #[arg(long)]
    pub exit_code: bool,
    /// Print one JSON object instead of a table
    #[arg(long)]
    pub json: bool,
}

#[cfg(test)]
mod tests {
    use super::super::Command;
    use super::super::tests::parse;

    #[test]
    fn two_images() {
        let Ok(Command::Diff(diff)) = parse("tyndall diff a.exr b.exr --alpha 0.001 --json") else {
            panic!("valid");
        };
        assert_eq!(
            (diff.block, diff.alpha, diff.scale, diff.exit_code, diff.json),
            (8, 0.001, 1.0, false, true)
        );
        assert!(parse("tyndall diff a.exr").is_err(), "one image only");
        assert!(parse("tyndall diff a.exr b.exr --block 0").is_err());
        assert!(parse("tyndall diff a.exr b.exr --alpha 1").is_err());
        assert!(parse("tyndall diff a.exr b.exr --scale -1").is_err());
    }
}
