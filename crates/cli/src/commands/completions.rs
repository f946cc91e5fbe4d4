//! `tyndall completions`.

use clap::CommandFactory;

use super::print;
use crate::args::{Cli, CompletionsArgs};
use crate::exit::Failure;

/// Prints the script for a shell.
pub fn run(args: &CompletionsArgs) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "tyndall", &mut script);
    print::text(&String::from_utf8_lossy(&script))
}
