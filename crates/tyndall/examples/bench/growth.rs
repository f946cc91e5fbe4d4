//! How cost grows: time against triangles, bytes against triangles, voxels, pixels and bands.

use crate::{efficiency::median, generate, measure, process, program, setup::Setup, store};
use serde_json::json;
use std::path::{Path, PathBuf};
use tyndall::{Options, Source, plan};

/// Everything that grows.
pub fn all(setup: &Setup) -> Result<(), String> {
    triangles(setup)?;
    let sides = if setup.quick { [64, 128] } else { [256, 1024] };
    let pixels = |n: u32| format!("--resolution {n}x{n} --spp 1 --threads 1");
    let fog = setup.scene_folder().join("fog-box.pbrt");
    bytes(setup, "pixel", sides.map(|n| (f64::from(n).powi(2), fog.clone(), pixels(n))))?;
    let bands = |n: u32| format!("{} --bands 400:700:{}", pixels(sides[1]), 300 / n);
    let values = |n: u32| f64::from(n) * f64::from(sides[1]).powi(2);
    bytes(setup, "band of a pixel", [10, 30].map(|n| (values(n), fog.clone(), bands(n))))?;
    let voxels = if setup.quick { [32, 64] } else { [64, 128] };
    let clouds = voxels.map(|n| cloud(setup, n));
    let [small, large] = clouds;
    let cubed = voxels.map(|n| (n * n * n) as f64);
    bytes(setup, "voxel", [(cubed[0], small?, pixels(8)), (cubed[1], large?, pixels(8))])
}

/// Peak memory of the program at two sizes, and the bytes that one unit more takes.
fn bytes(setup: &Setup, unit: &str, sizes: [(f64, PathBuf, String); 2]) -> Result<(), String> {
    eprintln!("bytes per {unit}");
    let peak = |(_, scene, more): &(f64, PathBuf, String)| {
        let mut command = program::render(program::program(setup)?, setup, scene, &program::words(more));
        process::watched(&mut command).map(|r| r.bytes as f64)
    };
    let (few, many) = (peak(&sizes[0])?, peak(&sizes[1])?);
    let (from, to) = (sizes[0].0, sizes[1].0);
    store::line(
        &setup.folder,
        &json!({
            "kind": "bytes", "unit": unit, "from": from, "to": to, "peak": [few, many],
            "bytes": (many - few) / (to - from),
        }),
    )
}

fn cloud(setup: &Setup, n: usize) -> Result<PathBuf, String> {
    let medium = format!("cloud-{n}-medium.pbrt");
    generate::write(&setup.scene_folder().join(&medium), generate::grid(&generate::CLOUD, n).as_bytes())?;
    changed(setup, "cloud-grid", "cloud-grid-medium.pbrt", &medium, &format!("cloud-{n}"))
}

/// A copy of a scene that refers to another file.
fn changed(setup: &Setup, scene: &str, old: &str, new: &str, name: &str) -> Result<PathBuf, String> {
    let path = setup.scene_folder().join(format!("{name}.pbrt"));
    generate::write(&path, generate::text(scene)?.replace(old, new).as_bytes())?;
    Ok(path)
}

/// Hills of 10^3 to 10^6 triangles, or 10^7.
fn triangles(setup: &Setup) -> Result<(), String> {
    let most = if setup.quick {
        4
    } else if setup.full {
        7
    } else {
        6
    };
    let mut scenes = Vec::new();
    for power in 3..=most {
        let n = 10usize.pow(power);
        eprintln!("terrain of {n} triangles");
        let ply = format!("terrain-{n}.ply");
        generate::write(&setup.scene_folder().join(&ply), &generate::hills(n))?;
        let path = changed(setup, "terrain", "terrain.ply", &ply, &format!("terrain-{n}"))?;
        let triangles = hills(setup, &path)?;
        scenes.push((triangles as f64, path, "--resolution 8x8 --spp 1 --threads 1".to_owned()));
    }
    let last = scenes.pop().zip(scenes.pop());
    last.map_or(Ok(()), |(many, few)| bytes(setup, "triangle", [few, many]))
}

/// Time to load and to render hills.
fn hills(setup: &Setup, path: &Path) -> Result<usize, String> {
    let spp = if setup.quick { 1 } else { 16 };
    let side = setup.resolution();
    let options = Options { spp: Some(spp), resolution: Some([side; 2]), ..Options::default() };
    let plan = plan(Source::File(path), &options).map_err(|e| e.to_string())?;
    let seconds: Result<Vec<f64>, String> =
        (0..3).map(|seed| measure::picture(&plan, seed).map(|p| p.1)).collect();
    let samples = f64::from(side).powi(2) * f64::from(spp);
    let stats = plan.loaded.stats;
    let triangles = stats.triangles.max(1);
    store::line(
        &setup.folder,
        &json!({
            "kind": "triangles", "triangles": stats.triangles, "load_seconds": plan.loaded.seconds[0],
            "build_seconds": plan.loaded.seconds[1], "samples_per_second": samples / median(&seconds?),
            "tree_bytes_per_triangle": stats.bytes as f64 / triangles as f64,
        }),
    )?;
    Ok(triangles)
}
