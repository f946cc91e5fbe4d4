//! What goes wrong around a render: disks, folders, permissions, memory, closed streams, ignored signals.
#![cfg(unix)]

mod common;

use std::os::unix::fs::{PermissionsExt, symlink};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use common::{Place, Ran};

const TINY: &str = "render --resolution 8x8 --spp 2 --quiet";

/// Runs a line of the shell in which `$T` is the program.
fn shell(place: &Place, line: &str) -> Ran {
    let out = Command::new("sh")
        .current_dir(place.folder())
        .env("T", env!("CARGO_BIN_EXE_tyndall"))
        .args(["-c", line])
        .output()
        .expect("a shell");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    Ran { code: out.status.code().unwrap_or(-1), out: text(&out.stdout), err: text(&out.stderr) }
}

fn failed(ran: &Ran, code: i32, message: &str) {
    assert_eq!(ran.code, code, "{}", ran.err);
    assert!(ran.err.contains(message), "{message}\n{}", ran.err);
    assert!(!ran.err.contains("panicked") && !ran.err.contains("internal error"), "{}", ran.err);
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk() {
    let place = Place::new();
    for name in ["a.exr", "a.png", "a.csv", "a.nc"] {
        symlink("/dev/full", place.path(name)).expect("writable");
        let ran = place.run(&format!("{TINY} -o {name}"));
        failed(&ran, 1, &format!("{name}: cannot write: No space left on device"));
        assert!(ran.err.contains("hint: the disk is full"), "{}", ran.err);
    }
}

/// The limit's signal would end the process without a word.
#[test]
fn a_limit_on_the_size_of_files() {
    let place = Place::new();
    let ran = shell(&place, "ulimit -f 1; $T render --resolution 64x64 --spp 1 --quiet -o a.csv");
    failed(&ran, 1, "a.csv: cannot write: File too large");
    assert!(ran.err.contains("ulimit -f"), "{}", ran.err);
    assert!(!place.has("a.csv"));
}

#[test]
fn folders_that_are_not_there_or_are_files() {
    let place = Place::new();
    failed(
        &place.run(&format!("{TINY} -o nowhere/a.exr")),
        1,
        "nowhere/a.exr: cannot write: No such file or directory",
    );
    place.write("file", "");
    failed(&place.run(&format!("{TINY} -o file/a.exr")), 1, "file/a.exr: cannot write: Not a directory");
    std::fs::create_dir(place.path("dir.exr")).expect("writable");
    failed(&place.run(&format!("{TINY} -o dir.exr")), 1, "dir.exr: cannot write: is a directory");
}

/// Before any work is done. Root may write anywhere, so root becomes nobody.
#[test]
fn no_permission() {
    let place = Place::new();
    std::fs::create_dir(place.path("shut")).expect("writable");
    let mode = |path: &std::path::Path, mode| {
        std::fs::set_permissions(path, std::fs::Permissions::from_mode(mode)).expect("ours");
    };
    mode(&place.path("shut"), 0o555);
    mode(place.folder(), 0o755);
    let root = shell(&place, "test -w shut").code == 0;
    let program = if root { "setpriv --reuid 65534 --regid 65534 --clear-groups $T" } else { "$T" };
    if shell(&place, &format!("{program} --version")).code != 0 {
        println!("the program cannot be run as nobody here: nothing was tested");
        return;
    }
    let start = Instant::now();
    let ran = shell(&place, &format!("{program} render --spp 1000000 -o shut/a.exr"));
    failed(&ran, 1, "shut/a.exr: cannot write: Permission denied");
    assert!(ran.err.contains("hint: check the permissions"), "{}", ran.err);
    assert!(start.elapsed() < Duration::from_secs(30), "told before the work, not after it");
    mode(&place.path("shut"), 0o777);
    place.write("shut/b.exr", "mine");
    mode(&place.path("shut/b.exr"), 0o444);
    failed(
        &shell(&place, &format!("{program} {TINY} --force -o shut/b.exr")),
        1,
        "shut/b.exr: cannot write: permission denied",
    );
    assert_eq!(place.read("shut/b.exr"), b"mine");
}

#[test]
fn absurd_sizes_are_refused_before_memory_is_taken() {
    let place = Place::new();
    for (options, message) in [
        ("--resolution 1000000x1000000", "GiB of memory, and"),
        ("--resolution 100000x100000 --bands 360:830:1", "GiB of memory, and"),
        ("--resolution 4294967295x4294967295", "GiB of memory, and"),
        ("--bands 360:830:0.0000001", "bands"),
        ("--spp 4294967295", "samples per pixel"),
        ("--spectral opow --wavelengths 4294967295", "wavelengths"),
    ] {
        // 4 GiB of addresses: an allocation in earnest would fail
        let ran = shell(&place, &format!("ulimit -v 4194304; $T render {options}"));
        failed(&ran, 2, message);
    }
    assert_eq!(std::fs::read_dir(place.folder()).expect("readable").count(), 0);
}

#[test]
fn closed_streams() {
    let place = Place::new();
    for closed in ["<&-", ">&-", "2>&-", "<&- >&- 2>&-"] {
        let ran = shell(&place, &format!("$T render --resolution 8x8 --spp 2 --force -o a.exr {closed}"));
        assert_eq!(ran.code, 0, "{closed}: {}", ran.err);
    }
    // a reader that goes away
    let ran = shell(&place, "$T info | true; $T render --resolution 8x8 --spp 2 -o b.exr 2>&1 | true");
    assert_eq!(ran.code, 0);
    assert!(!ran.err.contains("panicked"), "{}", ran.err);
}

#[test]
#[cfg(target_os = "linux")]
fn a_terminal_without_width() {
    let place = Place::new();
    if shell(&place, "command -v script").code != 0 {
        println!("no `script` to make a terminal: nothing was tested");
        return;
    }
    let line = "script -qec 'stty cols 0 rows 0; $T render --resolution 8x8 --spp 2 -o a.exr' /dev/null";
    let ran = shell(&place, line);
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    assert!(place.has("a.exr") && !ran.out.contains("panicked"), "{}", ran.out);
}

/// When not all threads can be started, those that have started must not keep the program waiting.
#[test]
#[cfg(target_os = "linux")]
fn threads_that_cannot_be_started() {
    let place = Place::new();
    // 1 GiB of addresses has no room for so many stacks
    let line =
        "ulimit -v 1048576; timeout 60 $T render --resolution 64x64 --spp 64 --quiet --threads 2000 -o a.exr";
    let ran = shell(&place, line);
    failed(&ran, 2, "cannot start thread");
    assert!(ran.err.contains("hint: give --threads a smaller number"), "{}", ran.err);
}

/// The image cannot be written, but what was rendered is in the checkpoint.
#[test]
#[cfg(target_os = "linux")]
fn a_result_that_cannot_be_written_is_not_lost() {
    let place = Place::new();
    symlink("/dev/full", place.path("a.exr")).expect("writable");
    let ran = place.run(&format!("{TINY} -o a.exr -o b.csv"));
    failed(&ran, 1, "a.exr: cannot write: No space left on device");
    assert!(ran.err.contains("a.ckpt holds what was rendered, and --resume writes it"), "{}", ran.err);
    assert!(place.has("b.csv") && !place.has("a.run.json"), "the other result is written");
    std::fs::remove_file(place.path("a.exr")).expect("ours");
    place.ok(&format!("{TINY} -o a.exr -o b.csv --resume"));
    place.ok(&format!("{TINY} -o c.exr"));
    assert!(place.read("a.exr") == place.read("c.exr"));
    assert!(!place.has("a.ckpt"));
}

/// Files of a run that would destroy its input or one another.
#[test]
fn files_that_would_be_written_over() {
    let place = Place::new();
    let scene = "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nCamera \"perspective\"\nWorldBegin\n\
                 LightSource \"infinite\"\n";
    place.write("a.pbrt", scene);
    place.write("diary", "mine");
    for (options, message) in [
        ("--checkpoint a.pbrt", "a.pbrt: is the scene, and a checkpoint would be written over it"),
        ("--checkpoint ./a.pbrt --resume --force", "a.pbrt: is the scene"),
        ("--checkpoint diary", "diary: exists and is no checkpoint"),
        ("-o b.exr --checkpoint b.exr", "b.exr: would be written twice, as a result and as a checkpoint"),
        ("-o b.exr -o b.error.exr", "b.error.exr: would be written twice"),
        ("-o b.png -o ./b.png", "./b.png: would be written twice"),
    ] {
        failed(&place.run(&format!("render a.pbrt --spp 2 {options}")), 2, message);
    }
    assert!(place.read("a.pbrt") == scene.as_bytes() && place.read("diary") == b"mine");
    place.ok("render a.pbrt --spp 2 --quiet --shard 1/2 -o s.film");
    failed(&place.run("render a.pbrt --spp 2 --quiet --shard 2/2 -o s.film"), 2, "s.film: exists");
}

/// An image so far is not the result, whatever else is lost.
#[test]
fn an_interrupted_image_is_not_taken_for_the_result() {
    let place = Place::new();
    let job = "render --resolution 32x32 --spp 1000000 --quiet -o a.exr";
    place.ok(&format!("{job} --time 1ms"));
    assert_eq!(place.json("a.run.json")["complete"], false);
    let shown = place.run(&format!("{} --resume", job.replace("1000000", "999999")));
    assert!(shown.refusal().contains("a.ckpt: belongs to another job"), "{}", shown.err);
    std::fs::remove_file(place.path("a.ckpt")).expect("ours");
    let resumed = place.run(&format!("{job} --resume"));
    assert!(resumed.refusal().contains("there is no checkpoint to resume from"), "{}", resumed.err);
}

/// Under `nohup`, or in the background of a script, some signals are ignored; the others still end a run well.
#[test]
fn signals_that_are_ignored_stay_so() {
    let place = Place::new();
    let line = "trap '' INT HUP; exec $T render --resolution 32x32 --spp 100000 --quiet -o a.exr --checkpoint-every 0s";
    let mut child = Command::new("sh")
        .current_dir(place.folder())
        .env("T", env!("CARGO_BIN_EXE_tyndall"))
        .args(["-c", line])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("a shell");
    let start = Instant::now();
    while !place.has("a.ckpt") {
        assert!(start.elapsed() < Duration::from_secs(60), "no checkpoint appears");
        std::thread::sleep(Duration::from_millis(2));
    }
    let id = child.id().to_string();
    let signal = |name: &str| Command::new("kill").args(["-s", name, &id]).status().expect("kill is there");
    for ignored in ["HUP", "INT", "HUP"] {
        signal(ignored);
        std::thread::sleep(Duration::from_millis(20));
        assert!(child.try_wait().expect("known").is_none(), "{ignored} is ignored");
    }
    signal("TERM");
    assert_eq!(child.wait().expect("ends").code(), Some(130));
    assert!(place.has("a.exr") && place.has("a.ckpt"));
}

/// What was read is what is rendered, and a checkpoint knows that the scene is another one now.
#[test]
fn a_scene_that_changes_during_the_run() {
    let place = Place::new();
    let scene = |radius: f64| {
        format!(
            "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\nSampler \"zsobol\" \"integer pixelsamples\" 4000\n\
             Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\"\nTranslate 0 0 4\n\
             Shape \"sphere\" \"float radius\" {radius}\n"
        )
    };
    place.write("a.pbrt", scene(1.0));
    let run = "render a.pbrt --quiet --checkpoint-every 0s";
    let mut child = Command::new(env!("CARGO_BIN_EXE_tyndall"))
        .current_dir(place.folder())
        .args(run.split_whitespace())
        .stderr(Stdio::null())
        .spawn()
        .expect("starts");
    let start = Instant::now();
    while !place.has("a.ckpt") {
        assert!(start.elapsed() < Duration::from_secs(60), "no checkpoint appears");
        std::thread::sleep(Duration::from_millis(2));
    }
    place.write("a.pbrt", scene(2.0));
    child.kill().expect("it runs");
    child.wait().expect("ends");
    let other = place.run(&format!("{run} --resume"));
    assert!(other.refusal().contains("a.ckpt: belongs to another job"), "{}", other.err);
    assert!(other.err.contains("scene: `"), "{}", other.err);
    place.write("a.pbrt", scene(1.0));
    place.ok(&format!("{run} --resume"));
}
