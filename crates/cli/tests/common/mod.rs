//! The program in a folder of its own.
#![allow(dead_code, reason = "every test program uses a part")]

use std::fs;
use std::path::{Path, PathBuf};

use assert_cmd::Command;
use tempfile::TempDir;

/// A folder, and the program started in it.
pub struct Place(TempDir);

/// What a run left behind.
pub struct Ran {
    pub code: i32,
    pub out: String,
    pub err: String,
}

impl Place {
    pub fn new() -> Self {
        Self(tempfile::tempdir().expect("writable"))
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn folder(&self) -> &Path {
        self.0.path()
    }

    pub fn write(&self, name: &str, text: impl AsRef<[u8]>) {
        fs::write(self.path(name), text).expect("writable");
    }

    pub fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    pub fn has(&self, name: &str) -> bool {
        self.path(name).exists()
    }

    /// Runs `tyndall` with these words.
    pub fn run(&self, line: &str) -> Ran {
        let mut command = Command::cargo_bin("tyndall").expect("built beside the tests");
        let output =
            command.current_dir(self.folder()).args(line.split_whitespace()).output().expect("starts");
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        Ran { code: output.status.code().unwrap_or(-1), out: text(&output.stdout), err: text(&output.stderr) }
    }

    /// Runs it to its good end.
    pub fn ok(&self, line: &str) -> Ran {
        let ran = self.run(line);
        assert_eq!(ran.code, 0, "tyndall {line}\n{}{}", ran.out, ran.err);
        ran
    }

    /// A record as JSON.
    pub fn json(&self, name: &str) -> serde_json::Value {
        serde_json::from_slice(&self.read(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }
}

impl Ran {
    /// The refusal of bad input: code 2, no panic, the first line.
    pub fn refusal(&self) -> &str {
        assert_eq!(self.code, 2, "{}", self.err);
        assert!(!self.err.contains("panicked") && !self.err.contains("internal error"), "{}", self.err);
        self.err.lines().find(|l| !l.contains("warning:")).unwrap_or_default()
    }
}
