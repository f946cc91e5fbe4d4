//! Signals: the first sets a flag, a second one ends the process with 130.
#![cfg(unix)]

use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use tyndall_cli::signal;

/// Set for the copy of this test program that waits for signals.
const WAITING: &str = "TYNDALL_TEST_WAITS";

/// Not a test of its own: what the copy does. It ends well (0) once asked to, and with 1 if nobody asks.
#[test]
fn wait_for_signals() {
    let Ok(mode) = std::env::var(WAITING) else { return };
    let stop = signal::watch().expect("the first handler of this process");
    std::fs::write(std::env::var("READY").expect("set beside the mode"), "").expect("writable");
    let start = Instant::now();
    while start.elapsed() < Duration::from_secs(30) {
        // the stubborn copy goes on working after the first signal
        if stop.requested() && mode == "well" {
            std::process::exit(0);
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    std::process::exit(1);
}

fn start(mode: &str, ready: &std::path::Path) -> Child {
    let child = Command::new(std::env::current_exe().expect("known"))
        .args(["--exact", "wait_for_signals", "--nocapture"])
        .env(WAITING, mode)
        .env("READY", ready)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("starts");
    let start = Instant::now();
    while !ready.exists() {
        assert!(start.elapsed() < Duration::from_secs(30), "the copy does not start");
        std::thread::sleep(Duration::from_millis(5));
    }
    child
}

fn send(signal: &str, child: &Child) {
    let status = Command::new("kill").args(["-s", signal, &child.id().to_string()]).status();
    assert!(status.expect("kill is there").success());
}

#[test]
fn the_first_signal_asks() {
    let folder = tempfile::tempdir().expect("writable");
    for signal in ["INT", "TERM", "HUP"] {
        let mut child = start("well", &folder.path().join(signal));
        send(signal, &child);
        assert_eq!(child.wait().expect("ends").code(), Some(0), "{signal}");
    }
}

#[test]
fn the_second_signal_ends() {
    let folder = tempfile::tempdir().expect("writable");
    let mut child = start("stubborn", &folder.path().join("ready"));
    send("TERM", &child);
    // two signals of one kind that are pending at once are one
    std::thread::sleep(Duration::from_millis(300));
    assert!(child.try_wait().expect("known").is_none(), "the first one does not end it");
    send("INT", &child);
    assert_eq!(child.wait().expect("ends").code(), Some(130));
}
