//! pbrt-v4 on the same files, when it is on the PATH.

use crate::{
    mask,
    measure::{Efficiency, Measurement},
    scenes::BenchScene,
};
use std::{path::Path, process::Command};
use tyndall::files::image::{Pixels, read_exr};

/// Samples per pixel, as in the headline.
const SPP: u32 = 16;
/// Scenes for pbrt: those of the headline.
const ON: [&str; 2] = ["fog-box", "empty-box"];

/// A renderer's name, the scene, and what it achieves there.
pub type Peer = (&'static str, &'static str, Efficiency);

/// Runs pbrt, or says that it is not there.
pub fn measure(
    out: &Path,
    scenes: &[&'static BenchScene],
    seeds: u32,
    resolution: u32,
) -> Result<Vec<Peer>, String> {
    if Command::new("pbrt").arg("--help").output().is_err() {
        eprintln!("pbrt: not on the PATH, left out");
        return Ok(Vec::new());
    }
    let scenes = scenes.iter().filter(|s| ON.contains(&s.name));
    scenes.map(|s| Ok(("pbrt-v4", s.name, on(s, out, seeds, resolution)?))).collect()
}

fn on(scene: &BenchScene, out: &Path, seeds: u32, resolution: u32) -> Result<Efficiency, String> {
    let mut m = Measurement {
        pictures: Vec::new(),
        seconds: Vec::new(),
        samples: f64::from(resolution).powi(2) * f64::from(SPP),
    };
    for seed in 0..seeds {
        eprintln!("{}: pbrt, seed {seed}", scene.name);
        let image = out.join(format!("pbrt-{}-{seed}.exr", scene.name));
        let before = children_seconds()?;
        let status = Command::new("pbrt")
            .args([
                "--quiet",
                "--nthreads",
                "1",
                "--spp",
                &SPP.to_string(),
                "--seed",
                &seed.to_string(),
                "--outfile",
            ])
            .arg(&image)
            .arg(scene.path())
            .status()
            .map_err(|e| format!("pbrt: {e}"))?;
        if !status.success() {
            return Err(format!("pbrt: {}: {status}", scene.name));
        }
        m.seconds.push(children_seconds()? - before);
        let pixels = read_exr(&image).map_err(|e| e.to_string())?;
        if (pixels.width(), pixels.height()) != (resolution as usize, resolution as usize) {
            return Err(format!(
                "pbrt renders {} at the size of the file, 128; run the full benchmark",
                scene.name
            ));
        }
        m.pictures.push(luminance(&pixels)?);
    }
    Ok(m.efficiency(&mask::lamp(scene, resolution)?))
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

/// User CPU seconds of the children that have ended, in the kernel's hundredths.
fn children_seconds() -> Result<f64, String> {
    let stat = std::fs::read_to_string("/proc/self/stat").map_err(|e| format!("CPU time of pbrt: {e}"))?;
    // the name in brackets may hold blanks; cutime is the 14th number after it
    let after = stat.rsplit_once(')').map_or("", |(_, rest)| rest);
    let ticks = after.split_whitespace().nth(13).and_then(|t| t.parse::<f64>().ok());
    ticks.map(|t| t / 100.0).ok_or_else(|| "CPU time of pbrt: /proc/self/stat is not as expected".into())
}
