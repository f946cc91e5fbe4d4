//! Results that appear whole or not at all: temporary file in the same folder, `fsync`, `rename`, `fsync`
//! of the folder (the order that survives a power loss on a journalling file system).

mod fault;
mod sink;

pub use fault::{FaultHook, FaultPoint, set_fault_hook};
pub use sink::AtomicSink;

use crate::{FileError, Result};
use std::{
    ffi::{OsStr, OsString},
    fs, io,
    path::{Path, PathBuf},
};

/// Writes a file through `write` so that `path` holds either its old contents or all of the new ones.
///
/// A symbolic link is followed, so the link stays. A path that names a device or a pipe (`/dev/null`) is
/// written to instead of replaced. An existing file keeps its permissions.
///
/// # Errors
/// [`FileError::Io`] with the reason and a hint: missing folder, no permission, write-protected file,
/// read-only or full disk, or what `write` itself reports. The temporary file is removed on failure.
pub fn write_atomic<T>(path: &Path, write: impl FnOnce(&mut AtomicSink) -> io::Result<T>) -> Result<T> {
    let target = resolve_link(path);
    let existing = fs::metadata(&target).ok();
    refuse_unwritable(path, existing.as_ref())?;
    if existing.as_ref().is_some_and(|m| !m.is_file()) {
        return write_through(path, &target, write);
    }
    replace(&target, existing.as_ref(), write).map_err(|e| e.with_path(path))
}

/// Writes `bytes` to `path` as [`write_atomic`] does.
///
/// # Errors
/// Those of [`write_atomic`].
pub fn write_bytes_atomic(path: &Path, bytes: &[u8]) -> Result<()> {
    write_atomic(path, |sink| io::Write::write_all(sink, bytes))
}

/// Removes temporary files that a killed process left beside `path`; returns how many.
///
/// To be called only by a process that knows itself to be the only writer of `path`.
///
/// # Errors
/// [`FileError::Io`] when the folder cannot be listed or a file not removed.
pub fn remove_stale_temporaries(path: &Path) -> Result<usize> {
    let target = resolve_link(path);
    let prefix = temporary_prefix(&target);
    let mut removed = 0;
    for entry in fs::read_dir(folder_of(&target)).map_err(|e| FileError::io(path, "list the folder", e))? {
        let entry = entry.map_err(|e| FileError::io(path, "list the folder", e))?;
        if is_temporary_of(&entry.file_name(), &prefix) {
            fs::remove_file(entry.path())
                .map_err(|e| FileError::io(&entry.path(), "remove the stale temporary file", e))?;
            removed += 1;
        }
    }
    Ok(removed)
}

const TEMPORARY_SUFFIX: &str = ".tmp";

fn temporary_prefix(target: &Path) -> OsString {
    let mut prefix = OsString::from(".");
    prefix.push(target.file_name().unwrap_or_else(|| OsStr::new("result")));
    prefix.push(".");
    prefix
}

/// `.NAME.XXXXXX.tmp` with six random letters or digits: `.a.b.XXXXXX.tmp` is not a temporary of `a`.
fn is_temporary_of(name: &OsStr, prefix: &OsStr) -> bool {
    name.as_encoded_bytes()
        .strip_prefix(prefix.as_encoded_bytes())
        .and_then(|rest| rest.strip_suffix(TEMPORARY_SUFFIX.as_bytes()))
        .is_some_and(|random| random.len() == 6 && random.iter().all(u8::is_ascii_alphanumeric))
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// The file a symbolic link points to, so that renaming does not replace the link.
fn resolve_link(path: &Path) -> PathBuf {
    match fs::symlink_metadata(path) {
        Ok(meta) if meta.is_symlink() => fs::canonicalize(path)
            .or_else(|_| fs::read_link(path).map(|to| folder_of(path).join(to)))
            .unwrap_or_else(|_| path.to_path_buf()),
        _ => path.to_path_buf(),
    }
}

/// Renaming asks only for permission on the folder; a write-protected file shall stay.
fn refuse_unwritable(path: &Path, existing: Option<&fs::Metadata>) -> Result<()> {
    let refused = match existing {
        _ if path.file_name().is_none() => io::ErrorKind::IsADirectory,
        Some(meta) if meta.is_dir() => io::ErrorKind::IsADirectory,
        Some(meta) if meta.is_file() && meta.permissions().readonly() => io::ErrorKind::PermissionDenied,
        _ => return Ok(()),
    };
    Err(FileError::io(path, "write", refused.into()))
}

/// A device or pipe cannot be replaced and may not seek: collect in a nameless temporary file, then copy.
fn write_through<T>(
    path: &Path,
    target: &Path,
    write: impl FnOnce(&mut AtomicSink) -> io::Result<T>,
) -> Result<T> {
    let refused = |e| FileError::io(path, "write", e);
    let mut sink = AtomicSink::new(tempfile::tempfile().map_err(refused)?, target);
    let value = write(&mut sink).map_err(refused)?;
    let mut file = sink.into_file().map_err(refused)?;
    io::Seek::rewind(&mut file).map_err(refused)?;
    let mut device = fs::OpenOptions::new().write(true).open(target).map_err(refused)?;
    io::copy(&mut file, &mut device).map_err(refused)?;
    Ok(value)
}

fn replace<T>(
    target: &Path,
    existing: Option<&fs::Metadata>,
    write: impl FnOnce(&mut AtomicSink) -> io::Result<T>,
) -> Result<T> {
    let step = |action| move |e| FileError::io(target, action, e);
    let folder = folder_of(target);
    let (file, temporary) = create_temporary(target, folder, existing).map_err(step("create"))?;
    let mut sink = AtomicSink::new(file, target);
    let value = write(&mut sink).map_err(step("write"))?;
    let file = sink.into_file().map_err(step("write"))?;
    fault::check(FaultPoint::Sync, target).and_then(|()| file.sync_all()).map_err(step("write to disk"))?;
    drop(file);
    fault::check(FaultPoint::Rename, target)
        .and_then(|()| fs::rename(&temporary, target))
        .map_err(step("put in place"))?;
    // nothing is left under its name to remove
    let _ = temporary.keep();
    sync_folder(folder, target).map_err(step("write the folder entry to disk"))?;
    Ok(value)
}

/// Dropping the returned path removes the file: no early return leaves it behind.
fn create_temporary(
    target: &Path,
    folder: &Path,
    existing: Option<&fs::Metadata>,
) -> io::Result<(fs::File, tempfile::TempPath)> {
    fault::check(FaultPoint::Create, target)?;
    let prefix = temporary_prefix(target);
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix).suffix(TEMPORARY_SUFFIX).rand_bytes(6);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666)); // less the umask
    let (file, temporary) = builder.tempfile_in(folder).map_err(unwrap_path_error)?.into_parts();
    if let Some(meta) = existing {
        file.set_permissions(meta.permissions())?;
    }
    Ok((file, temporary))
}

/// `tempfile` wraps the reason together with a random name; keep the system's own reason.
fn unwrap_path_error(error: io::Error) -> io::Error {
    let code = error.get_ref().and_then(|inner| inner.source()?.downcast_ref::<io::Error>()?.raw_os_error());
    code.map_or(error, io::Error::from_raw_os_error)
}

fn sync_folder(folder: &Path, target: &Path) -> io::Result<()> {
    fault::check(FaultPoint::SyncFolder, target)?;
    #[cfg(unix)]
    match fs::File::open(folder).and_then(|f| f.sync_all()) {
        // the rename is done; a folder that may not be opened, or a file system that does not sync
        // folders, takes away only the guarantee against power loss in the next seconds
        Err(e) if matches!(e.kind(), io::ErrorKind::PermissionDenied | io::ErrorKind::InvalidInput) => {}
        other => other?,
    }
    #[cfg(not(unix))]
    let _ = folder;
    Ok(())
}
