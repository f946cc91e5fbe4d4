//! SIGINT, SIGTERM and SIGHUP: the first asks the run to end well, a second one ends it at once.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Set once the run has been asked to end. Clones share the flag.
#[derive(Clone, Debug, Default)]
pub struct Stop(Arc<AtomicBool>);

impl Stop {
    /// A flag that no signal sets.
    pub fn new() -> Self {
        Self::default()
    }

    /// Asks the run to end.
    pub fn request(&self) {
        self.0.store(true, Ordering::SeqCst);
    }

    /// Whether the run has been asked to end.
    pub fn requested(&self) -> bool {
        self.0.load(Ordering::SeqCst)
    }

    /// Asks the run to end; tells whether that had been asked before.
    fn again(&self) -> bool {
        self.0.swap(true, Ordering::SeqCst)
    }
}

/// Watches for signals from now on. The first one sets the flag; a second one ends the process with 130.
///
/// # Errors
/// If the system refuses a handler.
pub fn watch() -> Result<Stop, ctrlc::Error> {
    watch_and(|| {})
}

/// Watches as [`watch`] does, and calls `on_first` at the first signal, after the flag is set.
///
/// A signal that is ignored on purpose stays so, as under `nohup` or in the background of a script; then none is watched
/// for, and a signal that is not ignored ends the process at once.
///
/// # Errors
/// If the system refuses a handler.
pub fn watch_and(on_first: impl Fn() + Send + 'static) -> Result<Stop, ctrlc::Error> {
    let stop = Stop::new();
    let flag = stop.clone();
    // runs on a thread of its own, not inside the signal handler, so any call is allowed
    let watched = ctrlc::try_set_handler(move || {
        if flag.again() {
            std::process::exit(130);
        }
        on_first();
        tracing::warn!("stopping after the work in hand; interrupt again to end at once");
    });
    match watched {
        Err(ctrlc::Error::MultipleHandlers) => {
            tracing::info!(
                "started with signals ignored: an interruption leaves the last checkpoint, but no image"
            );
        }
        other => other?,
    }
    Ok(stop)
}

#[cfg(test)]
mod tests {
    use super::Stop;

    #[test]
    fn clones_share_the_flag() {
        let stop = Stop::new();
        let other = stop.clone();
        assert!(!other.requested());
        stop.request();
        assert!(other.requested());
        assert!(other.again());
    }
}
