//! `tyndall plot`.

use std::path::PathBuf;

use clap::Args;
use tyndall::plot::Subject;

use super::SceneArgs;

/// Arguments of `tyndall plot`.
#[derive(Args, Clone, Debug)]
#[command(
    long_about = "\
Draw curves as SVG.

Of a scene's media: coefficients, albedo and mean cosine, mean free path, and the phase function as a polar plot. Of a \
spectrum: its values, from a file of pairs or by a name that scenes know. Of a pixel of a spectral image: its bands, \
with error bars where NAME.error.exr lies beside it.",
    after_help = "\
Examples:
  tyndall plot fog.pbrt:mist            fog.mist.svg
  tyndall plot stdillum-D65 -o d65.svg
  tyndall plot fog.exr@10,20            fog.10-20.svg"
)]
pub struct PlotArgs {
    /// SCENE.pbrt, SCENE.pbrt:MEDIUM, the file or name of a spectrum, or IMAGE.exr@x,y
    #[arg(value_name = "WHAT", value_parser = Subject::parse)]
    pub subject: Subject,
    /// Where the drawing goes [default: a name made from WHAT]
    #[arg(long, short, value_name = "FILE.svg")]
    pub output: Option<PathBuf>,
    /// Replace an existing file
    #[arg(long)]
    pub force: bool,
    /// How a scene is read.
    #[command(flatten)]
    pub reading: SceneArgs,
}

#[cfg(test)]
mod tests {
    use super::super::Command;
    use super::super::tests::parse;

    #[test]
    fn subjects() {
        let Ok(Command::Plot(plot)) = parse("tyndall plot fog.exr@1,2 -o x.svg --range 400:700") else {
            panic!("valid");
        };
        assert_eq!(plot.output.expect("given").as_os_str(), "x.svg");
        assert!(plot.reading.range.is_some());
        assert!(parse("tyndall plot").is_err() && parse("tyndall plot fog.exr@1").is_err());
    }
}
