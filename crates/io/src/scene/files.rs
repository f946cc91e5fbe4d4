//! Files that a scene names: hashed, and the same from the moment they were found.

use std::{
    fs,
    path::{Path, PathBuf},
    time::SystemTime,
};
use tyndall_pbrt::{Error, ErrorKind};

/// A file as it was when it was found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FoundFile {
    path: PathBuf,
    stamp: Option<Stamp>,
}

/// Size and time of the last change.
type Stamp = (u64, Option<SystemTime>);

impl FoundFile {
    /// Notes what the file is like now.
    pub fn new(path: PathBuf) -> Self {
        let stamp = stamp(&path);
        Self { path, stamp }
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Its bytes, for the scene's hash.
    ///
    /// # Errors
    /// When it cannot be read, or is not what it was: what the scene was made of would not be what is hashed.
    pub fn read(&self) -> Result<Vec<u8>, Error> {
        let name = || self.path.display().to_string();
        let bytes = fs::read(&self.path).map_err(|e| Error::in_file(ErrorKind::Io(e), name()))?;
        if stamp(&self.path) != self.stamp {
            return Err(
                Error::in_file(ErrorKind::Changed, name()).hint("start again once nobody writes to it")
            );
        }
        Ok(bytes)
    }
}

fn stamp(path: &Path) -> Option<Stamp> {
    let meta = fs::metadata(path).ok()?;
    Some((meta.len(), meta.modified().ok()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_changes_is_refused() {
        let path = std::env::temp_dir().join(format!("tyndall-changing-{}", std::process::id()));
        fs::write(&path, "one").expect("writable");
        let found = FoundFile::new(path.clone());
        assert_eq!(found.read().expect("unchanged"), b"one");
        fs::write(&path, "another").expect("writable");
        let text = found.read().expect_err("changed").to_string();
        fs::remove_file(&path).expect("there");
        assert!(text.contains("changed while"), "{text}");
    }
}
