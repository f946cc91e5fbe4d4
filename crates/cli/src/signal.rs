//! SIGINT, SIGTERM and SIGHUP: the first asks the run to end well, a second one ends it at once.

use std::io;
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
pub fn watch() -> io::Result<Stop> {
    watch_and(|| {})
}

/// Watches as [`watch`] does, and calls `on_first` at the first signal, after the flag is set.
///
/// A signal that is ignored on purpose stays so, as SIGHUP under `nohup` and SIGINT in the background of a script; the others
/// are watched for.
///
/// # Errors
/// If the system refuses a handler.
pub fn watch_and(on_first: impl Fn() + Send + 'static) -> io::Result<Stop> {
    let stop = Stop::new();
    let flag = stop.clone();
    // runs on a thread of its own, not inside the signal handler, so any call is allowed
    system::on_signal(move || {
        if flag.again() {
            std::process::exit(130);
        }
        on_first();
        tracing::warn!("stopping after the work in hand; interrupt again to end at once");
    })?;
    Ok(stop)
}

/// Lets writes beyond a limit on the size of files (`ulimit -f`) fail with an error, where the signal would end the process
/// without a word.
///
/// # Errors
/// If the system refuses a handler.
pub fn survive_file_limits() -> io::Result<()> {
    #[cfg(unix)]
    signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::new(AtomicBool::new(false)))?;
    Ok(())
}

#[cfg(unix)]
mod system {
    use std::io;

    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;

    /// Calls `action` at each signal that is not ignored.
    pub fn on_signal(action: impl Fn() + Send + 'static) -> io::Result<()> {
        let ignored = ignored();
        let watched = [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|s| ignored >> (s - 1) & 1 == 0);
        let mut signals = Signals::new(watched)?;
        let watch = move || signals.forever().for_each(|_| action());
        std::thread::Builder::new().name("tyndall-signals".into()).spawn(watch).map(|_| ())
    }

    /// The signals that this process was started to ignore, one bit each from signal 1 on, as Linux tells it. Other systems do not
    /// tell: there all are watched for.
    fn ignored() -> u64 {
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let mask = status.lines().find_map(|l| l.strip_prefix("SigIgn:"));
        mask.and_then(|m| u64::from_str_radix(m.trim(), 16).ok()).unwrap_or(0)
    }
}

#[cfg(not(unix))]
mod system {
    use std::io;

    /// Calls `action` at each interruption.
    pub fn on_signal(action: impl Fn() + Send + 'static) -> io::Result<()> {
        ctrlc::set_handler(action).map_err(io::Error::other)
    }
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
