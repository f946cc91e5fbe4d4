//! What each subcommand does.

mod completions;

use miette::miette;

use crate::args::Command;
use crate::exit::Failure;
use crate::log::Console;

/// Does what the command line asks for.
///
/// # Errors
/// Whatever keeps the command from its end, with the exit code that belongs to it.
pub fn run(command: Command, _console: &Console) -> Result<(), Failure> {
    match command {
        Command::Completions(args) => completions::run(&args),
        other => Err(Failure::Other(miette!("this build has no `{}` yet", name(&other)))),
    }
}

const fn name(command: &Command) -> &'static str {
    match command {
        Command::Render(_) => "render",
        Command::Merge(_) => "merge",
        Command::Develop(_) => "develop",
        Command::Diff(_) => "diff",
        Command::Info(_) => "info",
        Command::Completions(_) => "completions",
    }
}
