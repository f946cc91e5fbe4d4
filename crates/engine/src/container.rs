//! Films on disk: checkpoints and shards share one format.
//!
//! ```text
//! 8 bytes   "TYNDFILM"
//! u32       format version
//! u64       length of the header
//! ...       header, JSON: kind, identity of the job, film, position, counts of bad samples, sizes
//! ...       one zstd stream: guide, then the film's planes as little-endian integers
//! 32 bytes  blake3 of everything before
//! ```
//!
//! Numbers are little-endian. The checksum is verified before anything in the file is believed; a film larger than the
//! caller's limit is refused before its memory is taken.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use tyndall_film::{Diagnostics, Film, FilmSpec, Guide};

use crate::atomic::{self, Faults};
use crate::{EngineError, Job, Position, Shard, State};

/// The first bytes of every file.
pub const MAGIC: [u8; 8] = *b"TYNDFILM";
/// Version of the format; a reader refuses newer ones.
pub const VERSION: u32 = 2;
/// Versions before 2 knew no pixels that share paths. Films without such pixels are still written as version 1.
const WITHOUT_SQUARES: u32 = 1;
const CHECKSUM: u64 = 32;
const LEVEL: i32 = 1;
/// No zstd stream unpacks to more: a block of 4 bytes stands for 128 KiB at most (RFC 8878, 3.1.1.2).
const EXPANSION: u64 = (128 << 10) / 4;

/// What a file says of itself.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Header {
    /// Everything that the bits depend on, see [`Job::identity`].
    pub identity: Vec<(String, String)>,
    /// The film.
    pub film: FilmSpec,
    /// Where the job stands.
    pub position: Position,
    /// Bad samples so far.
    pub diagnostics: Diagnostics,
    /// Part of the job, if it is one.
    pub shard: Option<Shard>,
    /// Sample indices of this part.
    pub samples: [u32; 2],
    /// Sample indices of the whole job.
    pub all_samples: [u32; 2],
    /// Bytes of the guide, and of each plane.
    pub sizes: Vec<u64>,
}

impl Header {
    fn new(job: &Job, film: &Film, guide: &[u8], position: &Position) -> Self {
        let (part, all) = (job.samples(), job.all_samples());
        let planes = film.planes();
        Self {
            identity: job.identity(),
            film: film.spec().as_ref().clone(),
            position: position.clone(),
            diagnostics: film.diagnostics().clone(),
            shard: job.shard,
            samples: [part.start, part.end],
            all_samples: [all.start, all.end],
            sizes: std::iter::once(guide.len())
                .chain(planes.iter().map(|(_, b)| b.len()))
                .map(|n| n as u64)
                .collect(),
        }
    }
}

/// Writes a film whole or not at all; with `keep`, its predecessor stays as `NAME.1`.
///
/// # Errors
/// Whatever the system says.
pub fn write(
    path: &Path,
    keep: bool,
    faults: &dyn Faults,
    job: &Job,
    film: &Film,
    guide: &Guide,
    position: &Position,
) -> Result<(), EngineError> {
    let guide = guide.to_bytes();
    let header = Header::new(job, film, &guide, position);
    atomic::write(path, keep, faults, |out| {
        let mut out = Hashing { inner: out, hasher: blake3::Hasher::new() };
        write_content(&mut out, &header, &guide, film)?;
        let hash = out.hasher.finalize();
        out.inner.write_all(hash.as_bytes())
    })
    .map_err(|e| EngineError::io(path, "write", e))
}

fn write_content(out: &mut dyn Write, header: &Header, guide: &[u8], film: &Film) -> io::Result<()> {
    let json = serde_json::to_vec(header)?;
    out.write_all(&MAGIC)?;
    let version = if header.film.square == 1 { WITHOUT_SQUARES } else { VERSION };
    out.write_all(&version.to_le_bytes())?;
    out.write_all(&(json.len() as u64).to_le_bytes())?;
    out.write_all(&json)?;
    let mut stream = zstd::Encoder::new(out, LEVEL)?;
    stream.write_all(guide)?;
    for (_, bytes) in film.planes() {
        stream.write_all(bytes)?;
    }
    stream.finish().map(|_| ())
}

struct Hashing<'w> {
    inner: &'w mut dyn Write,
    hasher: blake3::Hasher,
}

impl Write for Hashing<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let n = self.inner.write(bytes)?;
        self.hasher.update(&bytes[..n]);
        Ok(n)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

/// Reads a film of at most `limit` bytes of sums. `accept` sees the header before memory is taken.
///
/// # Errors
/// When the file cannot be read, is damaged, too large, or `accept` refuses it.
pub fn read(
    path: &Path,
    limit: u64,
    accept: impl FnOnce(&Header) -> Result<(), EngineError>,
) -> Result<(Header, State), EngineError> {
    let mut file = File::open(path).map_err(|e| EngineError::io(path, "read", e))?;
    let length = file.metadata().map_err(|e| EngineError::io(path, "read", e))?.len();
    verify(&mut file, length, path)?;
    let mut body = BufReader::new(file).take(length - CHECKSUM);
    let header = read_header(&mut body, length, path)?;
    header.film.validate().and_then(|()| header.film.check_size(limit))?;
    let justified = u128::from(length) * u128::from(EXPANSION);
    if header.film.bytes() > justified {
        let what = format!(
            "announces {} bytes of sums, its {length} bytes can hold {justified}",
            header.film.bytes()
        );
        return Err(EngineError::damaged(path, what));
    }
    accept(&header)?;
    let state = read_state(&mut body, &header, path)?;
    Ok((header, state))
}

/// Checks the checksum over the whole file, in constant memory.
fn verify(file: &mut File, length: u64, path: &Path) -> Result<(), EngineError> {
    let io = |e| EngineError::io(path, "read", e);
    let start = MAGIC.len() as u64;
    if length < start + 12 + CHECKSUM {
        return Err(EngineError::damaged(path, format!("not a film: only {length} bytes")));
    }
    let mut magic = [0; 8];
    file.read_exact(&mut magic).map_err(io)?;
    if magic != MAGIC {
        return Err(EngineError::damaged(path, "not a film of this program"));
    }
    file.rewind().map_err(io)?;
    let mut hasher = blake3::Hasher::new();
    hasher.update_reader(file.take(length - CHECKSUM)).map_err(io)?;
    let mut stored = [0; 32];
    file.seek(SeekFrom::Start(length - CHECKSUM)).map_err(io)?;
    file.read_exact(&mut stored).map_err(io)?;
    file.rewind().map_err(io)?;
    if *hasher.finalize().as_bytes() == stored {
        return Ok(());
    }
    Err(EngineError::damaged(path, "damaged or cut short: the checksum does not match"))
}

fn read_header(body: &mut impl Read, length: u64, path: &Path) -> Result<Header, EngineError> {
    let io = |e| EngineError::io(path, "read", e);
    let mut head = [0; 20];
    body.read_exact(&mut head).map_err(io)?;
    let version = u32::from_le_bytes([head[8], head[9], head[10], head[11]]);
    if !(WITHOUT_SQUARES..=VERSION).contains(&version) {
        let here = format!("{WITHOUT_SQUARES} to {VERSION} here");
        let differences = vec![format!("format version: {version} there, {here}")];
        return Err(EngineError::OtherJob { path: path.into(), differences });
    }
    let size = u64::from_le_bytes(std::array::from_fn(|k| head[12 + k]));
    if size > length {
        return Err(EngineError::damaged(path, format!("a header of {size} bytes in a file of {length}")));
    }
    let mut json = vec![0; size as usize];
    body.read_exact(&mut json).map_err(io)?;
    serde_json::from_slice(&json).map_err(|e| EngineError::damaged(path, format!("header: {e}")))
}

fn read_state(body: &mut impl Read, header: &Header, path: &Path) -> Result<State, EngineError> {
    let damaged = |what: String| EngineError::damaged(path, what);
    let mut film = Film::new(&Arc::new(header.film.clone()))?;
    film.set_diagnostics(header.diagnostics.clone());
    let guide_size = header.sizes.first().copied().unwrap_or(0);
    let expected: Vec<u64> = film.planes().iter().map(|(_, b)| b.len() as u64).collect();
    if header.sizes.get(1..) != Some(&expected) || guide_size > 1024 + 8 * header.film.bounds.area() {
        return Err(damaged(format!("planes of {:?} bytes where {expected:?} belong", header.sizes)));
    }
    let mut stream = zstd::Decoder::new(body).map_err(|e| damaged(format!("planes: {e}")))?;
    let mut guide = vec![0; guide_size as usize];
    stream.read_exact(&mut guide).map_err(|e| damaged(format!("guide: {e}")))?;
    for (name, bytes) in film.planes_mut() {
        stream.read_exact(bytes).map_err(|e| damaged(format!("plane `{name}`: {e}")))?;
    }
    let guide = Guide::from_bytes(&guide)?;
    if guide.counts.as_ref().is_some_and(|c| c.bounds() != header.film.bounds) {
        return Err(damaged("a guide for another window".into()));
    }
    Ok(State { film, guide, position: header.position.clone() })
}
