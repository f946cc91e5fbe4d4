//! Places in source text: compact spans and the locations people read.

use std::fmt;
use std::sync::Arc;

use crate::source::SourceFile;

/// Number of a file in its [`SourceMap`](crate::SourceMap).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FileId(pub u32);

/// A range of bytes in one source file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Span {
    /// The file.
    pub file: FileId,
    /// First byte, counted from the start of the (uncompressed) file.
    pub offset: u32,
    /// Number of bytes.
    pub len: u32,
}

impl Span {
    /// The span from the start of `self` to the end of `last`, which lies later in the same file.
    pub fn to(self, last: Span) -> Span {
        debug_assert_eq!(self.file, last.file);
        let end = last.end().max(self.end());
        Span { len: end - self.offset, ..self }
    }

    /// The first byte after the span.
    pub fn end(self) -> u32 {
        self.offset + self.len
    }
}

/// A span resolved for people; prints as `path:line:column`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Location {
    /// Path of the file as it was opened.
    pub path: Arc<str>,
    /// Line, from 1.
    pub line: u32,
    /// Column in characters, from 1.
    pub column: u32,
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}", self.path, self.line, self.column)
    }
}

/// A span together with its file: enough to report it anywhere.
#[derive(Clone, Debug)]
pub struct Place {
    /// The file that the span lies in.
    pub source: Arc<SourceFile>,
    /// The bytes meant.
    pub span: Span,
}

impl Place {
    /// Path, line and column of the first byte.
    pub fn location(&self) -> Location {
        self.source.location(self.span.offset)
    }

    /// The text of the span; invalid UTF-8 is replaced.
    pub fn text(&self) -> String {
        String::from_utf8_lossy(self.source.slice(self.span)).into_owned()
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.location().fmt(f)
    }
}
