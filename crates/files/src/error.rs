//! What can go wrong with a file: which file, what was expected, what was found, what to do about it.

use std::{fmt, io, path::Path, path::PathBuf};

/// Result of reading or writing a file.
pub type Result<T> = std::result::Result<T, FileError>;

/// Where in a file an error lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The file as a whole, or its header.
    File,
    /// A line, counted from 1.
    Line(u64),
    /// A byte offset, counted from 0.
    Byte(u64),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::File => Ok(()),
            Place::Line(line) => write!(f, ":{line}"),
            Place::Byte(byte) => write!(f, " (byte {byte})"),
        }
    }
}

/// An error about one file. Its message names the file, the expectation, what was found, and a cure.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileError {
    /// The operating system refused an action.
    #[error("{}: cannot {action}: {source}\n  hint: {hint}", path.display())]
    Io {
        /// The file concerned.
        path: PathBuf,
        /// What was being done, as an infinitive.
        action: &'static str,
        /// The system's reason.
        source: io::Error,
        /// What to do.
        hint: &'static str,
    },
    /// The contents contradict the format or themselves.
    #[error("{}{place}: expected {expected}, got {got}\n  hint: {hint}", path.display())]
    Malformed {
        /// The file concerned.
        path: PathBuf,
        /// Where in the file.
        place: Place,
        /// What the format asks for.
        expected: String,
        /// What the file has.
        got: String,
        /// What to do.
        hint: String,
    },
    /// Valid, but a feature that is not read or written here.
    #[error("{}: {feature} is not supported\n  hint: {hint}", path.display())]
    Unsupported {
        /// The file concerned.
        path: PathBuf,
        /// The feature.
        feature: String,
        /// What to do.
        hint: String,
    },
    /// The header announces more data than the file's own size can justify; nothing was allocated.
    #[error("{}: announces {announced} bytes of {what}, but a file of {file_bytes} bytes can hold {justified} at most\n  hint: the file is truncated or its header is corrupt; copy or export it again", path.display())]
    Oversized {
        /// The file concerned.
        path: PathBuf,
        /// What is announced.
        what: &'static str,
        /// Bytes needed for it.
        announced: u128,
        /// Bytes that the file's size justifies.
        justified: u128,
        /// The size of the file.
        file_bytes: u64,
    },
    /// An image handed over for writing contradicts itself.
    #[error("image: expected {expected}, got {got}\n  hint: {hint}")]
    BadImage {
        /// What is required.
        expected: String,
        /// What was given.
        got: String,
        /// What to do.
        hint: String,
    },
}

impl FileError {
    /// An [`FileError::Io`] with the hint that fits the system's reason.
    pub fn io(path: &Path, action: &'static str, source: io::Error) -> Self {
        let hint = io_hint(&source);
        FileError::Io { path: path.to_path_buf(), action, source, hint }
    }

    /// A [`FileError::Malformed`].
    pub fn malformed(
        path: &Path,
        place: Place,
        expected: impl Into<String>,
        got: impl Into<String>,
        hint: impl Into<String>,
    ) -> Self {
        FileError::Malformed {
            path: path.to_path_buf(),
            place,
            expected: expected.into(),
            got: got.into(),
            hint: hint.into(),
        }
    }

    /// A [`FileError::Unsupported`].
    pub fn unsupported(path: &Path, feature: impl Into<String>, hint: impl Into<String>) -> Self {
        FileError::Unsupported { path: path.to_path_buf(), feature: feature.into(), hint: hint.into() }
    }

    /// A [`FileError::BadImage`].
    pub fn bad_image(expected: impl Into<String>, got: impl Into<String>, hint: impl Into<String>) -> Self {
        FileError::BadImage { expected: expected.into(), got: got.into(), hint: hint.into() }
    }

    /// The same error about another file: a writer's error names the result, not its temporary file.
    #[must_use]
    pub fn with_path(mut self, new: &Path) -> Self {
        match &mut self {
            FileError::Io { path, .. }
            | FileError::Malformed { path, .. }
            | FileError::Unsupported { path, .. }
            | FileError::Oversized { path, .. } => *path = new.to_path_buf(),
            FileError::BadImage { .. } => {}
        }
        self
    }
}

/// The cure for a reason of the operating system.
fn io_hint(error: &io::Error) -> &'static str {
    use io::ErrorKind as Kind;
    match error.kind() {
        Kind::NotFound => "check the spelling, and that the folder exists",
        Kind::PermissionDenied => "check the permissions of the file and of its folder, or write elsewhere",
        Kind::StorageFull => "the disk is full; free space or write to another disk",
        Kind::QuotaExceeded => "your disk quota is used up; free space or write elsewhere",
        Kind::FileTooLarge => "the file system or a limit (ulimit -f) does not allow a file of this size",
        Kind::ReadOnlyFilesystem => "the file system is mounted read-only; write elsewhere",
        Kind::IsADirectory => "this is a folder; name a file in it",
        Kind::NotADirectory => "a part of the path is a file, not a folder",
        Kind::UnexpectedEof => "the file is truncated; copy or export it again",
        Kind::InvalidFilename => "the name is too long or has characters that the file system refuses",
        _ => "see the system's reason above",
    }
}
