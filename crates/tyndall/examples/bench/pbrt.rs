//! pbrt-v4 on the same files, when it is on the PATH.
//!
//! pbrt tells no CPU time, so that what a run with one pixel takes (reading, building) is taken off the whole run's.

use crate::{
    efficiency::{Measurement, median},
    generate,
    process::{is_there, watched},
    scenes::BenchScene,
    setup::Setup,
    store,
};
use serde_json::json;
use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};
use tyndall::files::image::{Pixels, read_exr};

/// The name under which its results stand: the defaults of its `volpath` with the sampler that the scenes ask for.
pub const NAME: &str = "pbrt-v4, zsobol";
/// One-pixel runs of which the median is taken.
const STARTS: usize = 5;

/// Runs pbrt, or says that it is not there. `TYNDALL_BENCH_PBRT` names another program than that on the PATH.
pub fn measure(setup: &Setup) -> Result<(), String> {
    let program = std::env::var_os("TYNDALL_BENCH_PBRT").map_or_else(|| PathBuf::from("pbrt"), PathBuf::from);
    if !is_there(&program) {
        eprintln!("pbrt-v4: no program `{}`, left out", program.display());
        return Ok(());
    }
    measure_with(&program, setup)
}

fn measure_with(program: &Path, setup: &Setup) -> Result<(), String> {
    for scene in &setup.scenes {
        let file = resized(setup, scene)?;
        let load = start(program, setup, scene, &file)?;
        for &spp in setup.spp() {
            eprintln!("{}: pbrt-v4, {spp} spp", scene.name);
            let m = pictures(program, setup, &file, spp, load)?;
            store::pictures(&setup.folder, NAME, scene.name, spp, &m)?;
        }
    }
    Ok(())
}

/// A copy of the scene at the benchmark's size beside it, for pbrt has no option for the size.
fn resized(setup: &Setup, scene: &BenchScene) -> Result<PathBuf, String> {
    let mut text = generate::text(scene.name)?;
    for side in ["xresolution", "yresolution"] {
        let (old, new) = (format!("{side}\" 128"), format!("{side}\" {}", setup.resolution()));
        if !text.contains(&old) {
            return Err(format!("{}.pbrt has no `{old}`", scene.name));
        }
        text = text.replace(&old, &new);
    }
    let file = setup.scene_folder().join(format!("pbrt-{}.pbrt", scene.name));
    generate::write(&file, text.as_bytes())?;
    Ok(file)
}

fn command(program: &Path, file: &Path, image: &Path, [spp, seed]: [u32; 2], more: &[&str]) -> Command {
    let mut c = Command::new(program);
    c.args(["--quiet", "--nthreads", "1", "--spp", &spp.to_string(), "--seed", &seed.to_string()]);
    c.args(more).arg("--outfile").arg(image).arg(file);
    c
}

/// Runs with one pixel: writes the start-up line, returns the median of user CPU seconds.
fn start(program: &Path, setup: &Setup, scene: &BenchScene, file: &Path) -> Result<f64, String> {
    let image = setup.folder.join("pbrt.exr");
    let mut runs = Vec::new();
    for _ in 0..STARTS {
        runs.push(watched(&mut command(program, file, &image, [1, 0], &["--pixelbounds", "0,1,0,1"]))?);
    }
    let of = |f: fn(&crate::process::Ran) -> f64| median(&runs.iter().map(f).collect::<Vec<_>>());
    let whole = watched(&mut command(program, file, &image, [4, 0], &[]))?;
    store::line(
        &setup.folder,
        &json!({
            "kind": "start", "renderer": NAME, "scene": scene.name, "seconds": of(|r| r.seconds),
            "user_seconds": of(|r| r.user_seconds), "bytes": whole.bytes,
        }),
    )?;
    Ok(of(|r| r.user_seconds))
}

fn pictures(program: &Path, setup: &Setup, file: &Path, spp: u32, load: f64) -> Result<Measurement, String> {
    let side = setup.resolution() as usize;
    let mut m = Measurement { width: side, spp: f64::from(spp), ..Measurement::default() };
    let image = setup.folder.join("pbrt.exr");
    for seed in 0..setup.seeds_at(spp) {
        let ran = watched(&mut command(program, file, &image, [spp, seed], &[]))?;
        // a hundredth is what the kernel's clock tells: no picture takes less
        m.seconds.push((ran.user_seconds - load).max(0.01));
        let pixels = read_exr(&image).map_err(|e| e.to_string())?;
        if (pixels.width(), pixels.height()) != (side, side) {
            let size = format!("{} x {}", pixels.width(), pixels.height());
            return Err(format!("pbrt-v4: {} came out as {size}, not {side} x {side}", file.display()));
        }
        m.pictures.push(luminance(&pixels)?);
    }
    fs::remove_file(&image).map_err(|e| format!("{}: {e}", image.display()))?;
    Ok(m)
}

/// Y of linear sRGB.
fn luminance(pixels: &Pixels) -> Result<Vec<f64>, String> {
    let plane = |name: &str| {
        let found = pixels.channel(name).ok_or_else(|| format!("pbrt's image has no channel {name}"))?;
        Ok::<_, String>(found.iter().map(|&v| f64::from(v)))
    };
    let (r, g, b) = (plane("R")?, plane("G")?, plane("B")?);
    Ok(r.zip(g).zip(b).map(|((r, g), b)| 0.212_671 * r + 0.715_160 * g + 0.072_169 * b).collect())
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::os::unix::fs::PermissionsExt;
    use tyndall::files::image::{ExrOptions, write_exr};

    /// A program that writes one of three pictures, after its seed, and complains about options that pbrt has not.
    const FAKE: &str = "#!/bin/sh
here=$(dirname \"$0\")
for word; do last=$word; done
while [ $# -gt 1 ]; do
  case $1 in
    --help) exit 0;;
    --quiet) ;;
    --nthreads|--spp|--pixelbounds) shift;;
    --seed) seed=$2; shift;;
    --outfile) out=$2; shift;;
    *) echo \"unknown option $1\" >&2; exit 1;;
  esac
  shift
done
grep -q '\"integer xresolution\" 32 \"integer yresolution\" 32' \"$last\" || exit 4
cp \"$here/$((seed % 3)).exr\" \"$out\"
";

    /// A program `pbrt` in `folder`. Another process writes it: were it open here while some other test starts a child, the
    /// system would refuse to run it.
    fn script(folder: &Path, text: &str) -> PathBuf {
        let (draft, program) = (folder.join("draft"), folder.join("pbrt"));
        fs::write(&draft, text).expect("it is written");
        fs::set_permissions(&draft, fs::Permissions::from_mode(0o755)).expect("its owner may");
        let copied = Command::new("cp").arg("-p").args([&draft, &program]).status();
        assert!(copied.is_ok_and(|s| s.success()));
        program
    }

    #[test]
    fn pictures_of_a_program_that_behaves_like_pbrt() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        for seed in 0..3u16 {
            let rgb = vec![[1.0, f32::from(seed), 0.5]; 32 * 32];
            let pixels = Pixels::from_rgb(32, 32, &rgb).expect("the sizes agree");
            write_exr(&at(&format!("{seed}.exr")), &pixels, &ExrOptions::default()).expect("it is written");
        }
        let program = script(folder.path(), FAKE);
        let words = [
            folder.path().to_string_lossy().into_owned(),
            "--quick".into(),
            "--scene".into(),
            "fog-box".into(),
        ];
        let setup = Setup::parse(&words).expect("good options");
        fs::create_dir_all(setup.scene_folder()).expect("a folder");
        measure_with(&program, &setup).expect("it runs");
        let lines = store::lines(&setup.folder).expect("lines");
        let kinds: Vec<&str> = lines.iter().filter_map(|l| l["kind"].as_str()).collect();
        assert_eq!(kinds, ["start", "pictures", "pictures"]);
        let m = store::measurement(&setup.folder, &lines[1]).expect("its pictures");
        assert_eq!((m.pictures.len(), m.width, m.height(), m.spp), (3, 32, 32, 4.0));
        for (seed, p) in m.pictures.iter().enumerate() {
            let y = 0.212_671 + 0.715_160 * seed as f64 + 0.072_169 * 0.5;
            assert!(p.iter().all(|v| (v - y).abs() < 1e-6), "{seed}: {}", p[0]);
        }
        assert!(m.seconds.iter().all(|&s| s >= 0.01));
    }

    #[test]
    fn a_program_that_fails_is_an_error_with_its_words() {
        let folder = tempfile::tempdir().expect("a folder");
        let program = script(folder.path(), "#!/bin/sh\necho no such plugin >&2\nexit 1\n");
        let setup = Setup::parse(&[folder.path().to_string_lossy().into_owned()]).expect("good options");
        fs::create_dir_all(setup.scene_folder()).expect("a folder");
        let error = measure_with(&program, &setup).expect_err("it fails");
        assert!(error.contains("no such plugin"), "{error}");
    }
}
