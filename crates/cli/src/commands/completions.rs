//! `tyndall completions`.

use std::io::{self, ErrorKind, Write};

use clap::CommandFactory;
use miette::miette;

use crate::args::{Cli, CompletionsArgs};
use crate::exit::Failure;

/// Prints the script for a shell.
pub fn run(args: &CompletionsArgs) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "tyndall", &mut script);
    match io::stdout().write_all(&script) {
        // the reader has seen enough
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        result => result.map_err(|error| Failure::Other(miette!("cannot write to standard output: {error}"))),
    }
}
