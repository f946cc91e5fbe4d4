//! The buffered, seekable stream that an atomic write hands to its writer.

use super::fault::{self, FaultPoint};
use std::{
    fs::File,
    io::{self, BufWriter, Seek, SeekFrom, Write},
    path::PathBuf,
};

/// The stream of [`super::write_atomic`]: buffered, seekable, and open to fault injection.
#[derive(Debug)]
pub struct AtomicSink {
    buffer: BufWriter<CheckedFile>,
}

#[derive(Debug)]
struct CheckedFile {
    file: File,
    target: PathBuf,
}

impl AtomicSink {
    pub(super) fn new(file: File, target: &std::path::Path) -> Self {
        let checked = CheckedFile { file, target: target.to_path_buf() };
        AtomicSink { buffer: BufWriter::with_capacity(1 << 16, checked) }
    }

    /// Flushes what is buffered and returns the file.
    pub(super) fn into_file(self) -> io::Result<File> {
        self.buffer.into_inner().map(|checked| checked.file).map_err(io::IntoInnerError::into_error)
    }
}

impl Write for CheckedFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        fault::check(FaultPoint::Write, &self.target)?;
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for CheckedFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

impl Write for AtomicSink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.buffer.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.buffer.flush()
    }
}

impl Seek for AtomicSink {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.buffer.seek(to)
    }
}
