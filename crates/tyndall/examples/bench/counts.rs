//! Instructions under callgrind: the same on a busy machine and on an idle one, so that a change of one in a thousand shows.
//!
//! This program runs itself under valgrind twice with different numbers of calls; the difference knows nothing of start-up.

use crate::{inner, process::is_there, setup::Setup, store};
use serde_json::json;
use std::{hint::black_box, path::Path, process::Command};

/// Calls of the shorter run; the longer one does three times as many.
const CALLS: u32 = 400;
/// The same for whole samples, on every pixel of a small film.
const SAMPLES: u32 = 1;

/// Counts instructions of every loop, or says that there is no valgrind.
pub fn all(setup: &Setup) -> Result<(), String> {
    if !is_there(Path::new("valgrind")) {
        eprintln!("instruction counts: no program `valgrind`, left out");
        return Ok(());
    }
    for (index, l) in inner::loops(setup)?.iter().enumerate() {
        let calls = if l.calls > 1.0 { SAMPLES } else { CALLS };
        let (few, many) = (count(setup, index, calls)?, count(setup, index, 3 * calls)?);
        let instructions = (many - few) / (2.0 * f64::from(calls) * l.calls);
        eprintln!("{:60} {instructions:12.1} instructions", l.name);
        store::line(
            &setup.folder,
            &json!({ "kind": "count", "loop": l.name, "instructions": instructions }),
        )?;
    }
    Ok(())
}

/// Runs one loop: what valgrind looks at.
pub fn one(setup: &Setup, index: usize, calls: u32) -> Result<(), String> {
    let mut all = inner::loops(setup)?;
    let l = all.get_mut(index).ok_or_else(|| format!("no loop {index}"))?;
    if l.calls > 1.0 {
        // what is worked out when it is first asked for, such as the spectra of an image's colours, is no part of a sample
        black_box((l.run)(3 * SAMPLES)?);
    }
    black_box((l.run)(calls)?);
    Ok(())
}

fn count(setup: &Setup, index: usize, calls: u32) -> Result<f64, String> {
    let program = std::env::current_exe().map_err(|e| format!("this program's path: {e}"))?;
    let mut command = Command::new("valgrind");
    command.args(["--tool=callgrind", "--callgrind-out-file=/dev/null"]).arg(program);
    command.arg("count-one").arg(&setup.folder).arg(index.to_string()).arg(calls.to_string());
    let output = command.output().map_err(|e| format!("valgrind: {e}"))?;
    let text = String::from_utf8_lossy(&output.stderr);
    if !output.status.success() {
        return Err(format!("{command:?}: {}\n{text}", output.status));
    }
    collected(&text).ok_or_else(|| format!("callgrind told no number of instructions:\n{text}"))
}

/// The number in callgrind's last words.
fn collected(text: &str) -> Option<f64> {
    let line = text.lines().rev().find(|l| l.contains("Collected"))?;
    line.rsplit(':').next()?.trim().parse().ok()
}

#[cfg(test)]
mod tests {
    use super::collected;

    #[test]
    fn callgrind_s_last_words() {
        let text =
            "==7== Events    : Ir\n==7== Collected : 18201234\n==7== \n==7== I   refs:      18,201,234\n";
        assert_eq!(collected(text), Some(18_201_234.0));
        assert_eq!(collected("==7== Fatal error"), None);
    }
}
