//! Source files held for the life of a scene, so that any later error can show its line.

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock, PoisonError, RwLock};

use crate::span::{FileId, Location, Place, Span};

/// One source file: its name, its text, and an index of its lines that is built on demand.
pub struct SourceFile {
    id: FileId,
    name: Arc<str>,
    path: Option<PathBuf>,
    bytes: Vec<u8>,
    line_starts: OnceLock<Vec<u32>>,
    printable: OnceLock<Option<Vec<u8>>>,
}

impl SourceFile {
    /// Its number.
    pub fn id(&self) -> FileId {
        self.id
    }

    /// The name shown in messages: the path as it was given.
    pub fn name(&self) -> &Arc<str> {
        &self.name
    }

    /// The path it was read from; none for text from memory.
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// The text, decompressed.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// The bytes of a span, cut to the file.
    pub fn slice(&self, span: Span) -> &[u8] {
        let bytes = self.bytes();
        let end = (span.end() as usize).min(bytes.len());
        &bytes[(span.offset as usize).min(end)..end]
    }

    /// Line and column (both from 1) of a byte offset; an offset past the end counts as the end.
    pub fn location(&self, offset: u32) -> Location {
        let offset = offset.min(self.bytes().len() as u32);
        let line = self.line_starts().partition_point(|&start| start <= offset);
        let start = self.line_starts()[line - 1];
        let before = &self.bytes()[start as usize..offset as usize];
        let before = if line == 1 { before.strip_prefix(BOM).unwrap_or(before) } else { before };
        let column = 1 + before.iter().filter(|&&b| b & 0xC0 != 0x80).count() as u32;
        Location { path: self.name.clone(), line: line as u32, column }
    }

    /// Offsets at which lines begin; the first is 0.
    pub(crate) fn line_starts(&self) -> &[u32] {
        self.line_starts.get_or_init(|| {
            let newlines = self.bytes().iter().enumerate().filter(|&(_, &b)| b == b'\n');
            std::iter::once(0).chain(newlines.map(|(i, _)| i as u32 + 1)).collect()
        })
    }

    /// The text with every byte that is not UTF-8 replaced by `?`, offsets unchanged, for reports.
    pub(crate) fn printable(&self) -> &[u8] {
        self.printable.get_or_init(|| replace_invalid(self.bytes())).as_deref().unwrap_or(self.bytes())
    }
}

/// The UTF-8 byte order mark.
pub(crate) const BOM: &[u8] = b"\xEF\xBB\xBF";

/// A copy with invalid UTF-8 replaced byte by byte, or none if there is nothing to replace.
fn replace_invalid(bytes: &[u8]) -> Option<Vec<u8>> {
    std::str::from_utf8(bytes).err()?;
    let mut copy = Vec::with_capacity(bytes.len());
    for chunk in bytes.utf8_chunks() {
        copy.extend_from_slice(chunk.valid().as_bytes());
        copy.extend(std::iter::repeat_n(b'?', chunk.invalid().len()));
    }
    Some(copy)
}

impl fmt::Debug for SourceFile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "SourceFile({}, {} bytes)", self.name, self.bytes().len())
    }
}

/// All source files of a scene; clones share them.
#[derive(Clone, Debug, Default)]
pub struct SourceMap {
    files: Arc<RwLock<Vec<Arc<SourceFile>>>>,
}

impl SourceMap {
    /// Adds a file and gives it the next number.
    pub(crate) fn add(&self, name: &str, path: Option<PathBuf>, bytes: Vec<u8>) -> Arc<SourceFile> {
        let mut files = self.files.write().unwrap_or_else(PoisonError::into_inner);
        let file = Arc::new(SourceFile {
            id: FileId(files.len() as u32),
            name: name.into(),
            path,
            bytes,
            line_starts: OnceLock::new(),
            printable: OnceLock::new(),
        });
        files.push(file.clone());
        file
    }

    /// The file of that number.
    ///
    /// # Panics
    /// If `id` comes from another source map.
    pub fn file(&self, id: FileId) -> Arc<SourceFile> {
        self.files.read().unwrap_or_else(PoisonError::into_inner)[id.0 as usize].clone()
    }

    /// All files in the order in which they were opened.
    pub fn files(&self) -> Vec<Arc<SourceFile>> {
        self.files.read().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// How many files there are.
    pub fn len(&self) -> usize {
        self.files.read().unwrap_or_else(PoisonError::into_inner).len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The span with its file.
    pub fn place(&self, span: Span) -> Place {
        Place { source: self.file(span.file), span }
    }

    /// Path, line and column of the first byte of the span.
    pub fn location(&self, span: Span) -> Location {
        self.place(span).location()
    }
}
