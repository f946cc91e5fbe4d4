//! Files that appear whole or not at all: temporary file, fsync, rename, fsync of the folder.
//!
//! Each step can be made to fail, so that tests show what a full disk or a kill in that step leaves behind.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Steps of writing a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// The temporary file is created.
    Create,
    /// A block is written to it.
    Write,
    /// Its data are forced to the disk.
    Sync,
    /// The predecessor is renamed out of the way.
    Rotate,
    /// The temporary file takes the final name.
    Rename,
    /// The folder is forced to the disk.
    SyncFolder,
}

/// What happens at a step.
#[derive(Debug)]
pub enum Fault {
    /// Nothing: go on.
    None,
    /// The system refuses: the temporary file is removed, the error returned.
    Fail(io::Error),
    /// The process dies here: nothing is cleaned up. A block is half written.
    Kill,
}

/// Faults to inject; the program itself has none.
pub trait Faults: Send + Sync {
    /// What happens at a step.
    fn at(&self, _step: Step) -> Fault {
        Fault::None
    }
}

/// No faults.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoFaults;

impl Faults for NoFaults {}

/// `NAME` with `suffix` appended.
pub fn beside(path: &Path, suffix: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(suffix);
    name.into()
}

/// Writes a file whole. With `keep`, what stood there before is kept as `NAME.1`.
///
/// # Errors
/// Whatever the system says; what stood there before still stands there or in `NAME.1`.
pub fn write(
    path: &Path,
    keep: bool,
    faults: &dyn Faults,
    content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let temporary = beside(path, ".tmp");
    let mut killed = false;
    let written = write_steps(path, &temporary, keep, &mut Guard { faults, killed: &mut killed }, content);
    if written.is_err() && !killed {
        let _ = fs::remove_file(&temporary);
    }
    written
}

fn write_steps(
    path: &Path,
    temporary: &Path,
    keep: bool,
    guard: &mut Guard<'_>,
    content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    guard.check(Step::Create)?;
    let file = File::create(temporary)?;
    let mut out = BufWriter::with_capacity(1 << 20, Guarded { file: &file, guard });
    content(&mut out)?;
    out.flush()?;
    drop(out);
    guard.check(Step::Sync)?;
    file.sync_all()?;
    if keep && path.exists() {
        guard.check(Step::Rotate)?;
        fs::rename(path, beside(path, ".1"))?;
    }
    guard.check(Step::Rename)?;
    fs::rename(temporary, path)?;
    guard.check(Step::SyncFolder)?;
    sync_folder(path)
}

/// Makes the rename last: on POSIX the folder's entry has to reach the disk too.
fn sync_folder(path: &Path) -> io::Result<()> {
    let parent = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if cfg!(unix) { File::open(parent)?.sync_all() } else { Ok(()) }
}

struct Guard<'f> {
    faults: &'f dyn Faults,
    killed: &'f mut bool,
}

impl Guard<'_> {
    fn check(&mut self, step: Step) -> io::Result<()> {
        match self.faults.at(step) {
            Fault::None => Ok(()),
            Fault::Fail(error) => Err(error),
            Fault::Kill => {
                *self.killed = true;
                Err(io::Error::other("killed"))
            }
        }
    }
}

struct Guarded<'g, 'f> {
    file: &'g File,
    guard: &'g mut Guard<'f>,
}

impl Write for Guarded<'_, '_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if let Err(error) = self.guard.check(Step::Write) {
            if *self.guard.killed {
                let _ = self.file.write(&bytes[..bytes.len() / 2]);
            }
            return Err(error);
        }
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}
