//! Runs programs, and asks the system what they took.

use std::{
    path::Path,
    process::{Command, Stdio},
    thread,
    time::{Duration, Instant},
};

/// What a run took.
#[derive(Clone, Copy, Debug)]
pub struct Ran {
    /// Wall clock \[s\].
    pub seconds: f64,
    /// User CPU \[s\], in the kernel's hundredths.
    pub user_seconds: f64,
    /// Greatest memory in use \[bytes\].
    pub bytes: u64,
}

/// Runs a program to its end; its memory is looked at every half millisecond.
pub fn watched(command: &mut Command) -> Result<Ran, String> {
    let before = children_seconds()?;
    let start = Instant::now();
    let spawned = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn();
    let mut child = spawned.map_err(|e| format!("cannot run {command:?}: {e}"))?;
    let status = format!("/proc/{}/status", child.id());
    let mut bytes = 0;
    let ended = loop {
        if let Some(ended) = child.try_wait().map_err(|e| format!("{command:?}: {e}"))? {
            break ended;
        }
        bytes = bytes.max(peak(&status).unwrap_or(0));
        thread::sleep(Duration::from_micros(500));
    };
    let seconds = start.elapsed().as_secs_f64();
    if !ended.success() {
        return Err(format!("{command:?}: {ended}\n{}", complaint(child.stderr.take())));
    }
    Ok(Ran { seconds, user_seconds: children_seconds()? - before, bytes })
}

/// Wall clock seconds of a program, without anybody looking at it meanwhile.
pub fn timed(command: &mut Command) -> Result<f64, String> {
    command.stdout(Stdio::null()).stderr(Stdio::null());
    let start = Instant::now();
    let status = command.status().map_err(|e| format!("cannot run {command:?}: {e}"))?;
    let seconds = start.elapsed().as_secs_f64();
    if status.success() { Ok(seconds) } else { Err(format!("{command:?}: {status}")) }
}

/// Whether a program answers at all.
pub fn is_there(program: &Path) -> bool {
    Command::new(program).arg("--help").stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok()
}

fn complaint(stderr: Option<impl std::io::Read>) -> String {
    let mut text = String::new();
    let _ = stderr.map(|mut s| s.read_to_string(&mut text));
    text.trim().to_owned()
}

/// Peak resident memory of a process that lives.
fn peak(status: &str) -> Option<u64> {
    let text = std::fs::read_to_string(status).ok()?;
    let line = text.lines().find_map(|l| l.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(1024 * kibibytes)
}

/// User CPU seconds of the children that have ended, in the kernel's hundredths.
fn children_seconds() -> Result<f64, String> {
    let stat = std::fs::read_to_string("/proc/self/stat").map_err(|e| format!("CPU time of a child: {e}"))?;
    // the name in brackets may hold blanks; cutime is the 14th number after it
    let after = stat.rsplit_once(')').map_or("", |(_, rest)| rest);
    let ticks = after.split_whitespace().nth(13).and_then(|t| t.parse::<f64>().ok());
    ticks.map(|t| t / 100.0).ok_or_else(|| "CPU time of a child: /proc/self/stat is not as expected".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn user_time_and_memory_of_a_child() {
        let work = "i=0; while [ $i -lt 60000 ]; do i=$((i+1)); done";
        let ran = watched(Command::new("sh").args(["-c", work])).expect("sh runs");
        assert!(ran.user_seconds > 0.0 && ran.seconds > 0.0, "{ran:?}");
        assert!(ran.bytes > 100_000, "{ran:?}");
        let error =
            watched(Command::new("sh").args(["-c", "echo no lamp >&2; exit 3"])).expect_err("it fails");
        assert!(error.contains("no lamp") && error.contains('3'), "{error}");
        assert!(!is_there(Path::new("/nonexistent/renderer")));
    }
}
