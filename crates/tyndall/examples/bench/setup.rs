//! What the command line asks for, and how much work that is.

use crate::scenes::{BenchScene, SCENES};
use std::path::PathBuf;

/// What to measure.
#[derive(Debug)]
pub struct Setup {
    /// Where everything is written.
    pub folder: PathBuf,
    /// Enough to see that everything runs.
    pub quick: bool,
    /// Ten million triangles, too.
    pub full: bool,
    /// Seeds at up to 64 samples per pixel.
    pub seeds: u32,
    /// Scenes.
    pub scenes: Vec<&'static BenchScene>,
    /// The program `tyndall`.
    pub program: Option<PathBuf>,
    /// An earlier `bench.json`.
    pub against: Option<PathBuf>,
}

impl Setup {
    /// `FOLDER [--quick] [--full] [--seeds N] [--scene NAME]... [--program PATH] [--against FILE]`.
    pub fn parse(arguments: &[String]) -> Result<Self, String> {
        let (folder, rest) = arguments.split_first().ok_or("FOLDER is missing")?;
        let mut s = Self {
            folder: PathBuf::from(folder),
            quick: false,
            full: false,
            seeds: 0,
            scenes: Vec::new(),
            program: None,
            against: None,
        };
        let mut rest = rest.iter();
        while let Some(word) = rest.next() {
            let mut value = || rest.next().ok_or_else(|| format!("{word} needs a value"));
            match word.as_str() {
                "--quick" => s.quick = true,
                "--full" => s.full = true,
                "--seeds" => s.seeds = seeds(value()?)?,
                "--scene" => s.scenes.push(named(value()?)?),
                "--program" => s.program = Some(value()?.into()),
                "--against" => s.against = Some(value()?.into()),
                stranger => return Err(format!("no option `{stranger}`")),
            }
        }
        if s.seeds == 0 {
            s.seeds = if s.quick { 3 } else { 8 };
        }
        if s.scenes.is_empty() {
            s.scenes = SCENES.iter().collect();
        }
        Ok(s)
    }

    /// Pixels along each side.
    pub fn resolution(&self) -> u32 {
        if self.quick { 32 } else { 128 }
    }

    /// Pixels along each side in the techniques' table.
    pub fn technique_resolution(&self) -> u32 {
        if self.quick { 16 } else { 64 }
    }

    /// Numbers of samples per pixel.
    pub fn spp(&self) -> &'static [u32] {
        if self.quick { &[4, 16] } else { &[4, 16, 64, 256] }
    }

    /// Seeds at `spp` samples per pixel: half of them where each picture is long.
    pub fn seeds_at(&self, spp: u32) -> u32 {
        if spp > 64 { self.seeds.div_ceil(2).max(2) } else { self.seeds }
    }

    /// Where the scenes are.
    pub fn scene_folder(&self) -> PathBuf {
        self.folder.join("scenes")
    }
}

fn seeds(text: &str) -> Result<u32, String> {
    let refused = || format!("--seeds: a number of at least 2, not `{text}`");
    text.parse().ok().filter(|&n| n >= 2).ok_or_else(refused)
}

fn named(name: &str) -> Result<&'static BenchScene, String> {
    SCENES.iter().find(|s| s.name == name).ok_or_else(|| {
        let names: Vec<&str> = SCENES.iter().map(|s| s.name).collect();
        format!("no scene `{name}`\nhint: the scenes are {}", names.join(", "))
    })
}
