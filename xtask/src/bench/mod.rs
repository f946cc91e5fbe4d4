//! `cargo xtask bench`: what the techniques buy, what inner loops cost, how cost grows, and other renderers beside ours.
//!
//! This task builds and calls; the example `bench` of the crate `tyndall` measures and reports.

mod embree;
mod mitsuba;
mod options;

use options::{HELP, Wanted};
use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, ExitCode},
};

use crate::workspace;

/// Which stages of the example take the program `tyndall`.
const WITH_PROGRAM: [&str; 3] = ["start", "threads", "growth"];

/// Runs the benchmark.
pub fn bench(arguments: &[String]) -> ExitCode {
    let wanted = match Wanted::parse(arguments) {
        Ok(wanted) => wanted,
        Err(error) => {
            eprintln!("error: {error}");
            return ExitCode::from(2);
        }
    };
    if wanted.help {
        println!("{HELP}");
        return ExitCode::SUCCESS;
    }
    match all(&wanted) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Programs and folder of a run.
struct Bench<'w> {
    wanted: &'w Wanted,
    /// Where programs and `examples/` are.
    built: PathBuf,
    /// Where everything is written.
    out: PathBuf,
}

fn all(wanted: &Wanted) -> Result<(), String> {
    let built = wanted.built.clone().map_or_else(build, Ok)?;
    let out = wanted.out.clone().unwrap_or_else(|| workspace::root().join("target/bench"));
    let bench = Bench { wanted, built: absolute(&built)?, out };
    fs::create_dir_all(&bench.out).map_err(|e| format!("{}: {e}", bench.out.display()))?;
    if wanted.only.is_empty() {
        // a whole run is a new report; single stages go into the old one
        let lines = bench.lines();
        fs::write(&lines, "").map_err(|e| format!("{}: {e}", lines.display()))?;
    }
    if wanted.peers {
        mitsuba::install()?;
    }
    bench.stage("scenes")?;
    // one renderer that fails does not cost the hours of the others
    let mut failed = Vec::new();
    for stage in options::STAGES.into_iter().filter(|s| *s != "report" && wanted.runs(s)) {
        println!("\n=== {stage}");
        if let Err(error) = bench.measure(stage) {
            eprintln!("error: {error}");
            failed.push(stage);
        }
    }
    bench.stage("report")?;
    println!("\n{} and bench.json, bench.md beside it", bench.out.join("bench.html").display());
    if failed.is_empty() { Ok(()) } else { Err(format!("these stages failed: {}", failed.join(", "))) }
}

impl Bench<'_> {
    fn measure(&self, stage: &str) -> Result<(), String> {
        match stage {
            "mitsuba" => mitsuba::pictures(self),
            "rays" => rays(self),
            "start" => self.stage(stage).and_then(|()| mitsuba::starts(self)),
            _ => self.stage(stage),
        }
    }

    /// A stage of the example.
    fn stage(&self, stage: &str) -> Result<(), String> {
        let mut command = Command::new(self.built.join("examples/bench"));
        command.arg(stage).arg(&self.out).args(&self.wanted.more);
        command.args(self.wanted.quick.then_some("--quick"));
        self.wanted.scenes.iter().for_each(|name| {
            command.args(["--scene", name]);
        });
        if WITH_PROGRAM.contains(&stage) {
            command.arg("--program").arg(self.built.join("tyndall"));
        }
        run(&mut command)
    }

    /// Where results go.
    fn lines(&self) -> PathBuf {
        self.out.join("measured.jsonl")
    }

    /// Appends what another program printed; only its lines of JSON.
    fn keep(&self, printed: &str) -> Result<(), String> {
        let path = self.lines();
        let old = fs::read_to_string(&path).unwrap_or_default();
        let new: String =
            printed.lines().filter(|line| line.starts_with('{')).map(|line| format!("{line}\n")).collect();
        fs::write(&path, old + &new).map_err(|e| format!("{}: {e}", path.display()))
    }
}

/// Builds all programs, optimised; their folder.
fn build() -> Result<PathBuf, String> {
    let programs: [&[&str]; 3] = [
        &["-p", "tyndall-cli", "--bin", "tyndall"],
        &["-p", "tyndall", "--example", "bench"],
        &["-p", "tyndall-geometry", "--example", "rays"],
    ];
    for program in programs {
        let mut command = workspace::cargo();
        run(command.args(["build", "--release"]).args(program).current_dir(workspace::root()))?;
    }
    let mut metadata = workspace::cargo();
    let text = workspace::output(metadata.args(["metadata", "--no-deps", "--format-version", "1"]))?;
    let metadata: serde_json::Value =
        serde_json::from_str(&text).map_err(|e| format!("`cargo metadata`: {e}"))?;
    let target = metadata["target_directory"].as_str().ok_or("`cargo metadata` names no target_directory")?;
    Ok(Path::new(target).join("release"))
}

fn absolute(path: &Path) -> Result<PathBuf, String> {
    path.canonicalize().map_err(|e| format!("{}: {e}", path.display()))
}

/// Our rays, then Embree's.
fn rays(bench: &Bench<'_>) -> Result<(), String> {
    let (side, rounds) = if bench.wanted.quick { ("64", "2") } else { ("512", "7") };
    run(Command::new(bench.built.join("examples/rays")).args([side, rounds]).arg(&bench.out))?;
    embree::rays(bench, rounds)
}

fn run(command: &mut Command) -> Result<(), String> {
    let status = command.status().map_err(|e| format!("cannot run {command:?}: {e}"))?;
    if status.success() { Ok(()) } else { Err(format!("{command:?}: {status}")) }
}
