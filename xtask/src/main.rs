//! The project's own tasks: `cargo xtask help` lists them.

mod bench;
mod hygiene;
mod layers;
mod sizes;
mod steps;
mod workspace;

use std::process::ExitCode;

const HELP: &str = "\
cargo xtask TASK

  test [STEP]...   everything that decides whether the project is sound, or only the named steps
  bench            error against time, memory, start-up, threads, growth and inner loops, beside Mitsuba 3, pbrt-v4 and
                   Embree 4 where they are installed, on a page in target/bench; `cargo xtask bench --help` tells all
  layers           which crate may use which, and the size of source files
  hygiene          no machine paths, no unfinished-work markers, no large files in the repository
  help             this text

Steps of `test`, in order: ";

/// What a task found wrong, one line each.
type Findings = Vec<String>;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (task, rest) =
        arguments.split_first().map_or(("help", &[][..]), |(task, rest)| (task.as_str(), rest));
    match task {
        "test" => steps::test(rest),
        "bench" => bench::bench(rest),
        "layers" => report(layers::check()),
        "hygiene" => report(hygiene::check()),
        "help" | "--help" | "-h" => {
            println!("{HELP}{}", steps::names().join(", "));
            ExitCode::SUCCESS
        }
        other => {
            eprintln!("error: no task `{other}`\nhint: `cargo xtask help` lists the tasks");
            ExitCode::from(2)
        }
    }
}

fn report(findings: Result<Findings, String>) -> ExitCode {
    match findings {
        Ok(findings) if findings.is_empty() => ExitCode::SUCCESS,
        Ok(findings) => {
            findings.iter().for_each(|finding| eprintln!("error: {finding}"));
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
