//! Signals and kills: what is left behind, and that resuming gives the bits of an uninterrupted run.
#![cfg(unix)]

mod common;

use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use common::Place;

const JOB: &str =
    "render --resolution 32x32 --spp 96 --quiet -o a.exr --checkpoint a.ckpt --checkpoint-every 1ms";

fn start(place: &Place, line: &str) -> Child {
    Command::new(env!("CARGO_BIN_EXE_tyndall"))
        .current_dir(place.folder())
        .args(line.split_whitespace())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("starts")
}

fn signal(name: &str, child: &Child) {
    let sent = Command::new("kill").args(["-s", name, &child.id().to_string()]).status();
    assert!(sent.expect("kill is there").success());
}

/// Waits until a checkpoint is there, so that the run is in its middle.
fn wait_for(place: &Place, name: &str) {
    let start = Instant::now();
    while !place.has(name) {
        assert!(start.elapsed() < Duration::from_secs(60), "{name} does not appear");
        std::thread::sleep(Duration::from_millis(2));
    }
}

#[test]
fn an_interrupted_job_leaves_image_and_checkpoint_and_resumes_to_the_same_bits() {
    let place = Place::new();
    let mut child = start(&place, JOB);
    wait_for(&place, "a.ckpt");
    signal("TERM", &child);
    assert_eq!(child.wait().expect("ends").code(), Some(130));
    for name in ["a.exr", "a.error.exr", "a.run.json", "a.ckpt"] {
        assert!(place.has(name), "{name}");
    }
    let so_far = place.json("a.run.json")["spp"].as_f64().expect("a number");
    assert!(so_far < 96.0, "interrupted in its middle, not at {so_far} spp");
    place.ok(&format!("{JOB} --resume"));
    assert!(!place.has("a.ckpt"), "a finished job leaves no checkpoint");
    place.ok("render --resolution 32x32 --spp 96 --quiet -o b.exr");
    assert!(place.read("a.exr") == place.read("b.exr"));
    assert!(place.read("a.error.exr") == place.read("b.error.exr"));
    // resuming what is done changes nothing
    let before = std::fs::metadata(place.path("a.exr")).and_then(|m| m.modified()).expect("there");
    place.ok(&format!("{JOB} --resume"));
    assert_eq!(std::fs::metadata(place.path("a.exr")).and_then(|m| m.modified()).expect("there"), before);
}

#[test]
fn a_killed_job_resumes_to_the_same_bits() {
    let place = Place::new();
    for _ in 0..4 {
        let resume = if place.has("a.ckpt") || place.has("a.ckpt.1") { " --resume" } else { "" };
        let mut child = start(&place, &format!("{JOB}{resume}"));
        wait_for(&place, "a.ckpt");
        std::thread::sleep(Duration::from_millis(20));
        let _ = child.kill();
        child.wait().expect("ends");
    }
    if !place.has("a.exr") {
        place.ok(&format!("{JOB} --resume"));
    }
    place.ok("render --resolution 32x32 --spp 96 --quiet -o b.exr");
    assert!(place.read("a.exr") == place.read("b.exr"));
}

#[test]
fn a_checkpoint_of_another_job_is_refused_with_what_differs() {
    let place = Place::new();
    let mut child = start(&place, JOB);
    wait_for(&place, "a.ckpt");
    signal("TERM", &child);
    assert_eq!(child.wait().expect("ends").code(), Some(130));
    let other = place.run(&format!("{JOB} --seed 7 --resume --force"));
    assert!(other.refusal().contains("a.ckpt: belongs to another job"), "{}", other.err);
    assert!(other.err.contains("seed: `0` there, `7` here"), "{}", other.err);
}

#[test]
fn a_damaged_checkpoint_falls_back_to_its_predecessor() {
    let place = Place::new();
    let mut child = start(&place, JOB);
    wait_for(&place, "a.ckpt.1");
    signal("TERM", &child);
    child.wait().expect("ends");
    let whole = place.read("a.ckpt");
    place.write("a.ckpt", &whole[..whole.len() / 2]);
    let ran = place.ok(&format!("{} --resume", JOB.replace(" --quiet", "")));
    assert!(ran.err.contains("going on from a.ckpt.1"), "{}", ran.err);
    place.ok("render --resolution 32x32 --spp 96 --quiet -o b.exr");
    assert!(place.read("a.exr") == place.read("b.exr"));
}
