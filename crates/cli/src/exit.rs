//! How the program ends: 0 done, 2 bad input or arguments, 130 interrupted, 1 else.

use std::process::ExitCode;

use miette::Report;

/// Why a command did not finish.
#[derive(Debug)]
#[non_exhaustive]
pub enum Failure {
    /// The user's input or arguments are at fault.
    Input(Report),
    /// A signal ended the run; what was done so far is written.
    Interrupted,
    /// Two images that were compared do not agree (`tyndall diff --exit-code`).
    Disagreement,
    /// Anything else: a disk is full, a folder is read-only.
    Other(Report),
}

impl Failure {
    /// The exit code that the front page promises.
    pub const fn code(&self) -> u8 {
        match self {
            Self::Input(_) => 2,
            Self::Interrupted => 130,
            Self::Disagreement | Self::Other(_) => 1,
        }
    }
}

/// Prints the failure, if there is one, and turns the result into an exit code.
pub fn report(result: Result<(), Failure>) -> ExitCode {
    let Err(failure) = result else { return ExitCode::SUCCESS };
    if let Failure::Input(report) | Failure::Other(report) = &failure {
        // not `eprintln!`, which panics when nobody listens any more
        let _ = std::io::Write::write_fmt(&mut std::io::stderr(), format_args!("{report:?}"));
    }
    ExitCode::from(failure.code())
}
