//! `cargo xtask bench`: what the techniques buy, and other renderers beside ours.

use serde_json::Value;
use std::{
    path::{Path, PathBuf},
    process::{Command, ExitCode},
};

use crate::workspace;

const USAGE: &str = "cargo xtask bench [--quick] [--inner] [--peers] [--defaults] [--scene NAME]...";

/// Scenes that the peers' script has, too.
const SHARED: [&str; 4] = ["fog-box", "empty-box", "beam", "cloud-box"];

/// What the command line asks for.
#[derive(Debug, Default)]
struct Wanted {
    quick: bool,
    inner: bool,
    peers: bool,
    defaults: bool,
    scenes: Vec<String>,
}

impl Wanted {
    fn parse(arguments: &[String]) -> Result<Self, String> {
        let mut wanted = Self::default();
        let mut rest = arguments.iter();
        while let Some(argument) = rest.next() {
            match argument.as_str() {
                "--quick" => wanted.quick = true,
                "--inner" => wanted.inner = true,
                "--peers" => wanted.peers = true,
                "--defaults" => wanted.defaults = true,
                "--scene" => wanted.scenes.push(rest.next().ok_or("--scene needs a name")?.clone()),
                stranger => return Err(format!("no option `{stranger}`\nhint: {USAGE}")),
            }
        }
        Ok(wanted)
    }

    /// The scenes to run the peers on.
    fn shared(&self) -> Vec<&'static str> {
        let wanted = |name: &&str| self.scenes.is_empty() || self.scenes.iter().any(|s| s == name);
        SHARED.into_iter().filter(wanted).collect()
    }
}

/// Runs the benchmark; reports lie in `target/bench`.
pub fn bench(arguments: &[String]) -> ExitCode {
    let wanted = match Wanted::parse(arguments) {
        Ok(wanted) => wanted,
        Err(error) => {
            eprintln!("error: {error}");
            return ExitCode::from(2);
        }
    };
    let result = if wanted.inner { inner() } else { whole(&wanted) };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Costs of inner loops.
fn inner() -> Result<(), String> {
    for (package, example) in [("tyndall-base", "nanoseconds"), ("tyndall-geometry", "rays")] {
        println!("\n=== {package}: {example}");
        example_of(package, example, &[])?;
    }
    Ok(())
}

/// Whole pictures, ours and, where they are installed, other renderers'.
fn whole(wanted: &Wanted) -> Result<(), String> {
    let out = workspace::root().join("target/bench");
    let mut arguments = vec![out.to_string_lossy().into_owned()];
    arguments.extend(wanted.quick.then(|| "quick".into()));
    arguments.extend(wanted.defaults.then(|| "defaults".into()));
    arguments.extend(wanted.scenes.iter().cloned());
    example_of("tyndall", "bench", &arguments)?;
    let shared = wanted.shared();
    if wanted.quick || shared.is_empty() {
        return Ok(());
    }
    let rows = mitsuba(&out, wanted.peers, &shared)?;
    if rows.is_empty() {
        return Ok(());
    }
    let table = beside(&out, &rows)?;
    print!("{table}");
    let report = out.join("bench.md");
    let text = std::fs::read_to_string(&report).map_err(|e| format!("{}: {e}", report.display()))?;
    write(&report, &(text + &table))?;
    write(&out.join("mitsuba.json"), &format!("{:#}\n", Value::Array(rows)))
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    std::fs::write(path, text).map_err(|e| format!("{}: {e}", path.display()))
}

fn example_of(package: &str, example: &str, arguments: &[String]) -> Result<(), String> {
    let mut command = workspace::cargo();
    command.args(["run", "--release", "-p", package, "--example", example, "--"]).args(arguments);
    run(command.current_dir(workspace::root()))
}

fn run(command: &mut Command) -> Result<(), String> {
    let status = command.status().map_err(|e| format!("cannot run {command:?}: {e}"))?;
    if status.success() { Ok(()) } else { Err(format!("{command:?}: {status}")) }
}

/// Mitsuba's measurements; none when it is not installed and not to be installed.
fn mitsuba(out: &Path, install: bool, scenes: &[&str]) -> Result<Vec<Value>, String> {
    let venv = workspace::root().join("target/peers");
    let python = venv.join("bin/python");
    if install && !has_mitsuba(&python) {
        run(Command::new("python3").args(["-m", "venv"]).arg(&venv))?;
        run(Command::new(&python).args(["-m", "pip", "install", "--quiet", "mitsuba", "numpy"]))?;
    }
    if !has_mitsuba(&python) {
        println!("\nMitsuba 3 is left out; `cargo xtask bench --peers` installs it into target/peers");
        return Ok(Vec::new());
    }
    let llvm = llvm();
    if llvm.is_none() {
        println!("\nno LLVM 19 (Debian: libllvm19, or set DRJIT_LIBLLVM_PATH): scalar_spectral only");
    }
    let mut rows = Vec::new();
    let variants = ["scalar_spectral"].into_iter().chain(llvm.is_some().then_some("llvm_ad_spectral"));
    for variant in variants {
        println!("Mitsuba 3, {variant}");
        let mut command = Command::new(&python);
        command.arg(workspace::root().join("xtask/peers/mitsuba_boxes.py")).arg(variant).arg(out);
        command.arg("--scenes").args(scenes);
        command.envs(llvm.iter().map(|path| ("DRJIT_LIBLLVM_PATH", path)));
        // one number of samples shows that the scalar variant is the slower one
        command.args(variant.starts_with("scalar").then_some(["--spp", "16"]).iter().flatten());
        let lines = workspace::output(&mut command)?;
        for line in lines.lines().filter(|line| line.starts_with('{')) {
            rows.push(serde_json::from_str(line).map_err(|e| format!("Mitsuba's results: {e}"))?);
        }
    }
    Ok(rows)
}

fn has_mitsuba(python: &Path) -> bool {
    Command::new(python).args(["-c", "import mitsuba, numpy"]).output().is_ok_and(|o| o.status.success())
}

/// LLVM for Mitsuba's vectorised variants: the environment's word, else Debian's LLVM 19.
fn llvm() -> Option<PathBuf> {
    let named = std::env::var_os("DRJIT_LIBLLVM_PATH").map(PathBuf::from);
    let known = ["libLLVM.so.19.1", "libLLVM-19.so", "libLLVM-19.so.1"];
    let debian = known.map(|name| Path::new("/usr/lib/x86_64-linux-gnu").join(name));
    named.or_else(|| debian.into_iter().find(|path| path.exists()))
}

/// Our efficiency over the peers' on the scenes that they share.
fn beside(out: &Path, rows: &[Value]) -> Result<String, String> {
    let path = out.join("ours.json");
    let ours = std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    let ours: Value = serde_json::from_str(&ours).map_err(|e| format!("{}: {e}", path.display()))?;
    let mut text = String::from("\n## Mitsuba 3 beside ours, one thread\n\n");
    text += "| renderer | scene | spp | samples/s | E headline | E whole frame | mean Y | ours, headline | ours, whole frame |\n";
    text += "|---|---|---|---|---|---|---|---|---|\n";
    for row in rows {
        let number = |key: &str| row[key].as_f64().unwrap_or(f64::NAN);
        let own = ours_on(&ours, &row["scene"], &row["spp"]).ok_or("our own figures lack Mitsuba's scene")?;
        let times = |key: &str| own[key].as_f64().unwrap_or(f64::NAN) / number(key);
        text += &format!(
            "| {} | {} | {} | {:.0} k | {:.1} | {:.1} | {:.4} | {:.2} times | {:.2} times |\n",
            row["renderer"].as_str().unwrap_or_default(),
            row["scene"].as_str().unwrap_or_default(),
            row["spp"],
            number("samples_per_second") / 1e3,
            number("headline"),
            number("whole"),
            number("mean_y"),
            times("headline"),
            times("whole"),
        );
    }
    Ok(text)
}

/// Our figures on a scene at a number of samples.
fn ours_on<'a>(ours: &'a Value, scene: &Value, spp: &Value) -> Option<&'a Value> {
    let found = ours["scenes"].as_array()?.iter().find(|s| s["scene"] == *scene)?;
    Some(&found["defaults"].as_array()?.iter().find(|d| d["spp"] == *spp)?["measured"])
}
