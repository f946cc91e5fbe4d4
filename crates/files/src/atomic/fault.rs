//! Fault injection: a hook that is asked before each step of an atomic write, for tests of disks that fail
//! and of processes that die at that very moment.

use std::{
    io,
    path::Path,
    sync::{
        Arc, PoisonError, RwLock,
        atomic::{AtomicBool, Ordering},
    },
};

/// A step of an atomic write.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FaultPoint {
    /// Before the temporary file is created.
    Create,
    /// Before a block of bytes goes to the temporary file.
    Write,
    /// Before the temporary file's `fsync`.
    Sync,
    /// Before the temporary file is renamed to the result.
    Rename,
    /// After the rename, before the folder's `fsync`.
    SyncFolder,
}

/// Asked at each point with the result's path; an error makes that step fail with it.
pub type FaultHook = dyn Fn(FaultPoint, &Path) -> io::Result<()> + Send + Sync;

static ARMED: AtomicBool = AtomicBool::new(false);
static HOOK: RwLock<Option<Arc<FaultHook>>> = RwLock::new(None);

/// Installs a hook for the whole process, or removes it with `None`. Meant for tests only.
pub fn set_fault_hook(hook: Option<Arc<FaultHook>>) {
    let mut slot = HOOK.write().unwrap_or_else(PoisonError::into_inner);
    ARMED.store(hook.is_some(), Ordering::SeqCst);
    *slot = hook;
}

pub(super) fn check(point: FaultPoint, target: &Path) -> io::Result<()> {
    if !ARMED.load(Ordering::Relaxed) {
        return Ok(());
    }
    let hook = HOOK.read().unwrap_or_else(PoisonError::into_inner).clone();
    hook.map_or(Ok(()), |hook| hook(point, target))
}
