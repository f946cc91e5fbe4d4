//! The command line: one file per subcommand, one per kind of value.
//!
//! Parsing ends in plain structs; what cannot be combined is refused here, with the reason.

mod completions;
mod develop;
mod diff;
mod info;
mod merge;
mod paper;
mod plot;
mod render;
mod scene;
mod validate;
pub mod value;

use clap::error::ErrorKind;
use clap::{Args, CommandFactory, Parser, Subcommand, ValueEnum};

pub use completions::CompletionsArgs;
pub use develop::{DevelopArgs, DevelopSpace};
pub use diff::DiffArgs;
pub use info::InfoArgs;
pub use merge::MergeArgs;
pub use paper::PaperArgs;
pub use plot::PlotArgs;
pub use render::{
    BUILT_IN_SCENE, CheckpointFile, ErrorMode, InstructionSet, Integrator, LightArgs, Names, OutputArgs,
    RenderArgs, ReplayArgs, RunArgs, SpectralStrategy, StopArgs, Switch, WavelengthPdf, WavelengthRule,
};
pub use scene::SceneArgs;
pub use validate::ValidateArgs;

const ABOUT: &str = "The true colour of light in fog, smoke, cloud and water";
const LONG_ABOUT: &str = "\
The true colour of light in fog, smoke, cloud and water.

Tyndall is a spectral Monte Carlo renderer whose absorption, scattering, emission and phase functions depend on \
wavelength, and whose every number comes with its unit and its error. It reads scenes of pbrt-v4.";
const AFTER: &str = "\
Exit codes: 0 done, 2 bad input or arguments, 130 interrupted (image and checkpoint written), 1 anything else.

`tyndall render` without a scene renders a built-in box of fog. `tyndall help COMMAND` tells all about a command.";

/// The whole command line.
#[derive(Debug, Parser)]
#[command(name = "tyndall", version, about = ABOUT, long_about = LONG_ABOUT, after_help = AFTER, max_term_width = 110)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Option<Command>,
    /// What to tell meanwhile.
    #[command(flatten)]
    pub log: LogArgs,
}

/// The subcommands.
#[derive(Debug, Subcommand)]
#[non_exhaustive]
pub enum Command {
    /// Render a scene, or the built-in box of fog
    Render(Box<RenderArgs>),
    /// Join the films of all shards of one job
    Merge(MergeArgs),
    /// Turn a film or EXR into a picture: exposure, white point, one band, false colour
    Develop(DevelopArgs),
    /// Compare two images, with their errors where they are known
    Diff(DiffArgs),
    /// Tell what is in a scene, and what of it is used
    Info(InfoArgs),
    /// Reproduce the figures of Wang and Chern (2001)
    Paper(PaperArgs),
    /// Draw curves of a medium, a spectrum or a pixel as SVG
    Plot(PlotArgs),
    /// Render scenes with known answers, and compare
    Validate(ValidateArgs),
    /// Print a script that completes commands in your shell
    Completions(CompletionsArgs),
}

/// Options of every subcommand.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Messages")]
pub struct LogArgs {
    /// Form of messages and progress on standard error
    #[arg(long, global = true, value_enum, value_name = "FORM", default_value_t = LogFormat::Plain)]
    pub log: LogFormat,
    /// Print errors only: no progress, no notes, no warnings
    #[arg(long, short, global = true)]
    pub quiet: bool,
}

/// Form of the log.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LogFormat {
    /// Lines for people
    Plain,
    /// One JSON object a line
    Json,
}

/// What the command line asks for.
#[derive(Debug)]
pub struct Request {
    /// What to do.
    pub command: Command,
    /// What to tell meanwhile.
    pub log: LogArgs,
}

/// Reads the process's arguments. `None`: help was asked for and is printed.
///
/// Ends the process with 2 if they are wrong, with 0 after `--help` and `--version`.
pub fn from_environment() -> Option<Request> {
    let cli = Cli::parse();
    let Some(command) = cli.command else {
        // a short help, as `-h` gives it; nothing to be done if nobody reads it
        let _ = Cli::command().print_help();
        return None;
    };
    if let Err(conflict) = check(&command) {
        conflict.exit();
    }
    Some(Request { command, log: cli.log })
}

/// Refuses what each option allows but the whole does not.
fn check(command: &Command) -> Result<(), clap::Error> {
    let (name, checked) = match command {
        Command::Render(render) => ("render", render.check()),
        Command::Develop(develop) => ("develop", develop.check()),
        Command::Merge(merge) => ("merge", merge.check()),
        _ => return Ok(()),
    };
    checked.map_err(|conflict| {
        let mut program = Cli::command();
        // only a built command knows the whole of its usage line
        program.build();
        let command = program.find_subcommand_mut(name).expect("it was parsed");
        command
            .error(ErrorKind::ArgumentConflict, format!("{}\n\n  hint: {}", conflict.reason, conflict.hint))
    })
}

/// Options that cannot be combined.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Conflict {
    /// Why not.
    pub reason: String,
    /// What to do instead.
    pub hint: String,
}

impl Conflict {
    fn new(reason: impl Into<String>, hint: impl Into<String>) -> Self {
        Self { reason: reason.into(), hint: hint.into() }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Parses and checks a command line without ending the process.
    pub(crate) fn parse(line: &str) -> Result<Command, String> {
        let cli = Cli::try_parse_from(line.split_whitespace()).map_err(|error| error.to_string())?;
        let command = cli.command.ok_or("no command")?;
        check(&command).map_err(|error| error.to_string())?;
        Ok(command)
    }

    #[test]
    fn definitions_are_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn every_option_has_a_help_text() {
        for command in Cli::command().get_subcommands() {
            for argument in command.get_arguments() {
                assert!(argument.get_help().is_some(), "{} {}", command.get_name(), argument.get_id());
            }
        }
    }

    #[test]
    fn log_options_stand_anywhere() {
        for line in ["tyndall --log json --quiet render", "tyndall render --log json --quiet"] {
            let cli = Cli::try_parse_from(line.split_whitespace()).expect("valid");
            assert_eq!((cli.log.log, cli.log.quiet), (LogFormat::Json, true));
        }
    }
}
