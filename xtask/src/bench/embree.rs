//! Embree 4 on our rays: the library of the wheel `embreex`, called by a small C program that is compiled here.

use super::{Bench, mitsuba::venv, run};
use crate::workspace;
use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

/// Measures Embree, or says what is missing.
pub fn rays(bench: &Bench<'_>, rounds: &str) -> Result<(), String> {
    let Some(library) = library() else {
        println!(
            "Embree is left out; `cargo xtask bench --peers` installs the wheel `embreex` into target/peers"
        );
        return Ok(());
    };
    let Some(program) = compile(&bench.out)? else {
        println!("Embree is left out: no C compiler `cc`");
        return Ok(());
    };
    let mut command = Command::new(program);
    command.arg(library).arg(rounds).args(files(&bench.out.join("rays"))?);
    let printed = workspace::output(&mut command)?;
    print!("{printed}");
    bench.keep(&printed)
}

/// The environment's word, else the wheel's library.
fn library() -> Option<PathBuf> {
    let named = std::env::var_os("TYNDALL_BENCH_EMBREE").map(PathBuf::from);
    named.or_else(|| {
        let versions = fs::read_dir(venv().join("lib")).ok()?.flatten();
        let folders = versions.map(|v| v.path().join("site-packages/embreex.libs"));
        let files = folders.flat_map(|f| fs::read_dir(f).into_iter().flatten().flatten());
        files.map(|f| f.path()).find(|p| is_embree(p))
    })
}

fn is_embree(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("libembree4"))
}

/// The C program; `None` without a compiler.
fn compile(out: &Path) -> Result<Option<PathBuf>, String> {
    let compiler = std::env::var_os("CC").unwrap_or_else(|| "cc".into());
    if Command::new(&compiler).arg("--version").output().is_err() {
        return Ok(None);
    }
    let program = out.join("embree_rays");
    let source = workspace::root().join("xtask/peers/embree_rays.c");
    run(Command::new(&compiler)
        .args(["-O3", "-march=native", "-o"])
        .arg(&program)
        .arg(source)
        .args(["-ldl", "-lm"]))?;
    Ok(Some(program))
}

/// Meshes and rays, by name.
fn files(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let listed = fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut files: Vec<PathBuf> = listed.flatten().map(|entry| entry.path()).collect();
    files.sort();
    Ok(files)
}
