//! What a run writes must be none of what it reads, and no two of its files may be the same.

use std::collections::HashMap;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

use tyndall::engine::container::MAGIC;

use crate::exit::Failure;

/// Refuses files that would destroy one another; each comes with what it is.
pub fn check(read: &[(&str, PathBuf)], written: &[(&str, PathBuf)]) -> Result<(), Failure> {
    let inputs: HashMap<PathBuf, &str> = read.iter().map(|(what, path)| (identity(path), *what)).collect();
    let mut seen: HashMap<PathBuf, &str> = HashMap::new();
    for (what, path) in written.iter().filter(|(_, path)| !is_device(path)) {
        let refuse = |why: String| {
            let hint = "give every file a name of its own (-o, --checkpoint)";
            Err(Failure::input(format!("{}: {why}", path.display()), Some(hint)))
        };
        let id = identity(path);
        if let Some(input) = inputs.get(&id) {
            return refuse(format!("is {input}, and {what} would be written over it"));
        }
        if let Some(other) = seen.insert(id, what) {
            return refuse(format!("would be written twice, as {other} and as {what}"));
        }
    }
    Ok(())
}

/// Refuses to replace by a checkpoint what is none.
pub fn check_checkpoint(path: &Path) -> Result<(), Failure> {
    if !path.is_file() || starts_as_film(path) {
        return Ok(());
    }
    let hint = "--checkpoint NAME puts the checkpoint elsewhere";
    Err(Failure::input(format!("{}: exists and is no checkpoint", path.display()), Some(hint)))
}

/// A file that was cut short to nothing is as good as none.
fn starts_as_film(path: &Path) -> bool {
    let mut start = Vec::new();
    let read = fs::File::open(path).and_then(|file| file.take(MAGIC.len() as u64).read_to_end(&mut start));
    read.is_ok() && MAGIC.starts_with(&start)
}

/// A device or pipe takes whatever comes.
fn is_device(path: &Path) -> bool {
    path.exists() && !path.is_file()
}

/// One path for each file, whatever links and dots lead to it.
fn identity(path: &Path) -> PathBuf {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let inside = || Some(fs::canonicalize(folder).ok()?.join(path.file_name()?));
    fs::canonicalize(path).ok().or_else(inside).unwrap_or_else(|| path.to_path_buf())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(what: &'static str, paths: &[PathBuf]) -> Vec<(&'static str, PathBuf)> {
        paths.iter().map(|path| (what, path.clone())).collect()
    }

    #[test]
    fn files_that_would_destroy_one_another_are_refused() {
        let folder = tempfile::tempdir().expect("writable");
        let at = |name: &str| folder.path().join(name);
        fs::write(at("a.pbrt"), "scene").expect("writable");
        let scene = named("the scene", &[at("a.pbrt")]);
        assert!(check(&scene, &named("a result", &[at("a.exr"), at("a.png")])).is_ok());
        for pair in [[at("a.exr"), at("a.exr")], [at("a.exr"), at("./a.exr")], [at("b.exr"), at("./a.pbrt")]]
        {
            assert!(check(&scene, &named("a result", &pair)).is_err(), "{pair:?}");
        }
    }

    #[test]
    fn only_checkpoints_are_replaced_by_checkpoints() {
        let folder = tempfile::tempdir().expect("writable");
        let path = folder.path().join("a.ckpt");
        assert!(check_checkpoint(&path).is_ok());
        for (content, ok) in [("", true), ("TYND", true), ("TYNDFILM and more", true), ("a diary", false)] {
            fs::write(&path, content).expect("writable");
            assert_eq!(check_checkpoint(&path).is_ok(), ok, "{content}");
        }
    }
}
