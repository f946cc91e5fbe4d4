//! Where the project is, and which files it holds.

use std::path::{Path, PathBuf};
use std::process::Command;

/// The folder of the workspace's `Cargo.toml`.
pub fn root() -> PathBuf {
    let xtask = Path::new(env!("CARGO_MANIFEST_DIR"));
    xtask.parent().expect("xtask lies inside the workspace").to_path_buf()
}

/// The cargo that runs this task.
pub fn cargo() -> Command {
    Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

/// Paths, relative to the root, of the files that belong to the project: tracked, or new and not ignored.
pub fn files() -> Result<Vec<PathBuf>, String> {
    let listing =
        output(Command::new("git").args(["ls-files", "-z", "--cached", "--others", "--exclude-standard"]))?;
    let mut files: Vec<PathBuf> =
        listing.split('\0').filter(|name| !name.is_empty()).map(PathBuf::from).collect();
    // a file deleted but not yet committed is still in git's index
    files.retain(|file| root().join(file).is_file());
    files.sort();
    files.dedup();
    Ok(files)
}

/// What a command run in the root prints; an error with its messages if it fails.
pub fn output(command: &mut Command) -> Result<String, String> {
    let result =
        command.current_dir(root()).output().map_err(|error| format!("cannot run {command:?}: {error}"))?;
    if !result.status.success() {
        return Err(format!("{command:?} failed: {}", String::from_utf8_lossy(&result.stderr).trim()));
    }
    String::from_utf8(result.stdout).map_err(|error| format!("{command:?}: {error}"))
}
