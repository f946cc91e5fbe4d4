//! What each subcommand does.

mod completions;
mod develop;
mod diff;
mod doubts;
mod info;
mod merge;
mod paper;
mod plot;
mod print;
mod render;
mod scene;
mod validate;

use crate::args::{Command, LogArgs};
use crate::exit::Failure;
use crate::log::Console;

/// Does what the command line asks for.
///
/// # Errors
/// Whatever keeps the command from its end, with the exit code that belongs to it.
pub fn run(command: Command, log: &LogArgs, console: &Console) -> Result<(), Failure> {
    match command {
        Command::Render(args) => render::run(&args, log, console),
        Command::Completions(args) => completions::run(&args),
        Command::Merge(args) => merge::run(&args),
        Command::Develop(args) => develop::run(&args),
        Command::Diff(args) => diff::run(&args),
        Command::Paper(args) => paper::run(&args, log, console),
        Command::Info(args) => info::run(&args, log, console),
        Command::Plot(args) => plot::run(&args),
        Command::Validate(args) => validate::run(&args, log, console),
    }
}
