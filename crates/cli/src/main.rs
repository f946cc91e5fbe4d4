//! The program `tyndall`.

use std::process::ExitCode;

use tyndall_cli::{args, commands, exit, log};

fn main() -> ExitCode {
    let Some(cli) = args::from_environment() else { return ExitCode::SUCCESS };
    let console = log::Console::stderr();
    log::start(&cli.log, &console);
    exit::report(commands::run(cli.command, &console))
}
