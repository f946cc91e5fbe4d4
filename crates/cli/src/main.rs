//! The program `tyndall`.

use std::process::ExitCode;

use tyndall_cli::{args, commands, exit, log};

fn main() -> ExitCode {
    exit::keep_panics();
    // without it only a message is lost
    let _ = tyndall_cli::signal::survive_file_limits();
    let Some(request) = args::from_environment() else { return ExitCode::SUCCESS };
    let console = log::Console::stderr();
    log::start(&request.log, &console);
    exit::report(exit::guarded(|| commands::run(request.command, &request.log, &console)))
}
