//! Files into memory: decompressed where gzipped, refused where not text.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use std::sync::Arc;

use crate::error::{Error, ErrorKind};
use crate::source::{BOM, SourceFile, SourceMap};
use crate::span::{Place, Span};

/// Offsets have 32 bits, and spans end before the last of them.
const MAX_BYTES: u64 = u32::MAX as u64 - 1;

/// How much of a file is looked through for bytes that no text has, before parsing starts.
const SNIFF: usize = 4096;

/// Reads `path`, shown in messages as `name`.
pub(crate) fn load_file(sources: &SourceMap, path: &Path, name: &str) -> Result<Arc<SourceFile>, Error> {
    let bytes = read_bytes(path).map_err(|kind| Error::in_file(kind, name))?;
    add_text(sources, name, Some(path), bytes)
}

/// Takes text from memory.
pub(crate) fn load_bytes(sources: &SourceMap, name: &str, bytes: Vec<u8>) -> Result<Arc<SourceFile>, Error> {
    let bytes = decompress(bytes).map_err(|kind| Error::in_file(kind, name))?;
    add_text(sources, name, None, bytes)
}

fn add_text(
    sources: &SourceMap,
    name: &str,
    path: Option<&Path>,
    bytes: Vec<u8>,
) -> Result<Arc<SourceFile>, Error> {
    let file = sources.add(name, path.map(Path::to_owned), bytes);
    check_text(&file)?;
    Ok(file)
}

fn read_bytes(path: &Path) -> Result<Vec<u8>, ErrorKind> {
    let mut file = File::open(path).map_err(ErrorKind::Io)?;
    let meta = file.metadata().map_err(ErrorKind::Io)?;
    if meta.is_dir() {
        return Err(ErrorKind::Io(io::Error::new(io::ErrorKind::IsADirectory, "it is a directory")));
    }
    check_size(meta.len())?;
    // not mapped: whoever cuts a mapped file short while it is parsed kills the process
    let mut bytes = Vec::new();
    let refused =
        |e: std::collections::TryReserveError| ErrorKind::Io(io::Error::new(io::ErrorKind::OutOfMemory, e));
    bytes.try_reserve_exact(meta.len() as usize).map_err(refused)?;
    file.by_ref().take(MAX_BYTES + 1).read_to_end(&mut bytes).map_err(ErrorKind::Io)?;
    check_size(bytes.len() as u64)?;
    let after = file.metadata().map_err(ErrorKind::Io)?;
    if (meta.len(), meta.modified().ok()) != (after.len(), after.modified().ok()) {
        return Err(ErrorKind::Changed);
    }
    decompress(bytes)
}

fn check_size(bytes: u64) -> Result<(), ErrorKind> {
    if bytes > MAX_BYTES { Err(ErrorKind::TooLarge { bytes }) } else { Ok(()) }
}

/// Unpacks gzip, which is known by its first bytes and not by the file's name.
fn decompress(bytes: Vec<u8>) -> Result<Vec<u8>, ErrorKind> {
    if !bytes.starts_with(b"\x1f\x8b") {
        return Ok(bytes);
    }
    let mut text = Vec::new();
    let decoder = flate2::read::MultiGzDecoder::new(bytes.as_slice());
    decoder.take(MAX_BYTES + 1).read_to_end(&mut text).map_err(ErrorKind::Gzip)?;
    check_size(text.len() as u64)?;
    Ok(text)
}

/// Refuses UTF-16 and anything with a NUL near its start.
fn check_text(file: &Arc<SourceFile>) -> Result<(), Error> {
    let bytes = file.bytes();
    if bytes.starts_with(b"\xFF\xFE") || bytes.starts_with(b"\xFE\xFF") {
        return Err(Error::in_file(ErrorKind::Utf16, &**file.name()).hint("save the file as UTF-8"));
    }
    match bytes.iter().take(SNIFF).position(|&b| b == 0) {
        Some(offset) => Err(binary(file, offset)),
        None => Ok(()),
    }
}

/// The error for a byte that no text has.
pub(crate) fn binary(file: &Arc<SourceFile>, offset: usize) -> Error {
    let span = Span { file: file.id(), offset: offset as u32, len: 1 };
    let place = Place { source: file.clone(), span };
    Error::new(ErrorKind::Binary { byte: file.bytes()[offset], offset }, place)
        .hint("is this an image, a mesh or a volume instead of a scene file, or is it damaged?")
}

/// Where the text starts: after a byte order mark.
pub(crate) fn text_start(bytes: &[u8]) -> usize {
    if bytes.starts_with(BOM) { BOM.len() } else { 0 }
}
