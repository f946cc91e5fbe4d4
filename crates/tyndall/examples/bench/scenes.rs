//! The scenes, in the pbrt format beside this crate's sources.

use crate::variants::Variant;
use std::path::{Path, PathBuf};

/// A scene of the benchmark.
#[derive(Debug)]
pub struct BenchScene {
    /// File name without its ending.
    pub name: &'static str,
    /// What it stands for.
    pub about: &'static str,
    /// All its lights are points: no path meets them by chance.
    delta_lights: bool,
    /// Under a sky, no lamp in view: the headline leaves out nothing.
    pub open: bool,
    /// Not among the techniques' scenes.
    pub large: bool,
}

const fn scene(name: &'static str, about: &'static str) -> BenchScene {
    BenchScene { name, about, delta_lights: false, open: false, large: false }
}

const fn open(name: &'static str, about: &'static str) -> BenchScene {
    BenchScene { open: true, large: true, ..scene(name, about) }
}

/// In the order of the tables.
pub const SCENES: &[BenchScene] = &[
    scene("fog-box", "bluish fog, lamp in the fog"),
    scene("empty-box", "no fog"),
    scene("dark-fog", "albedo 0.35 to 0.65, 2.8 mean free paths across"),
    scene("tri-band", "the fog under a fluorescent lamp (F11)"),
    scene("cloud-box", "albedo 0.97 to 0.999, 7 to 10 mean free paths across"),
    scene("small-lamp", "thin bright fog around a small ball"),
    scene("flame", "a small flame in a dark room"),
    BenchScene { delta_lights: true, ..scene("beam", "spotlight of 8 degrees through thin fog") },
    open("cloud-grid", "cloud of 64^3 voxels, albedo 0.7 to 0.99, sky"),
    BenchScene { large: true, ..scene("smoke", "a grid of smoke in a room") },
    BenchScene { large: true, ..scene("room", "textures, rough metal, two lamps") },
    BenchScene { large: true, ..scene("plates", "four metal plates mirror four balls of light") },
    open("terrain", "a million triangles, sky"),
];

/// Where the scenes lie in the repository.
pub fn sources() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("scenes").join("bench")
}

impl BenchScene {
    /// Where it is, among the scenes that [`generate::all`](crate::generate::all) has written into `scenes`.
    pub fn path(&self, scenes: &Path) -> PathBuf {
        scenes.join(self.name).with_extension("pbrt")
    }

    /// Whether the variant finds the scene's light at all.
    pub fn allows(&self, variant: &Variant) -> bool {
        !(self.delta_lights && variant.needs_sized_lights)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Parameters of pbrt-v4 that the scenes use.
    const PBRT: [&str; 36] = [
        "P",
        "coneangle",
        "conedeltaangle",
        "density",
        "eta",
        "filename",
        "filter",
        "fov",
        "from",
        "g",
        "I",
        "indices",
        "k",
        "L",
        "maxdepth",
        "nx",
        "ny",
        "nz",
        "p0",
        "p1",
        "pixelsamples",
        "radius",
        "reflectance",
        "remaproughness",
        "roughness",
        "savefp16",
        "scale",
        "sensor",
        "sigma_a",
        "sigma_s",
        "temperature",
        "to",
        "type",
        "uv",
        "xresolution",
        "yresolution",
    ];
    const TYPES: [&str; 11] = [
        "bool",
        "integer",
        "float",
        "string",
        "spectrum",
        "rgb",
        "blackbody",
        "texture",
        "point2",
        "point3",
        "normal",
    ];

    #[test]
    fn the_scenes_say_nothing_that_pbrt_does_not_know() {
        let mut texts: Vec<String> =
            SCENES.iter().map(|s| crate::generate::text(s.name).expect("it is there")).collect();
        texts.extend([
            crate::generate::text("walls").expect("it is there"),
            crate::generate::grid(&crate::generate::SMOKE, 4),
        ]);
        let mut found = 0;
        for text in texts {
            for quoted in text.split('"').skip(1).step_by(2) {
                let Some((kind, name)) = quoted.split_once(' ') else { continue };
                assert!(TYPES.contains(&kind) && PBRT.contains(&name), "`{quoted}`");
                found += 1;
            }
        }
        assert!(found > 200, "{found}");
    }
}
