//! Kills at any moment and in every step of writing a file: resuming gives the bits of an uninterrupted run.
//!
//! `cargo test -p tyndall-cli --test kills -- --ignored --nocapture` runs the long versions and tells where the kills fell.
#![cfg(unix)]

mod common;

use std::collections::BTreeMap;
use std::os::unix::fs::MetadataExt;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use common::Place;

const JOB: &str = "render --resolution 32x32 --spp 256 --bands 400:700:100 --quiet -o a.exr -o a.film --checkpoint a.ckpt \
                   --checkpoint-every 1ms";
const RESULTS: [&str; 3] = ["a.exr", "a.error.exr", "a.film.sums"];

/// A multiplicative generator (Lehmer 1951; Park & Miller 1988): the moments of the kills.
struct Moments(u64);

impl Moments {
    fn next(&mut self, below: u64) -> u64 {
        self.0 = self.0 * 48_271 % 0x7fff_ffff;
        self.0 % below
    }
}

fn start(place: &Place, line: &str, faults: &[(&str, &str)]) -> Child {
    Command::new(env!("CARGO_BIN_EXE_tyndall"))
        .current_dir(place.folder())
        .args(line.split_whitespace())
        .envs(faults.iter().copied())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("starts")
}

/// Starts the job, or goes on from its checkpoint where there is one.
fn go_on(place: &Place, job: &str, faults: &[(&str, &str)]) -> Child {
    let resume = if has_checkpoint(place) { " --resume" } else { "" };
    start(place, &format!("{job}{resume}"), faults)
}

fn has_checkpoint(place: &Place) -> bool {
    place.has("a.ckpt") || place.has("a.ckpt.1")
}

/// The results; of the film what does not tell the time: everything behind its header.
fn results(place: &Place) -> Vec<Vec<u8>> {
    RESULTS
        .iter()
        .map(|name| match name.strip_suffix(".sums") {
            None => place.read(name),
            Some(film) => {
                let bytes = place.read(film);
                let header = u64::from_le_bytes(*bytes[12..].first_chunk().expect("a film")) as usize;
                bytes[20 + header..bytes.len() - 32].to_vec()
            }
        })
        .collect()
}

/// Which files a kill has left: what the process was doing.
fn where_it_fell(place: &Place) -> &'static str {
    let names: Vec<String> = std::fs::read_dir(place.folder())
        .expect("readable")
        .map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    let has = |name: &str| names.iter().any(|n| n == name);
    let writing = names.iter().any(|n| n.starts_with(".a.") && n.ends_with(".tmp"));
    match () {
        () if has("a.ckpt.tmp") => "in a checkpoint's file",
        () if has("a.ckpt.1") && !has("a.ckpt") => "between a checkpoint's two renames",
        () if writing => "in a result's file",
        () if has("a.film") => "after the last result",
        () if has("a.exr") => "between results",
        () if has("a.ckpt.1") => "between checkpoints, two there",
        () if has("a.ckpt") => "after the first checkpoint",
        () => "before the first checkpoint",
    }
}

/// Waits for no, one or several checkpoints, or for the first result, and then for a random time: a busy machine changes only
/// how long that takes.
fn wait_for_a_moment(place: &Place, child: &mut Child, moments: &mut Moments) {
    let stamp = || {
        let meta = std::fs::metadata(place.path("a.ckpt")).ok()?;
        Some((meta.ino(), meta.mtime_nsec()))
    };
    let (checkpoints, mut seen, mut last) = (moments.next(8), 0, stamp());
    let enough = |seen: u64| if checkpoints == 7 { place.has("a.exr") } else { seen >= checkpoints };
    while !enough(seen) && child.try_wait().expect("known").is_none() {
        let now = stamp();
        seen += u64::from(now.is_some() && now != last);
        last = now.or(last);
        std::thread::sleep(Duration::from_millis(1));
    }
    std::thread::sleep(Duration::from_micros(moments.next(20_000)));
}

fn random_kills(wanted: u32) {
    let whole = Place::new();
    whole.ok(JOB);
    let expected = results(&whole);
    let (mut kills, mut jobs, mut fell) = (0, 0, BTreeMap::<&str, u32>::new());
    let mut moments = Moments(20_010_101);
    let mut place = Place::new();
    while kills < wanted {
        let mut child = go_on(&place, JOB, &[]);
        wait_for_a_moment(&place, &mut child, &mut moments);
        if let Some(status) = child.try_wait().expect("known") {
            assert_eq!(status.code(), Some(0), "job {jobs}");
            assert!(results(&place) == expected, "job {jobs}: other bits after {kills} kills");
            jobs += 1;
            place = Place::new();
            continue;
        }
        child.kill().expect("it runs");
        child.wait().expect("ends");
        kills += 1;
        *fell.entry(where_it_fell(&place)).or_default() += 1;
    }
    assert_eq!(go_on(&place, JOB, &[]).wait().expect("ends").code(), Some(0));
    assert!(results(&place) == expected, "other bits at the end");
    println!("{kills} kills, {} jobs to their end, no bit differs", jobs + 1);
    fell.iter().for_each(|(place, n)| println!("{n:4}  {place}"));
}

#[test]
fn random_kills_lose_nothing() {
    random_kills(10);
}

#[test]
#[ignore = "a minute; the short version runs always"]
fn a_hundred_random_kills_lose_nothing() {
    random_kills(100);
}

#[cfg(target_os = "linux")]
mod every_step {
    use super::*;
    use std::path::PathBuf;

    /// Few samples, a checkpoint after each patch.
    const SHORT: &str = "render --resolution 16x16 --spp 12 --quiet -o a.exr -o a.film --checkpoint a.ckpt --checkpoint-every 0s";

    /// Compiles the faults; whoever links Rust has a C compiler.
    fn shim(place: &Place) -> PathBuf {
        let library = place.path("faults.so");
        let source = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/faults.c");
        let mut cc = Command::new("cc");
        cc.args(["-shared", "-fPIC", "-O1", "-o"]).arg(&library).arg(source).arg("-ldl");
        assert!(cc.status().expect("a C compiler").success());
        library
    }

    /// Runs the job with a fault in its n-th call; the call's name, `None` when the job ended before.
    fn faulty(place: &Place, library: &PathBuf, fault: &str, at: u32) -> (i32, Option<String>) {
        let (log, at) = (place.path("call"), at.to_string());
        let text = |path: &PathBuf| path.to_str().expect("plain").to_owned();
        let (library, log_name) = (text(library), text(&log));
        let faults = [
            ("LD_PRELOAD", library.as_str()),
            ("TYNDALL_FAULT", fault),
            ("TYNDALL_FAULT_AT", &at),
            ("TYNDALL_FAULT_LOG", &log_name),
        ];
        let status = go_on(place, SHORT, &faults).wait().expect("ends");
        (status.code().unwrap_or(-1), std::fs::read_to_string(&log).ok().map(|s| s.trim().to_owned()))
    }

    fn kills_in_every(step: usize) {
        let tools = Place::new();
        let library = shim(&tools);
        let whole = Place::new();
        whole.ok(SHORT);
        let expected = results(&whole);
        let (mut kills, mut calls) = (0, BTreeMap::<String, u32>::new());
        for fault in ["kill", "after"] {
            for at in (1..1000).step_by(step) {
                let place = Place::new();
                let (code, call) = faulty(&place, &library, fault, at);
                let Some(call) = call else {
                    assert_eq!(code, 0, "no fault at {at}");
                    break;
                };
                assert_eq!(code, -1, "killed in call {at}");
                kills += 1;
                *calls.entry(format!("{fault} {call}: {}", where_it_fell(&place))).or_default() += 1;
                assert_eq!(
                    go_on(&place, SHORT, &[]).wait().expect("ends").code(),
                    Some(0),
                    "{fault} {at} {call}"
                );
                assert!(results(&place) == expected, "other bits after {fault} in call {at}, {call}");
                assert!(!has_checkpoint(&place), "a finished job leaves no checkpoint");
            }
        }
        println!("{kills} kills in calls that write, no bit differs");
        calls.iter().for_each(|(call, n)| println!("{n:4}  {call}"));
        assert!(calls.len() > 3, "kills fell in too few kinds of calls");
    }

    #[test]
    fn kills_in_steps_of_writing_lose_nothing() {
        kills_in_every(7);
    }

    #[test]
    #[ignore = "a minute; the short version runs always"]
    fn kills_in_every_step_of_writing_lose_nothing() {
        kills_in_every(1);
    }

    /// A disk that is full or fails from the n-th call on: a message and exit code 1, never a broken result.
    #[test]
    fn a_failing_disk_is_told_and_leaves_whole_files() {
        let tools = Place::new();
        let library = shim(&tools);
        let whole = Place::new();
        whole.ok(SHORT);
        let expected = results(&whole);
        for (fault, at) in [("ENOSPC", 1), ("ENOSPC", 19), ("EIO", 7), ("EIO", 26)] {
            let place = Place::new();
            let (code, call) = faulty(&place, &library, fault, at);
            assert!(call.is_some(), "{fault} {at}");
            assert_eq!(code, 1, "{fault} {at}");
            let names = std::fs::read_dir(place.folder()).expect("readable");
            for name in names.map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned()) {
                assert!(!name.ends_with(".tmp"), "{fault} {at} leaves {name}");
            }
            // once there is room again
            assert_eq!(go_on(&place, SHORT, &[]).wait().expect("ends").code(), Some(0), "{fault} {at}");
            assert!(results(&place) == expected, "{fault} {at}");
        }
    }
}
