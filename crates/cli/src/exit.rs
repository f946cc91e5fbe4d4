//! How the program ends: 0 done, 2 bad input or arguments, 130 interrupted, 1 else.

use std::fmt::Write as _;
use std::io::{IsTerminal, Write as _};
use std::process::ExitCode;
use std::sync::Mutex;

use miette::{Report, miette};
use tyndall::Error;
use tyndall::engine::EngineError;
use tyndall::files::FileError;

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

    /// Bad input, with what to do about it.
    pub fn input(what: impl Into<String>, hint: Option<&str>) -> Self {
        Self::Input(report_of(&what.into(), hint))
    }

    /// The same failure, with more to do about it.
    pub fn with_hint(self, more: &str) -> Self {
        let add = |report: Report| {
            let hint = report.help().map_or_else(String::new, |help| format!("{help}; "));
            report_of(&report.to_string(), Some(&(hint + more)))
        };
        match self {
            Self::Other(report) => Self::Other(add(report)),
            other => other,
        }
    }

    /// The failure that an error of the library amounts to.
    pub fn of(error: Error) -> Self {
        let input = is_input(&error);
        let report = match error {
            Error::Scene(scene) => Report::new(*scene),
            Error::Options { what, hint } => report_of(&what, hint.as_deref()),
            other => split(&other.to_string()),
        };
        if input { Self::Input(report) } else { Self::Other(report) }
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::of(error)
    }
}

/// Whether the user's input or arguments are at fault, and not the machine or the program.
fn is_input(error: &Error) -> bool {
    match error {
        Error::Engine(e) => match e {
            EngineError::Io { action, .. } => *action == "read",
            EngineError::Worker { .. } | EngineError::Backend { .. } => false,
            _ => true,
        },
        Error::File(e) => match e {
            FileError::Io { action, .. } => action.starts_with("open") || action.starts_with("read"),
            FileError::BadImage { .. } => false,
            _ => true,
        },
        _ => true,
    }
}

/// Libraries below put their hint on a line of its own.
fn split(message: &str) -> Report {
    match message.split_once("\n") {
        Some((what, rest)) if rest.trim_start().starts_with("hint: ") => {
            report_of(what, Some(rest.trim_start().trim_start_matches("hint: ")))
        }
        _ => report_of(message, None),
    }
}

fn report_of(what: &str, hint: Option<&str>) -> Report {
    match hint {
        Some(hint) => miette!(help = hint.to_owned(), "{what}"),
        None => miette!("{what}"),
    }
}

/// Prints the failure, if there is one, and turns the result into an exit code.
pub fn report(result: Result<(), Failure>) -> ExitCode {
    let Err(failure) = result else { return ExitCode::SUCCESS };
    if let Failure::Input(report) | Failure::Other(report) = &failure {
        let stderr = std::io::stderr();
        let text = if stderr.is_terminal() { format!("{report:?}") } else { plain(report) };
        // not `eprintln!`, which panics when nobody listens any more
        let _ = writeln!(stderr.lock(), "{}", text.trim_end());
    }
    ExitCode::from(failure.code())
}

/// `fog.pbrt:12:9: what is wrong`, then `hint: what to do`.
fn plain(report: &Report) -> String {
    let mut text = report.to_string();
    if report.source_code().is_none() && !starts_with_place(&text) {
        text.insert_str(0, "error: ");
    }
    if let Some(hint) = report.help() {
        // writing to a string cannot fail
        let _ = write!(text, "\nhint: {hint}");
    }
    text
}

/// Errors about a file start with its name, as those of compilers do.
fn starts_with_place(text: &str) -> bool {
    text.split_once(": ").is_some_and(|(file, _)| !file.contains(' ') && file.contains('.'))
}

/// What the last panic had to say.
static PANIC: Mutex<Option<String>> = Mutex::new(None);

/// Keeps the messages of panics: whoever catches one decides what of it is told.
pub fn keep_panics() {
    std::panic::set_hook(Box::new(|info| {
        let place = info.location().map_or_else(String::new, |l| format!(" at {}:{}", l.file(), l.line()));
        let text = info.payload_as_str().unwrap_or("no message");
        if let Ok(mut last) = PANIC.lock() {
            *last = Some(format!("{text}{place}"));
        }
    }));
}

/// Runs a command; a panic in it becomes a failure with a message for people.
///
/// # Errors
/// Those of the command, and [`Failure::Other`] for a panic.
pub fn guarded(command: impl FnOnce() -> Result<(), Failure>) -> Result<(), Failure> {
    std::panic::catch_unwind(std::panic::AssertUnwindSafe(command)).unwrap_or_else(|_| {
        let last = PANIC.lock().ok().and_then(|mut p| p.take()).unwrap_or_else(|| "no message".into());
        let hint = "this is a bug in tyndall: please report it with the command and the scene";
        Err(Failure::Other(report_of(&format!("internal error: {last}"), Some(hint))))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plain_reports_start_with_the_place_or_say_error() {
        let Failure::Input(report) = Failure::input("a is not b", Some("make it b")) else { panic!("input") };
        assert_eq!(plain(&report), "error: a is not b\nhint: make it b");
        let from_below = split("fog.ply:12: expected x, got y\n  hint: export again");
        assert_eq!(plain(&from_below), "fog.ply:12: expected x, got y\nhint: export again");
    }

    #[test]
    fn panics_become_failures() {
        let result = guarded(|| panic!("on purpose"));
        let Err(Failure::Other(report)) = result else { panic!("a failure") };
        assert!(report.to_string().starts_with("internal error: "));
    }
}
