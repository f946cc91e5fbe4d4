//! What the techniques buy: efficiency of the defaults and of every switch on small scenes, in one process, on one thread.
//!
//! `cargo run --release -p tyndall --example bench -- OUT_DIR [quick] [defaults] [SCENE]...` writes `ours.json`,
//! `bench.md` and one mask per scene; `defaults` leaves the techniques out, names of scenes all other scenes.
//! `cargo xtask bench` calls it and sets other renderers beside it.
//!
//! Efficiency is `E = 1 / (MSE_Y x CPU seconds)`, with MSE_Y the variance of pixel luminances over seeds. The headline
//! leaves out the pixels that see a lamp, and their neighbours: the lamp's rim holds half of the error of a picture
//! whose rest is what one looks at.

mod mask;
mod measure;
mod pbrt;
mod scenes;
mod tables;
mod variants;

use measure::{Efficiency, Measurement, Task};
use scenes::{BenchScene, SCENES};
use std::{path::PathBuf, process::ExitCode};
use variants::{DEFAULTS, TECHNIQUES};

/// Sizes of the benchmark.
struct Size {
    seeds: u32,
    resolution: u32,
    technique_resolution: u32,
    spp: &'static [u32],
}

const FULL: Size = Size { seeds: 8, resolution: 128, technique_resolution: 64, spp: &[4, 16, 64] };
/// Enough to see that everything runs.
const QUICK: Size = Size { seeds: 3, resolution: 32, technique_resolution: 16, spp: &[4, 16] };
/// Samples per pixel of the techniques' table.
const TECHNIQUE_SPP: u32 = 16;

/// What to measure.
struct Wanted {
    out: PathBuf,
    size: &'static Size,
    techniques: bool,
    scenes: Vec<&'static BenchScene>,
}

impl Wanted {
    fn parse(arguments: &[String]) -> Option<Self> {
        let (out, rest) = arguments.split_first()?;
        let mut wanted = Self { out: PathBuf::from(out), size: &FULL, techniques: true, scenes: Vec::new() };
        for word in rest {
            match word.as_str() {
                "quick" => wanted.size = &QUICK,
                "defaults" => wanted.techniques = false,
                name => wanted.scenes.push(SCENES.iter().find(|s| s.name == name)?),
            }
        }
        if wanted.scenes.is_empty() {
            wanted.scenes = SCENES.iter().collect();
        }
        Some(wanted)
    }
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let Some(wanted) = Wanted::parse(&arguments) else {
        let names: Vec<&str> = SCENES.iter().map(|s| s.name).collect();
        eprintln!("usage: bench OUT_DIR [quick] [defaults] [SCENE]...\nscenes: {}", names.join(", "));
        return ExitCode::from(2);
    };
    match run(&wanted) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(wanted: &Wanted) -> Result<(), String> {
    let Wanted { out, size, scenes, .. } = wanted;
    std::fs::create_dir_all(out).map_err(|e| format!("{}: {e}", out.display()))?;
    let defaults = scenes.iter().map(|s| defaults(s, size)).collect::<Result<Vec<_>, _>>()?;
    let measured = if wanted.techniques { &scenes[..] } else { &[] };
    let techniques = measured.iter().map(|s| techniques(s, size)).collect::<Result<Vec<_>, _>>()?;
    let peers = pbrt::measure(out, scenes, size.seeds, size.resolution)?;
    for scene in scenes {
        let mask = mask::lamp(scene, size.resolution)?;
        let path = out.join(format!("mask-{}.pbm", scene.name));
        std::fs::write(&path, mask.to_pbm()).map_err(|e| format!("{}: {e}", path.display()))?;
    }
    let report = tables::Report { size, scenes, defaults, techniques, peers };
    std::fs::write(out.join("ours.json"), report.json()).map_err(|e| format!("ours.json: {e}"))?;
    let text = report.markdown();
    std::fs::write(out.join("bench.md"), &text).map_err(|e| format!("bench.md: {e}"))?;
    print!("{text}");
    Ok(())
}

/// The defaults on a scene at all numbers of samples.
fn defaults(scene: &BenchScene, size: &Size) -> Result<Vec<(u32, Efficiency)>, String> {
    let task = |&spp: &u32| Task { scene, variant: &DEFAULTS, resolution: size.resolution, spp };
    let tasks: Vec<Task<'_>> = size.spp.iter().map(task).collect();
    eprintln!("{}: defaults", scene.name);
    let measured = measure::all(&tasks, size.seeds)?;
    let mask = mask::lamp(scene, size.resolution)?;
    Ok(size.spp.iter().copied().zip(measured.iter().map(|m| m.efficiency(&mask))).collect())
}

/// The defaults, then every variant, on a scene; rounds of seeds take turns, so that a busy machine slows all alike.
fn techniques(scene: &BenchScene, size: &Size) -> Result<Vec<Option<Efficiency>>, String> {
    let all = || std::iter::once(&DEFAULTS).chain(TECHNIQUES.iter());
    let resolution = size.technique_resolution;
    let task = |variant| Task { scene, variant, resolution, spp: TECHNIQUE_SPP };
    let tasks: Vec<Task<'_>> = all().filter(|v| scene.allows(v)).map(task).collect();
    eprintln!("{}: techniques", scene.name);
    let mut measured = measure::all(&tasks, size.seeds)?.into_iter();
    let mask = mask::lamp(scene, resolution)?;
    let mut next = || measured.next().map(|m: Measurement| m.efficiency(&mask));
    Ok(all().map(|v| if scene.allows(v) { next() } else { None }).collect())
}
