//! Mitsuba 3 on its own copies of our scenes, from a virtual environment of its own.

use super::{Bench, run};
use crate::workspace;
use std::{
    path::{Path, PathBuf},
    process::Command,
};

/// Scenes that `xtask/peers/mitsuba_scenes.py` builds: all but the one with a tabulated lamp.
const SCENES: [&str; 11] = [
    "fog-box",
    "empty-box",
    "dark-fog",
    "cloud-box",
    "small-lamp",
    "beam",
    "cloud-grid",
    "smoke",
    "room",
    "plates",
    "terrain",
];

/// Where wheels are installed.
pub fn venv() -> PathBuf {
    workspace::root().join("target/peers")
}

/// Installs Mitsuba and Embree where they are missing.
pub fn install() -> Result<(), String> {
    let python = venv().join("bin/python");
    if !imports(&python, "mitsuba, numpy, embreex") {
        run(Command::new("python3").args(["-m", "venv"]).arg(venv()))?;
        run(Command::new(&python).args(["-m", "pip", "install", "--quiet", "mitsuba", "numpy", "embreex"]))?;
    }
    Ok(())
}

fn imports(python: &Path, modules: &str) -> bool {
    Command::new(python).args(["-c", &format!("import {modules}")]).output().is_ok_and(|o| o.status.success())
}

/// A Python that has Mitsuba: the environment's word, else the virtual environment's.
fn python() -> Option<PathBuf> {
    let named = std::env::var_os("TYNDALL_BENCH_PYTHON").map(PathBuf::from);
    let python = named.unwrap_or_else(|| venv().join("bin/python"));
    imports(&python, "mitsuba, numpy").then_some(python)
}

/// LLVM for Mitsuba's vectorised variants: the environment's word, else Debian's LLVM 19.
fn llvm() -> Option<PathBuf> {
    let named = std::env::var_os("DRJIT_LIBLLVM_PATH").map(PathBuf::from);
    let known = ["libLLVM.so.19.1", "libLLVM-19.so", "libLLVM-19.so.1"];
    let debian = known.map(|name| Path::new("/usr/lib/x86_64-linux-gnu").join(name));
    named.or_else(|| debian.into_iter().find(|path| path.exists()))
}

/// What a call needs; `None`, with a word why, where Mitsuba is not installed.
fn ready(bench: &Bench<'_>) -> Option<(PathBuf, Vec<&'static str>, Vec<&'static str>)> {
    let Some(python) = python() else {
        println!("Mitsuba 3 is left out; `cargo xtask bench --peers` installs it into target/peers");
        return None;
    };
    let mut variants = vec!["scalar_spectral"];
    match llvm() {
        Some(_) => variants.push("llvm_ad_spectral"),
        None => println!("no LLVM 19 (Debian: libllvm19, or set DRJIT_LIBLLVM_PATH): scalar_spectral only"),
    }
    let asked = &bench.wanted.scenes;
    let wanted = |name: &&str| asked.is_empty() || asked.iter().any(|s| s == name);
    let scenes: Vec<&str> = SCENES.into_iter().filter(wanted).collect();
    (!scenes.is_empty()).then_some((python, variants, scenes))
}

fn command(bench: &Bench<'_>, python: &Path, variant: &str) -> Command {
    let mut command = Command::new(python);
    command.arg(workspace::root().join("xtask/peers/mitsuba_scenes.py")).arg(variant).arg(&bench.out);
    command.envs(llvm().iter().map(|path| ("DRJIT_LIBLLVM_PATH", path)));
    command
}

/// Pictures of all scenes.
pub fn pictures(bench: &Bench<'_>) -> Result<(), String> {
    let Some((python, variants, scenes)) = ready(bench) else { return Ok(()) };
    for variant in variants {
        for scene in &scenes {
            println!("Mitsuba 3, {variant}: {scene}");
            let mut command = command(bench, &python, variant);
            command.args(["--scenes", scene]).args(seeds(bench));
            command.args(effort(bench.wanted.quick, variant.starts_with("scalar")));
            bench.keep(&workspace::output(&mut command)?)?;
        }
    }
    Ok(())
}

/// Sizes: one number of samples shows that the scalar variant is the slower one.
fn effort(quick: bool, scalar: bool) -> &'static [&'static str] {
    match (quick, scalar) {
        (true, true) => &["--resolution", "32", "--spp", "16", "--samplers", "multijitter"],
        (true, false) => &["--resolution", "32", "--spp", "4", "16", "--samplers", "multijitter"],
        (false, true) => &["--spp", "16"],
        (false, false) => &[],
    }
}

fn seeds(bench: &Bench<'_>) -> Vec<String> {
    let more = &bench.wanted.more;
    let given = more.iter().position(|word| word == "--seeds").and_then(|i| more.get(i + 1));
    let number = given.cloned().unwrap_or_else(|| if bench.wanted.quick { "3".into() } else { "8".into() });
    vec!["--seeds".into(), number]
}

/// Time to the first pixel, each in a process of its own.
pub fn starts(bench: &Bench<'_>) -> Result<(), String> {
    let Some((python, variants, scenes)) = ready(bench) else { return Ok(()) };
    for variant in variants {
        for scene in &scenes {
            let mut command = command(bench, &python, variant);
            bench.keep(&workspace::output(command.args(["--first-pixel", "--scenes", scene]))?)?;
        }
    }
    Ok(())
}
