//! The crate's error: what is wrong, where, and what to do about it.

use std::fmt;

use crate::span::{Location, Place};

/// What is wrong. Every message says what was expected and what was found.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The file could not be opened or read.
    #[error("cannot read the file: {0}")]
    Io(std::io::Error),
    /// The file is not what it was a moment ago.
    #[error("the file changed while it was read")]
    Changed,
    /// The gzip data is damaged or cut off.
    #[error("cannot unpack the gzip file: {0}")]
    Gzip(std::io::Error),
    /// No byte, or nothing but blanks and comments.
    #[error("the file is empty: expected a pbrt-v4 scene")]
    Empty,
    /// Bytes that no text has.
    #[error("looks binary: expected pbrt-v4 text, got byte 0x{byte:02x} at offset {offset}")]
    Binary {
        /// The byte.
        byte: u8,
        /// Where it is.
        offset: usize,
    },
    /// UTF-16, as some Windows editors write.
    #[error("expected UTF-8 text, got UTF-16")]
    Utf16,
    /// Offsets have 32 bits.
    #[error("expected a file below 4 GiB, got {bytes} bytes or more")]
    TooLarge {
        /// Size where it is known, else the bound.
        bytes: u64,
    },
    /// The text ends, or the line ends, inside a string.
    #[error("string is not closed: expected `\"` before the end of the line")]
    UnclosedString,
    /// The text ends inside a list of values.
    #[error("list is not closed: expected `]`, got the end of the file")]
    UnclosedList,
    /// The text ends inside an attribute block or an object.
    #[error("{directive} is not closed: expected {closing}, got the end of the file")]
    UnclosedBlock {
        /// The directive that opened the block.
        directive: &'static str,
        /// The directive that would close it.
        closing: &'static str,
    },
    /// A word where a directive belongs.
    #[error("unknown directive `{name}`")]
    UnknownDirective {
        /// The word.
        name: String,
    },
    /// Any other slip of grammar.
    #[error("{context}: expected {expected}, got {got}")]
    Syntax {
        /// The directive or parameter being read.
        context: String,
        /// What the grammar wants here.
        expected: String,
        /// What the text has here.
        got: String,
    },
    /// A type name that pbrt-v4 does not know.
    #[error("unknown parameter type `{kind}` of parameter `{name}`")]
    UnknownType {
        /// The type.
        kind: String,
        /// The parameter.
        name: String,
    },
    /// A parameter that is there with a type that its reader cannot take.
    #[error("{name}: expected a parameter of type {expected}, got `{got}`")]
    WrongType {
        /// The parameter.
        name: String,
        /// Types that would do.
        expected: String,
        /// The type in the file.
        got: &'static str,
    },
    /// A value outside its range or set.
    #[error("{name}: {expected}, got {got}")]
    Value {
        /// The parameter.
        name: String,
        /// The rule, as in "must be >= 0".
        expected: String,
        /// The value, with its unit.
        got: String,
    },
    /// A parameter that has no default is absent.
    #[error("{directive}: parameter \"{kind} {name}\" is missing")]
    Missing {
        /// The directive.
        directive: String,
        /// Its type.
        kind: String,
        /// Its name.
        name: String,
    },
    /// A file named in the scene is nowhere.
    #[error("file `{path}` not found; tried {tried}")]
    FileNotFound {
        /// The name in the scene.
        path: String,
        /// The paths that were looked at.
        tried: String,
    },
    /// A file that includes itself, directly or not.
    #[error("cyclic {directive}: {chain}")]
    CyclicInclude {
        /// `Include` or `Import`.
        directive: &'static str,
        /// The files from the first to its repetition.
        chain: String,
    },
    /// A bound that keeps hostile input from using all memory.
    #[error("{what}: expected at most {limit}")]
    Limit {
        /// What there is too much of.
        what: &'static str,
        /// The bound.
        limit: usize,
    },
    /// A directive on the wrong side of `WorldBegin`.
    #[error("{directive}: expected {side} WorldBegin, got it {other} WorldBegin")]
    WrongBlock {
        /// The directive.
        directive: &'static str,
        /// Where it belongs: `before` or `after`.
        side: &'static str,
        /// Where it is.
        other: &'static str,
    },
    /// Blocks that do not nest.
    #[error("{directive}: {problem}")]
    Nesting {
        /// The directive.
        directive: &'static str,
        /// What is wrong.
        problem: String,
    },
    /// A name defined twice.
    #[error("{what} \"{name}\" is defined twice, first at {first}")]
    Redefined {
        /// Material, texture, ...
        what: &'static str,
        /// The name.
        name: String,
        /// The earlier definition.
        first: Location,
    },
    /// The scene ends before its world begins.
    #[error("expected WorldBegin, got the end of the file")]
    NoWorld,
    /// Anything that a reader of directives has to say.
    #[error("{0}")]
    Other(String),
}

/// An error with its place in the scene and a hint.
///
/// Prints as one line, `path:line:column: message`; [`Error::plain`] adds the hint on a second line; as a
/// [`miette::Diagnostic`] it shows the source line.
pub struct Error {
    inner: Box<Inner>,
}

struct Inner {
    kind: ErrorKind,
    place: Option<Place>,
    file: Option<String>,
    hint: Option<String>,
}

impl Error {
    /// An error at a place.
    pub fn new(kind: ErrorKind, place: Place) -> Error {
        Error { inner: Box::new(Inner { kind, place: Some(place), file: None, hint: None }) }
    }

    /// An error about a whole file.
    pub fn in_file(kind: ErrorKind, file: impl Into<String>) -> Error {
        Error { inner: Box::new(Inner { kind, place: None, file: Some(file.into()), hint: None }) }
    }

    /// The same error with a hint (replaces an earlier one).
    #[must_use]
    pub fn hint(mut self, hint: impl Into<String>) -> Error {
        self.inner.hint = Some(hint.into());
        self
    }

    /// The same error with a hint if there is one to give.
    #[must_use]
    pub(crate) fn maybe_hint(self, hint: Option<String>) -> Error {
        match hint {
            Some(hint) => self.hint(hint),
            None => self,
        }
    }

    /// The same error at `place`, if it has none yet.
    #[must_use]
    pub(crate) fn or_place(mut self, place: Place) -> Error {
        self.inner.place.get_or_insert(place);
        self
    }

    /// What is wrong.
    pub fn kind(&self) -> &ErrorKind {
        &self.inner.kind
    }

    /// Where it is wrong.
    pub fn place(&self) -> Option<&Place> {
        self.inner.place.as_ref()
    }

    /// Path, line and column.
    pub fn location(&self) -> Option<Location> {
        self.place().map(Place::location)
    }

    /// What to do about it.
    pub fn hint_text(&self) -> Option<&str> {
        self.inner.hint.as_deref()
    }

    /// The message in plain text: the line with the place, then `hint: ...` on a line of its own.
    pub fn plain(&self) -> String {
        match self.hint_text() {
            Some(hint) => format!("{self}\nhint: {hint}"),
            None => self.to_string(),
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.inner.place, &self.inner.file) {
            (Some(place), Some(file)) if **place.source.name() != **file => {
                write!(f, "{place}: {file}: {}", self.kind())
            }
            (Some(place), _) => write!(f, "{place}: {}", self.kind()),
            (None, Some(file)) => write!(f, "{file}: {}", self.kind()),
            (None, None) => self.kind().fmt(f),
        }
    }
}

impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.plain())
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self.kind() {
            ErrorKind::Io(e) | ErrorKind::Gzip(e) => Some(e),
            _ => None,
        }
    }
}
