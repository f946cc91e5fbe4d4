//! A result is whole or not there: every fault at every step, and what is in the way of a file.

use std::{
    fs,
    io::{self, Read, Seek, SeekFrom, Write},
    path::{Path, PathBuf},
    sync::{Arc, Mutex, MutexGuard, PoisonError},
};
use tyndall_files::{
    FileError,
    atomic::{FaultPoint, remove_stale_temporaries, set_fault_hook, write_atomic, write_bytes_atomic},
};

/// The hook is one for the process: tests that set it take turns.
static TURN: Mutex<()> = Mutex::new(());

struct Fault<'a>(#[allow(dead_code, reason = "held for its lifetime")] MutexGuard<'a, ()>);

impl Fault<'_> {
    fn at(point: FaultPoint, path: &Path, kind: io::ErrorKind) -> Self {
        let turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
        let target = path.to_path_buf();
        set_fault_hook(Some(Arc::new(
            move |at, of: &Path| {
                if at == point && of == target { Err(kind.into()) } else { Ok(()) }
            },
        )));
        Fault(turn)
    }
}

impl Drop for Fault<'_> {
    fn drop(&mut self) {
        set_fault_hook(None);
    }
}

fn files_in(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> = fs::read_dir(folder)
        .expect("a folder of ours")
        .map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

#[test]
fn writes_and_replaces() {
    let folder = folder();
    let path = folder.path().join("result.bin");
    write_bytes_atomic(&path, b"first").expect("writable");
    assert_eq!(fs::read(&path).expect("there"), b"first");
    let value = write_atomic(&path, |sink| {
        sink.write_all(b"......")?;
        sink.seek(SeekFrom::Start(0))?;
        sink.write_all(b"sec")?;
        Ok(42)
    });
    assert_eq!(value.expect("writable"), 42);
    assert_eq!(fs::read(&path).expect("there"), b"sec...");
    assert_eq!(files_in(folder.path()), ["result.bin"], "no temporary file is left");
}

#[test]
fn a_fault_at_any_step_leaves_the_old_file_and_no_other() {
    for point in [FaultPoint::Create, FaultPoint::Write, FaultPoint::Sync, FaultPoint::Rename] {
        for kind in [io::ErrorKind::StorageFull, io::ErrorKind::PermissionDenied, io::ErrorKind::Other] {
            let folder = folder();
            let path = folder.path().join("result.bin");
            write_bytes_atomic(&path, b"old").expect("writable");
            let fault = Fault::at(point, &path, kind);
            let error = write_bytes_atomic(&path, &[7; 300_000]).expect_err("the fault");
            drop(fault);
            assert!(error.to_string().starts_with(&path.display().to_string()), "{error}");
            assert_eq!(fs::read(&path).expect("still there"), b"old", "{point:?}");
            assert_eq!(files_in(folder.path()), ["result.bin"], "{point:?} {kind:?}");
        }
    }
}

#[test]
fn a_fault_after_the_rename_is_reported_with_the_new_file_in_place() {
    let folder = folder();
    let path = folder.path().join("result.bin");
    let fault = Fault::at(FaultPoint::SyncFolder, &path, io::ErrorKind::Other);
    write_bytes_atomic(&path, b"new").expect_err("the fault");
    drop(fault);
    assert_eq!(fs::read(&path).expect("there"), b"new");
}

#[test]
fn a_full_disk_says_so() {
    let folder = folder();
    let path = folder.path().join("a");
    let _fault = Fault::at(FaultPoint::Write, &path, io::ErrorKind::StorageFull);
    let error = write_bytes_atomic(&path, b"x").expect_err("full");
    assert!(error.to_string().contains("the disk is full"), "{error}");
}

#[cfg(target_os = "linux")]
#[test]
fn the_systems_own_full_disk() {
    // /dev/full refuses every write with ENOSPC
    let error = write_bytes_atomic(Path::new("/dev/full"), &[0; 9]).expect_err("full");
    assert!(error.to_string().contains("the disk is full"), "{error}");
    write_bytes_atomic(Path::new("/dev/null"), &[0; 9]).expect("takes everything");
    assert!(!fs::metadata("/dev/null").expect("there").is_file(), "it is still a device");
}

#[test]
fn a_failing_writer_leaves_nothing() {
    let folder = folder();
    let path = folder.path().join("result.bin");
    let result = write_atomic(&path, |sink| -> io::Result<()> {
        sink.write_all(&[1; 100_000])?;
        Err(io::Error::other("no more data"))
    });
    assert!(result.expect_err("it failed").to_string().contains("no more data"));
    assert_eq!(files_in(folder.path()), Vec::<String>::new());
}

#[test]
fn what_stands_in_the_way() {
    let folder = folder();
    let error = |path: &Path| write_bytes_atomic(path, b"x").expect_err("refused").to_string();
    assert!(error(&folder.path().join("no/such/folder/a")).contains("the folder exists"));
    assert!(error(folder.path()).contains("this is a folder"));
    let file = folder.path().join("file");
    fs::write(&file, "x").expect("writable");
    let below = error(&file.join("a"));
    assert!(below.contains("a file, not a folder"), "{below}");
    let mut permissions = fs::metadata(&file).expect("there").permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&file, permissions).expect("ours");
    assert!(error(&file).contains("check the permissions"));
    assert_eq!(fs::read(&file).expect("there"), b"x");
    assert!(matches!(write_bytes_atomic(Path::new("/"), b"x"), Err(FileError::Io { .. })));
}

#[cfg(unix)]
#[test]
fn links_and_permissions_stay() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let folder = folder();
    let (file, link) = (folder.path().join("file"), folder.path().join("link"));
    fs::write(&file, "old").expect("writable");
    fs::set_permissions(&file, PermissionsExt::from_mode(0o640)).expect("ours");
    symlink(&file, &link).expect("supported");
    write_bytes_atomic(&link, b"new").expect("writable");
    assert_eq!(fs::read(&file).expect("there"), b"new");
    assert!(fs::symlink_metadata(&link).expect("there").is_symlink());
    assert_eq!(fs::metadata(&file).expect("there").permissions().mode() & 0o777, 0o640);
    let (dangling, target) = (folder.path().join("dangling"), folder.path().join("later"));
    symlink("later", &dangling).expect("supported");
    write_bytes_atomic(&dangling, b"new").expect("writable");
    assert_eq!(fs::read(target).expect("there"), b"new");
}

#[cfg(unix)]
#[test]
fn a_new_file_is_as_readable_as_any_other() {
    use std::os::unix::fs::PermissionsExt;
    let folder = folder();
    let (ours, plain) = (folder.path().join("ours"), folder.path().join("plain"));
    write_bytes_atomic(&ours, b"x").expect("writable");
    fs::write(&plain, "x").expect("writable");
    let mode = |path: &PathBuf| fs::metadata(path).expect("there").permissions().mode();
    assert_eq!(mode(&ours), mode(&plain));
}

#[test]
fn a_relative_name_without_a_folder() {
    let name = format!("tyndall-atomic-{}.tmp-test", std::process::id());
    write_bytes_atomic(Path::new(&name), b"x").expect("the current folder is writable");
    let mut text = String::new();
    fs::File::open(&name).and_then(|mut f| f.read_to_string(&mut text)).expect("there");
    fs::remove_file(&name).expect("ours");
    assert_eq!(text, "x");
}

#[test]
fn stale_temporaries_of_this_file_only() {
    let folder = folder();
    for name in [".a.exr.Ab12cD.tmp", ".a.exr.b.Ab12cD.tmp", ".b.exr.Ab12cD.tmp", "a.exr", ".a.exr.Ab1.tmp"] {
        fs::write(folder.path().join(name), "x").expect("writable");
    }
    let removed = remove_stale_temporaries(&folder.path().join("a.exr")).expect("listable");
    assert_eq!(removed, 1);
    assert_eq!(
        files_in(folder.path()),
        [".a.exr.Ab1.tmp", ".a.exr.b.Ab12cD.tmp", ".b.exr.Ab12cD.tmp", "a.exr"]
    );
}
