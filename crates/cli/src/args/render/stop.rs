//! When a render ends.

use clap::{Args, ValueEnum};

use crate::args::value::{Duration, Pixel, Target};

/// When a render ends: at whichever of the limits comes first.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "When to end (whichever comes first)")]
pub struct StopArgs {
    /// Samples per pixel [default: the scene's]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub spp: Option<u32>,
    /// Time of rendering, as 90s, 5m or 1h30m; ends on a whole round of samples
    #[arg(long, value_name = "TIME", value_parser = Duration::parse)]
    pub time: Option<Duration>,
    /// Error to reach: `rel=1%` in luminance, `rel=1%,bands` in every band
    ///
    /// `rel=1%` means that 95 % of the pixels have a standard error of at most 1 % of their luminance, or of a
    /// hundredth of the median luminance where they are darker than that.
    #[arg(long, value_name = "TARGET", value_parser = Target::parse)]
    pub until: Option<Target>,
    /// Let --until look at this pixel instead of the whole picture; may be repeated
    #[arg(long, value_name = "X,Y", value_parser = Pixel::parse, requires = "until")]
    pub probe: Vec<Pixel>,
    /// How standard errors are found [default: conservative, replicated with --until]
    #[arg(long, value_enum, value_name = "MODE")]
    pub errors: Option<ErrorMode>,
}

/// How standard errors are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ErrorMode {
    /// Plain variance over all samples of a pixel: an upper estimate
    Conservative,
    /// Variance between independent replicates: an interval that holds what it says
    Replicated,
}

impl StopArgs {
    /// The mode asked for, or the one that the other options imply.
    pub fn error_mode(&self) -> ErrorMode {
        let implied = if self.until.is_some() { ErrorMode::Replicated } else { ErrorMode::Conservative };
        self.errors.unwrap_or(implied)
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::render;
    use super::*;

    #[test]
    fn limits_go_together() {
        let stop =
            render("--spp 1024 --time 1h30m --until rel=1% --probe 3,4 --probe 5,6").expect("valid").stop;
        assert_eq!(stop.spp, Some(1024));
        assert_eq!(stop.time.map(|time| time.0.as_secs()), Some(5400));
        assert_eq!(stop.probe.len(), 2);
        assert_eq!(stop.error_mode(), ErrorMode::Replicated);
    }

    #[test]
    fn refusals() {
        assert!(render("--spp 0").is_err());
        assert!(render("--spp 4294967296").is_err());
        assert!(render("--probe 1,2").is_err(), "a probe without a target");
        assert_eq!(render("").expect("valid").stop.error_mode(), ErrorMode::Conservative);
    }
}
