//! `cargo xtask test`: every step that decides whether the project is sound, its time, and a summary.

use std::process::ExitCode;
use std::time::{Duration, Instant};

use crate::{Findings, hygiene, layers, workspace};

enum Action {
    /// `cargo` with these arguments and environment.
    Cargo(&'static [&'static str], &'static [(&'static str, &'static str)]),
    /// A check of our own.
    Check(fn() -> Result<Findings, String>),
}

struct Step {
    name: &'static str,
    action: Action,
    /// Of no use when the step of this name has failed.
    after: Option<&'static str>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Outcome {
    Passed,
    Failed,
    Skipped,
}

const fn cargo(name: &'static str, arguments: &'static [&'static str]) -> Step {
    Step { name, action: Action::Cargo(arguments, &[]), after: None }
}

const fn check(name: &'static str, check: fn() -> Result<Findings, String>) -> Step {
    Step { name, action: Action::Check(check), after: None }
}

/// Cheap steps first. Lint and documentation share the checked dependencies; tests are compiled once, optimised.
const STEPS: &[Step] = &[
    cargo("format", &["fmt", "--all", "--check"]),
    check("hygiene", hygiene::check),
    check("layers", layers::check),
    cargo("clippy", &["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"]),
    Step {
        name: "docs",
        action: Action::Cargo(&["doc", "--workspace", "--no-deps"], &[("RUSTDOCFLAGS", "-D warnings")]),
        after: None,
    },
    cargo("build", &["test", "--workspace", "--no-run"]),
    Step {
        name: "test",
        action: Action::Cargo(&["test", "--workspace", "--no-fail-fast"], &[("RUST_BACKTRACE", "1")]),
        after: Some("build"),
    },
];

/// Names of the steps, in order.
pub fn names() -> Vec<&'static str> {
    STEPS.iter().map(|step| step.name).collect()
}

/// Runs the steps called by name, or all of them.
pub fn test(wanted: &[String]) -> ExitCode {
    if let Some(stranger) = wanted.iter().find(|name| !names().contains(&name.as_str())) {
        eprintln!("error: no step `{stranger}`\nhint: the steps are {}", names().join(", "));
        return ExitCode::from(2);
    }
    let mut results: Vec<(&str, Outcome, Duration)> = Vec::new();
    for step in STEPS.iter().filter(|step| wanted.is_empty() || wanted.iter().any(|name| name == step.name)) {
        println!("\n=== {}", step.name);
        let start = Instant::now();
        let blocked =
            results.iter().any(|(name, outcome, _)| Some(*name) == step.after && *outcome != Outcome::Passed);
        let outcome = if blocked { Outcome::Skipped } else { run(&step.action) };
        results.push((step.name, outcome, start.elapsed()));
    }
    summarise(&results)
}

fn run(action: &Action) -> Outcome {
    let passed = match action {
        Action::Cargo(arguments, environment) => run_cargo(arguments, environment),
        Action::Check(check) => match check() {
            Ok(findings) => {
                findings.iter().for_each(|finding| println!("error: {finding}"));
                findings.is_empty()
            }
            Err(error) => {
                println!("error: {error}");
                false
            }
        },
    };
    if passed { Outcome::Passed } else { Outcome::Failed }
}

fn run_cargo(arguments: &[&str], environment: &[(&str, &str)]) -> bool {
    let mut command = workspace::cargo();
    // on CI a lock file that is not current is an error, not something to repair
    if std::env::var_os("CI").is_some() {
        command.arg("--locked");
    }
    command.args(arguments).envs(environment.iter().copied()).current_dir(workspace::root());
    println!("cargo {}", arguments.join(" "));
    match command.status() {
        Ok(status) => status.success(),
        Err(error) => {
            println!("error: cannot run cargo: {error}");
            false
        }
    }
}

fn summarise(results: &[(&str, Outcome, Duration)]) -> ExitCode {
    println!("\n=== summary");
    for (name, outcome, time) in results {
        let word = match outcome {
            Outcome::Passed => "passed",
            Outcome::Failed => "FAILED",
            Outcome::Skipped => "skipped",
        };
        println!("{name:<10} {word:<8} {:>8.1} s", time.as_secs_f64());
    }
    println!(
        "{:<10} {:<8} {:>8.1} s",
        "total",
        "",
        results.iter().map(|result| result.2).sum::<Duration>().as_secs_f64()
    );
    let count = |wanted| results.iter().filter(|result| result.1 == wanted).count();
    let (passed, failed, skipped) = (count(Outcome::Passed), count(Outcome::Failed), count(Outcome::Skipped));
    let skipped_text = if skipped > 0 { format!(", {skipped} skipped") } else { String::new() };
    println!("\n{passed} passed, {failed} failed{skipped_text}");
    if failed == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
