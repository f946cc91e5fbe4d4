//! Checkpoints: resumed equals uninterrupted, bit for bit, wherever the run was stopped and whatever broke.
#![allow(clippy::unwrap_used)] // a failure here is a failed test

mod common;

use std::fs;
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;

use common::{Hashed, Notes, Shape, StopAfter, cropped, film, spec};
use tyndall_engine::atomic::{Fault, Faults, Step};
use tyndall_engine::{Cancel, Checkpoints, End, EngineError, Job, Run, Silent, Sink, State, Target, Threads};
use tyndall_film::{ErrorMode, Film};
use tyndall_testkit::Rng;

fn job() -> Job {
    Job {
        target: Some(Target { pilot: 16, ..Target::luminance(0.2) }),
        ..Job::new(cropped(ErrorMode::REPLICATED), 400)
    }
}

fn go(
    job: &Job,
    pass: &Hashed,
    state: State,
    checkpoints: &Checkpoints,
    cancel: &Cancel,
    sink: &mut dyn Sink,
) -> End {
    let backend = Threads::new(2);
    let run = Run { job, pass, backend: &backend, cancel, checkpoints: Some(checkpoints) };
    run.resume(state, sink).unwrap().end
}

/// Stops after every possible number of patches; each time the rest gives the bits of the whole.
#[test]
fn a_run_stopped_anywhere_resumes_to_the_same_bits() {
    let pass = Hashed::new(3, Shape::Mixed);
    for job in [job(), Job::new(cropped(ErrorMode::Conservative), 33)] {
        let whole = film(&job, &pass, 1);
        let folder = tempfile::tempdir().unwrap();
        let checkpoints = Checkpoints::new(folder.path().join("a.ckpt"), Duration::from_secs(60));
        let mut stops = 0;
        for patches in 1.. {
            let cancel = Cancel::default();
            let mut sink = StopAfter { patches, cancel: cancel.clone() };
            let end = go(&job, &pass, State::start(&job).unwrap(), &checkpoints, &cancel, &mut sink);
            let resumed = checkpoints.load(&job).unwrap();
            assert!(resumed.notes.is_empty());
            if end == End::Complete {
                assert!(resumed.state.position.is_finished() && resumed.state.film.same_bits(&whole));
                break;
            }
            stops += 1;
            go(&job, &pass, resumed.state, &checkpoints, &Cancel::default(), &mut Silent);
            let state = checkpoints.load(&job).unwrap().state;
            assert!(state.film.same_bits(&whole), "stopped after {patches} patches");
        }
        assert!(stops > 20, "{stops}");
    }
}

/// Counts steps and lets the process die at one of them.
struct DieAt {
    step: AtomicU32,
    at: u32,
    kill: bool,
}

impl Faults for DieAt {
    fn at(&self, _step: Step) -> Fault {
        let step = self.step.fetch_add(1, Ordering::Relaxed);
        match (step == self.at, self.kill) {
            (false, _) => Fault::None,
            (true, true) => Fault::Kill,
            (true, false) => Fault::Fail(io::Error::from(io::ErrorKind::StorageFull)),
        }
    }
}

/// Dies after the kill, as a process does: nothing more is written.
struct DeadAfter(Arc<DieAt>);

impl Faults for DeadAfter {
    fn at(&self, step: Step) -> Fault {
        if self.0.step.load(Ordering::Relaxed) > self.0.at { Fault::Kill } else { self.0.at(step) }
    }
}

/// Kills inside creation, every write, fsync, both renames and the folder's fsync, for several checkpoints in a row.
#[test]
fn a_kill_in_any_step_of_writing_loses_nothing_but_the_last_interval() {
    let pass = Hashed::new(3, Shape::Mixed);
    let job = Job::new(cropped(ErrorMode::REPLICATED), 40);
    let whole = film(&job, &pass, 1);
    let (mut from_newest, mut from_older, mut from_start) = (0, 0, 0);
    for at in 0..48 {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.ckpt");
        let faults = Arc::new(DieAt { step: AtomicU32::new(0), at, kill: true });
        // a checkpoint after every patch
        let dying = Checkpoints::new(&path, Duration::ZERO).with_faults(Arc::new(DeadAfter(faults)));
        let cancel = Cancel::default();
        let mut sink = StopAfter { patches: 14, cancel: cancel.clone() };
        go(&job, &pass, State::start(&job).unwrap(), &dying, &cancel, &mut sink);
        let sound = Checkpoints::new(&path, Duration::from_secs(60));
        let state = match sound.load(&job) {
            Ok(resumed) if resumed.path == path => {
                from_newest += 1;
                resumed.state
            }
            Ok(resumed) => {
                from_older += 1;
                assert!(resumed.notes[0].contains("a.ckpt"), "{:?}", resumed.notes);
                resumed.state
            }
            Err(_) => {
                from_start += 1;
                State::start(&job).unwrap()
            }
        };
        let cancel = Cancel::default();
        assert_eq!(go(&job, &pass, state, &sound, &cancel, &mut Silent), End::Complete);
        assert!(sound.load(&job).unwrap().state.film.same_bits(&whole), "killed at step {at}");
    }
    assert!(from_newest > 20 && from_older > 2 && from_start > 1, "{from_newest} {from_older} {from_start}");
}

/// A full disk is told, costs nothing but the checkpoint, and leaves no rubbish.
#[test]
fn a_full_disk_is_a_warning_and_the_older_checkpoint_stays() {
    let pass = Hashed::new(3, Shape::Smooth);
    let job = Job::new(spec(32, 32, ErrorMode::Conservative), 16);
    for at in 0..7 {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.ckpt");
        let faults = Arc::new(DieAt { step: AtomicU32::new(0), at, kill: false });
        let checkpoints = Checkpoints::new(&path, Duration::ZERO).with_faults(faults);
        let mut notes = Notes::default();
        let end = go(&job, &pass, State::start(&job).unwrap(), &checkpoints, &Cancel::default(), &mut notes);
        assert_eq!((end, notes.warnings.len()), (End::Complete, 1), "{:?}", notes.warnings);
        assert!(notes.warnings[0].contains("no checkpoint was written"));
        assert!(!path.with_extension("ckpt.tmp").exists());
        assert!(checkpoints.load(&job).unwrap().state.position.is_finished());
    }
}

fn finished(job: &Job, pass: &Hashed) -> (tempfile::TempDir, Checkpoints) {
    let folder = tempfile::tempdir().unwrap();
    let checkpoints = Checkpoints::new(folder.path().join("a.ckpt"), Duration::from_secs(60));
    for spp in [8, 16] {
        let part = Job { spp, ..job.clone() };
        let film: Film = film(&part, pass, 1);
        let position = State::start(&part).unwrap().position;
        checkpoints.save(job, &film, &job.guide, &position).unwrap();
    }
    (folder, checkpoints)
}

#[test]
fn a_damaged_checkpoint_falls_back_to_its_predecessor_and_says_so() {
    let pass = Hashed::new(3, Shape::Smooth);
    let job = Job::new(spec(16, 16, ErrorMode::Conservative), 64);
    type Damage = fn(&mut Vec<u8>);
    let damages: [Damage; 4] = [
        |b| b.truncate(b.len() / 2),
        |b| b.clear(),
        |b| b[3000] ^= 1,
        |b| *b = b"P6 640 480 255 an image".repeat(9),
    ];
    for damage in damages {
        let (_folder, checkpoints) = finished(&job, &pass);
        let mut bytes = fs::read(checkpoints.path()).unwrap();
        damage(&mut bytes);
        fs::write(checkpoints.path(), bytes).unwrap();
        let resumed = checkpoints.load(&job).unwrap();
        assert_eq!(resumed.state.film.samples(), 8 * 256);
        assert!(resumed.notes[0].contains("going on from"), "{:?}", resumed.notes);
        // the next save must not push the good one out
        let State { film, guide, position } = &resumed.state;
        let dying = DieAt { step: AtomicU32::new(0), at: 3, kill: true };
        let _ = checkpoints.clone().with_faults(Arc::new(dying)).save(&job, film, guide, position);
        assert_eq!(checkpoints.load(&job).unwrap().state.film.samples(), 8 * 256);
    }
}

/// Resuming a finished job renders nothing and writes nothing.
#[test]
fn a_finished_job_is_left_alone() {
    let pass = Hashed::new(3, Shape::Smooth);
    let job = Job::new(spec(16, 16, ErrorMode::Conservative), 8);
    let folder = tempfile::tempdir().unwrap();
    let checkpoints = Checkpoints::new(folder.path().join("a.ckpt"), Duration::from_secs(60));
    go(&job, &pass, State::start(&job).unwrap(), &checkpoints, &Cancel::default(), &mut Silent);
    let calls = pass.calls.load(Ordering::Relaxed);
    let state = checkpoints.load(&job).unwrap().state;
    fs::remove_file(checkpoints.path()).unwrap();
    assert_eq!(go(&job, &pass, state, &checkpoints, &Cancel::default(), &mut Silent), End::Complete);
    assert!(pass.calls.load(Ordering::Relaxed) == calls && !checkpoints.path().exists());
}

#[test]
fn a_checkpoint_of_another_job_is_refused_with_what_differs() {
    let pass = Hashed::new(3, Shape::Smooth);
    let mut job = Job::new(spec(16, 16, ErrorMode::Conservative), 64);
    job.scene_hash = "aaaa".into();
    job.settings = vec![("integrator".into(), "volpath".into())];
    let (_folder, checkpoints) = finished(&job, &pass);
    let others = [
        (Job { scene_hash: "bbbb".into(), ..job.clone() }, "scene: `aaaa` there, `bbbb` here"),
        (
            Job { settings: vec![("integrator".into(), "analog".into())], ..job.clone() },
            "integrator: `volpath` there",
        ),
        (Job { spp: 65, ..job.clone() }, "samples per pixel: `64` there, `65` here"),
        (
            Job { film: spec(16, 16, ErrorMode::REPLICATED), ..job.clone() },
            "error mode: `Conservative` there",
        ),
        (
            Job { film: spec(32, 16, ErrorMode::Conservative), ..job.clone() },
            "resolution: `16 x 16` there, `32 x 16` here",
        ),
    ];
    for (other, reason) in others {
        let error = checkpoints.load(&other).unwrap_err();
        assert!(matches!(error, EngineError::OtherJob { .. }));
        assert!(error.to_string().contains(reason), "{error}");
    }
    assert!(checkpoints.load(&job).unwrap().notes.is_empty());
}

/// Mutated bytes, with and without a checksum made to fit: refused, or read and gone on from; never a panic.
#[test]
fn mutated_checkpoints_never_panic() {
    let target = Some(Target { pilot: 16, ..Target::luminance(0.5) });
    let plain = Job::new(spec(8, 8, ErrorMode::Conservative), 64);
    let adaptive = Job { target, ..Job::new(spec(8, 8, ErrorMode::REPLICATED), 64) };
    for (seed, job) in [(17, plain), (18, adaptive)] {
        let (refused, read) = mutate(&job, seed, 1000);
        assert!(refused > 800, "{refused} refused, {read} read");
    }
}

/// Numbers of mutated checkpoints that were refused and read.
fn mutate(job: &Job, seed: u64, rounds: u32) -> (u32, u32) {
    let pass = Hashed::new(3, Shape::Smooth);
    let (folder, checkpoints) = stopped(job, &pass);
    let original = fs::read(checkpoints.path()).unwrap();
    let path = folder.path().join("fuzz.film");
    let fuzzed = Checkpoints::new(&path, Duration::ZERO);
    let elsewhere = Checkpoints::new(folder.path().join("on.ckpt"), Duration::from_secs(60));
    let mut rng = Rng::new(seed);
    let (mut refused, mut read) = (0, 0);
    for round in 0..rounds {
        fs::write(&path, mutated(&original, &mut rng, round % 4 != 0)).unwrap();
        match fuzzed.load(job) {
            Ok(resumed) => {
                read += 1;
                let _ = resumed.state.film.develop();
                go(job, &pass, resumed.state, &elsewhere, &Cancel::default(), &mut Silent);
            }
            Err(_) => refused += 1,
        }
        let _ = tyndall_engine::shard::merge(&[path.clone(), path.clone()], 1 << 24);
    }
    (refused, read)
}

/// A checkpoint of a run that was stopped in its middle.
fn stopped(job: &Job, pass: &Hashed) -> (tempfile::TempDir, Checkpoints) {
    let folder = tempfile::tempdir().unwrap();
    let checkpoints = Checkpoints::new(folder.path().join("a.ckpt"), Duration::from_secs(60));
    let cancel = Cancel::default();
    let mut sink = StopAfter { patches: 4, cancel: cancel.clone() };
    let end = go(job, pass, State::start(job).unwrap(), &checkpoints, &cancel, &mut sink);
    assert_eq!(end, End::Cancelled);
    (folder, checkpoints)
}

fn mutated(original: &[u8], rng: &mut Rng, with_checksum: bool) -> Vec<u8> {
    let mut bytes = original.to_vec();
    for _ in 0..1 + rng.below(4) {
        let at = rng.below(bytes.len() as u32) as usize;
        match rng.below(5) {
            0 => bytes.truncate(at.max(1)),
            1 => bytes[at] = rng.u32() as u8,
            2 => bytes.insert(at, b"0123456789-[]{}\",:"[rng.below(18) as usize]),
            3 => drop(bytes.drain(at..(at + rng.below(40) as usize).min(bytes.len()))),
            _ => bytes[at] ^= 1 << rng.below(8),
        }
        bytes.resize(bytes.len().max(1), 0);
    }
    if with_checksum && bytes.len() > 40 {
        let body = bytes.len() - 32;
        let hash = *blake3::hash(&bytes[..body]).as_bytes();
        bytes[body..].copy_from_slice(&hash);
    }
    bytes
}

/// A header may announce any size: it is refused by the limit, before memory is taken.
#[test]
fn an_announced_giant_is_refused_before_allocation() {
    let pass = Hashed::new(3, Shape::Smooth);
    let job = Job::new(spec(64, 64, ErrorMode::Conservative), 64);
    let (_folder, checkpoints) = finished(&job, &pass);
    let bytes = fs::read(checkpoints.path()).unwrap();
    let size = u64::from_le_bytes(std::array::from_fn(|k| bytes[12 + k])) as usize;
    let mut header: serde_json::Value = serde_json::from_slice(&bytes[20..20 + size]).unwrap();
    header["film"]["resolution"] = [4_000_000_000u64; 2].into();
    header["film"]["bounds"]["x1"] = 4_000_000_000u64.into();
    header["film"]["bounds"]["y1"] = 4_000_000_000u64.into();
    let header = serde_json::to_vec(&header).unwrap();
    let mut bytes = bytes[..12].to_vec();
    bytes.extend((header.len() as u64).to_le_bytes());
    bytes.extend(header);
    let hash = *blake3::hash(&bytes).as_bytes();
    bytes.extend(hash);
    fs::write(checkpoints.path(), bytes).unwrap();
    let merge =
        |limit| tyndall_engine::shard::merge(&[checkpoints.path().into()], limit).unwrap_err().to_string();
    let error = merge(1 << 30);
    assert!(error.contains("4000000000 x 4000000000 pixels with 3 channels need"), "{error}");
}

/// Even where memory is plenty, no more is taken than the file's own size can unpack to.
#[test]
fn a_film_beyond_what_its_file_can_hold_is_refused_before_allocation() {
    let pass = Hashed::new(3, Shape::Smooth);
    let job = Job::new(spec(64, 64, ErrorMode::Conservative), 64);
    let (_folder, checkpoints) = finished(&job, &pass);
    let bytes = fs::read(checkpoints.path()).unwrap();
    let size = u64::from_le_bytes(std::array::from_fn(|k| bytes[12 + k])) as usize;
    let mut header: serde_json::Value = serde_json::from_slice(&bytes[20..20 + size]).unwrap();
    header["film"]["resolution"] = [1_000_000u64; 2].into();
    header["film"]["bounds"]["x1"] = 1_000_000u64.into();
    header["film"]["bounds"]["y1"] = 1_000_000u64.into();
    fs::write(checkpoints.path(), forged(&bytes, &header)).unwrap();
    let read = tyndall_engine::container::read(checkpoints.path(), u64::MAX, |_| Ok(()));
    let error = read.map(|_| ()).unwrap_err().to_string();
    assert!(error.contains("bytes of sums, its"), "{error}");
}

/// The film with another header and a checksum that fits.
fn forged(film: &[u8], header: &serde_json::Value) -> Vec<u8> {
    let size = u64::from_le_bytes(std::array::from_fn(|k| film[12 + k])) as usize;
    let header = serde_json::to_vec(header).unwrap();
    let mut bytes = film[..12].to_vec();
    bytes.extend((header.len() as u64).to_le_bytes());
    bytes.extend(header);
    bytes.extend(&film[20 + size..film.len() - 32]);
    let hash = *blake3::hash(&bytes).as_bytes();
    bytes.extend(hash);
    bytes
}
