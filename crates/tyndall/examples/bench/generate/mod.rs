//! Writes the scenes with all that they refer to into the benchmark's folder: what is too large for a repository is made
//! here, the same on every machine.

mod cloud;
mod images;
mod noise;
mod terrain;

use crate::scenes::{SCENES, sources};
use std::{fs, path::Path};
use tyndall::files::image::{Pixels, PngOptions, write_png};

pub use cloud::{CLOUD, SMOKE, directive as grid};
pub use terrain::ply as hills;

/// Voxels along each side of the cloud, and of the smoke.
pub const CLOUD_SIDE: usize = 64;
const SMOKE_SIDE: usize = 32;
/// At least so many triangles has the terrain.
pub const TERRAIN_TRIANGLES: usize = 1_000_000;

/// Writes all scenes into `folder`.
pub fn all(folder: &Path) -> Result<(), String> {
    write_texts(folder)?;
    for (scene, puff, side) in [("cloud-grid", &CLOUD, CLOUD_SIDE), ("smoke", &SMOKE, SMOKE_SIDE)] {
        write(&folder.join(format!("{scene}-medium.pbrt")), grid(puff, side).as_bytes())?;
        let raw: Vec<u8> = cloud::densities(side).iter().flat_map(|v| v.to_le_bytes()).collect();
        write(&folder.join(format!("{scene}.f32")), &raw)?;
    }
    write(&folder.join("terrain.ply"), &hills(TERRAIN_TRIANGLES))?;
    picture(&folder.join("tiles.png"), &images::tiles())?;
    picture(&folder.join("cloth.png"), &images::cloth())
}

/// The scene files alone.
pub fn write_texts(folder: &Path) -> Result<(), String> {
    fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    for name in SCENES.iter().map(|s| s.name).chain(["walls"]) {
        write(&folder.join(name).with_extension("pbrt"), text(name)?.as_bytes())?;
    }
    Ok(())
}

/// The text of a scene of the repository.
pub fn text(name: &str) -> Result<String, String> {
    let path = sources().join(name).with_extension("pbrt");
    fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))
}

/// Writes a file.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), String> {
    fs::write(path, bytes).map_err(|e| format!("{}: {e}", path.display()))
}

fn picture(path: &Path, rgb: &[[f32; 3]]) -> Result<(), String> {
    let pixels = Pixels::from_rgb(images::SIDE, images::SIDE, rgb).map_err(|e| e.to_string())?;
    write_png(path, &pixels, &PngOptions::default()).map(|_| ()).map_err(|e| e.to_string())
}
