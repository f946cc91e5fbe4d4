//! What must not be in the repository.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use crate::{Findings, workspace};

/// Largest file, in bytes.
const MOST_BYTES: usize = 2 << 20;
/// Folders that exist on somebody's machine only.
const MACHINE_FOLDERS: [&str; 4] = ["home", "work", "tmp", "root"];
/// States, per number table, where it comes from.
const NOTICE: &str = "NOTICE.md";
/// Marks of unfinished work, written so that this file does not hold them.
const MARKERS: [&str; 4] =
    [concat!("to", "do!"), concat!("un", "implemented!"), concat!("FIX", "ME"), concat!("XX", "X")];

/// Looks at every file of the project.
pub fn check() -> Result<Findings, String> {
    let files = workspace::files()?;
    let mut findings = Findings::new();
    for file in files.iter().filter(|file| !file.ends_with(".gitignore")) {
        let bytes = std::fs::read(workspace::root().join(file))
            .map_err(|error| format!("{}: {error}", file.display()))?;
        findings.extend(too_large(file, bytes.len()));
        // anything that is not text has no lines to look at
        if let Ok(text) = String::from_utf8(bytes) {
            findings.extend(text.lines().enumerate().filter_map(|(index, line)| {
                complaint(line).map(|complaint| format!("{}:{}: {complaint}", file.display(), index + 1))
            }));
        }
    }
    findings.extend(unsourced(&files)?);
    println!("hygiene: {} files looked at", files.len());
    Ok(findings)
}

/// Number tables whose folder's `NOTICE.md` does not name them, and so not where they come from.
fn unsourced(files: &[PathBuf]) -> Result<Findings, String> {
    let mut findings = Findings::new();
    for file in files.iter().filter(|file| !file.ends_with(NOTICE)) {
        let Some(folder) = data_folder(file) else { continue };
        let notice = workspace::root().join(&folder).join(NOTICE);
        let notice =
            std::fs::read_to_string(&notice).map_err(|error| format!("{}: {error}", notice.display()))?;
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        if !notice.contains(&*name) {
            findings.push(format!("{}: {NOTICE} does not state its source and licence", file.display()));
        }
    }
    Ok(findings)
}

/// `crates/<name>/data` for a file anywhere inside it.
fn data_folder(file: &Path) -> Option<PathBuf> {
    let parts: Vec<&OsStr> = file.iter().take(3).collect();
    let [crates, _, data] = parts[..] else { return None };
    (crates == "crates" && data == "data").then(|| parts.iter().collect())
}

fn too_large(file: &Path, bytes: usize) -> Option<String> {
    (bytes > MOST_BYTES).then(|| format!("{}: {bytes} bytes, at most {MOST_BYTES} allowed", file.display()))
}

fn complaint(line: &str) -> Option<String> {
    let folder = MACHINE_FOLDERS.iter().find(|folder| names_absolute(line, folder));
    let marker = MARKERS.iter().find(|marker| has_word(line, marker));
    match (folder, marker) {
        (Some(folder), _) => Some(format!("a path under /{folder} that exists on one machine only")),
        (_, Some(marker)) => Some(format!("`{marker}` marks unfinished work")),
        _ => None,
    }
}

/// Whether the line holds `/folder` as the first part of a path.
fn names_absolute(line: &str, folder: &str) -> bool {
    let path = format!("/{folder}");
    line.match_indices(&path).any(|(at, _)| {
        let before = line[..at].chars().next_back();
        let after = line[at + path.len()..].chars().next();
        !before.is_some_and(continues_path) && !after.is_some_and(is_word)
    })
}

fn has_word(line: &str, word: &str) -> bool {
    line.match_indices(word).any(|(at, _)| {
        let before = line[..at].chars().next_back();
        let after = line[at + word.len()..].chars().next();
        !before.is_some_and(is_word) && (word.ends_with('!') || !after.is_some_and(is_word))
    })
}

fn is_word(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_' || letter == '-'
}

/// Whether a slash after this character is inside a relative path (`docs/work`, `../tmp`, `{dir}/tmp`).
fn continues_path(letter: char) -> bool {
    is_word(letter) || matches!(letter, '.' | '}' | ')' | '~' | '*')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn machine_paths_are_found() {
        for folder in MACHINE_FOLDERS {
            assert!(complaint(&format!("let file = \"/{folder}/x.exr\";")).is_some());
            assert!(complaint(&format!("cd /{folder}")).is_some());
            assert!(complaint(&format!("see docs/{folder}/x and ../{folder}/y")).is_none());
            assert!(complaint(&format!("a /{folder}ing path")).is_none());
        }
    }

    #[test]
    fn markers_are_found() {
        for marker in MARKERS {
            assert!(complaint(&format!("    {marker}(\"later\")")).is_some());
            assert!(complaint(&format!("a{marker}")).is_none());
        }
        assert!(complaint(&format!("mktemp {}{}", MARKERS[3], MARKERS[3])).is_none());
    }

    #[test]
    fn data_folders_are_known() {
        let folder = |file: &str| data_folder(Path::new(file));
        assert_eq!(folder("crates/a/data/b/c.csv"), Some(PathBuf::from("crates/a/data")));
        assert_eq!(folder("crates/a/tests/data/c.csv"), None);
        assert_eq!(folder("data/c.csv"), None);
    }

    #[test]
    fn large_files_are_found() {
        assert!(too_large(Path::new("a"), MOST_BYTES).is_none());
        assert!(too_large(Path::new("a"), MOST_BYTES + 1).is_some());
    }
}
