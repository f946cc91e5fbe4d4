//! The scenes, in the pbrt format beside this crate's sources.

use crate::variants::Variant;
use std::path::PathBuf;

/// A scene of the benchmark.
#[derive(Debug)]
pub struct BenchScene {
    /// File name without its ending.
    pub name: &'static str,
    /// What it stands for.
    pub about: &'static str,
    /// All its lights are points: no path meets them by chance.
    delta_lights: bool,
}

const fn scene(name: &'static str, about: &'static str) -> BenchScene {
    BenchScene { name, about, delta_lights: false }
}

/// In the order of the tables.
pub const SCENES: &[BenchScene] = &[
    scene("fog-box", "bluish fog, lamp in the fog"),
    scene("empty-box", "no fog"),
    scene("dark-fog", "albedo 0.35 to 0.65, 2.8 mean free paths across"),
    scene("tri-band", "the fog under a fluorescent lamp (F11)"),
    scene("cloud-box", "albedo 0.97 to 0.999, 7 to 10 mean free paths across"),
    scene("small-lamp", "thin bright fog around a small ball"),
    BenchScene { name: "beam", about: "spotlight of 8 degrees through thin fog", delta_lights: true },
];

impl BenchScene {
    /// Where it is.
    pub fn path(&self) -> PathBuf {
        let scenes = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("scenes").join("bench");
        scenes.join(self.name).with_extension("pbrt")
    }

    /// Whether the variant finds the scene's light at all.
    pub fn allows(&self, variant: &Variant) -> bool {
        !(self.delta_lights && variant.needs_sized_lights)
    }
}
