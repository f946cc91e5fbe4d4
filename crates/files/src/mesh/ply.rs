//! PLY, the Stanford triangle format: ASCII or binary of either byte order, gzipped or not.
//!
//! Own code, because a reader here must not believe the header: element counts are checked against the size
//! of the file before anything is allocated, and every message names the line or byte.

mod body;
mod build;
mod header;

use crate::{
    FileError, Place, Result,
    limits::{DEFLATE_RATIO, justify},
};
use body::{Body, Source};
use build::Builder;
use flate2::bufread::MultiGzDecoder;
use header::Header;
use std::{
    fs::File,
    io::{self, BufRead, BufReader, Read},
    path::Path,
};
use tyndall_base::{Vec2, Vec3};

/// A mesh as a PLY file has it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlyMesh {
    /// Vertex positions (`x`, `y`, `z`), finite.
    pub positions: Vec<Vec3>,
    /// Vertex normals (`nx`, `ny`, `nz`) as the file has them, not normalised; empty if it has none.
    pub normals: Vec<Vec3>,
    /// Texture coordinates (`u`, `v`, or `s`, `t`, or `texture_u`, `texture_v`, or `texture_s`, `texture_t`);
    /// empty if the file has none.
    pub uv: Vec<Vec2>,
    /// Faces of three vertices, and the fans of faces of more than four.
    pub triangles: Vec<[u32; 3]>,
    /// Faces of four vertices in the order of a bilinear patch, (0,0), (1,0), (0,1), (1,1): the file's third
    /// and fourth change places.
    pub quads: Vec<[u32; 4]>,
    /// The property `face_indices` for each of `triangles`; empty if the file has none.
    pub triangle_face_indices: Vec<i32>,
    /// The property `face_indices` for each of `quads`; empty if the file has none.
    pub quad_face_indices: Vec<i32>,
    /// Faces of more than four vertices, each turned into a fan (pbrt-v4 leaves them out).
    pub fanned_faces: usize,
    /// Faces of fewer than three vertices, left out.
    pub skipped_faces: usize,
}

/// Reads a PLY file, gzipped or not.
///
/// # Errors
/// [`FileError::Io`] when it cannot be read; [`FileError::Malformed`] with line or byte when it is damaged, lacks
/// positions or faces, has values that are not finite, or indices out of range; [`FileError::Oversized`] when
/// it announces more elements than its size can hold; [`FileError::Unsupported`] for other versions.
pub fn read_ply(path: &Path) -> Result<PlyMesh> {
    let file = File::open(path).map_err(|e| FileError::io(path, "open", e))?;
    let bytes = file.metadata().map_err(|e| FileError::io(path, "read the size", e))?.len();
    decode_ply(BufReader::with_capacity(1 << 16, file), bytes, path)
}

/// Reads a PLY mesh, gzipped or not, of `file_bytes` bytes from a stream; `path` is for messages.
///
/// # Errors
/// Those of [`read_ply`].
pub fn decode_ply(mut stream: impl BufRead, file_bytes: u64, path: &Path) -> Result<PlyMesh> {
    const GZIP_MAGIC: [u8; 2] = [0x1f, 0x8b];
    let first = stream.fill_buf().map_err(|e| FileError::io(path, "read", e))?;
    if first.starts_with(&GZIP_MAGIC) {
        let inner = BufReader::with_capacity(1 << 16, MultiGzDecoder::new(stream));
        decode(inner, file_bytes, DEFLATE_RATIO, path)
    } else {
        decode(stream, file_bytes, 1, path)
    }
}

fn decode<R: BufRead>(stream: R, file_bytes: u64, ratio: u64, path: &Path) -> Result<PlyMesh> {
    let mut source = Source::new(stream);
    let header = Header::read(&mut source, path)?;
    justify(path, "elements", header.least_bytes(), file_bytes, ratio)?;
    let mut builder = Builder::new(&header, path)?;
    let mut body = Body::new(source, header.encoding);
    for element in &header.elements {
        builder.read_element(element, &mut body)?;
    }
    // a gzip stream checks its sum only when its end is reached
    body.finish().map_err(|e| read_error(path, body.place(), e))?;
    Ok(builder.mesh)
}

/// An error in the contents, at the place that the source has reached.
fn malformed(path: &Path, place: Place, expected: impl Into<String>, got: impl Into<String>) -> FileError {
    FileError::malformed(path, place, expected, got, "the file is damaged or not PLY; export it again")
}

/// A failed read: the end of the file is the file's fault, all else the system's. A damaged gzip stream comes
/// as `InvalidData` or `InvalidInput`.
fn read_error(path: &Path, place: Place, error: io::Error) -> FileError {
    use io::ErrorKind as Kind;
    match error.kind() {
        Kind::UnexpectedEof => {
            malformed(path, place, "more data, as the header announces", "the end of the file")
        }
        Kind::InvalidData | Kind::InvalidInput => malformed(path, place, "valid data", error.to_string()),
        _ => FileError::io(path, "read", error),
    }
}

impl<R: Read> std::fmt::Debug for Source<R> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Source").field("line", &self.line).field("byte", &self.byte).finish_non_exhaustive()
    }
}
