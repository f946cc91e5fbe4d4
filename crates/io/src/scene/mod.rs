//! pbrt-v4 scenes into a [`Scene`] and what to do with it.

mod build;
mod camera;
mod collect;
mod color_space;
mod context;
mod degenerate;
mod emission;
mod files;
mod film;
mod image;
mod leftovers;
mod light;
mod material;
mod medium;
mod overrides;
mod phase;
mod phase_table;
mod render;
mod sensor;
mod shape;
mod spectrum;
mod state;
mod texture;

pub use emission::Units;
pub use film::{FilmDescription, crop_bounds};
pub use render::{INTEGRATORS, IntegratorDescription, SamplerDescription, integrator_named, unlimited};

use files::FoundFile;
use std::{cell::RefCell, collections::HashSet, path::Path, sync::Arc, time::Instant};
use tyndall_film::PixelFilter;
use tyndall_geometry::{BuildStats, Dispatch};
use tyndall_pbrt::{Diagnostics, Error, Inventory, Parser, SourceMap};
use tyndall_spectral::LambdaRange;
use tyndall_transport::Scene;

/// How to load.
#[derive(Clone, Debug)]
pub struct LoadOptions {
    /// Wavelengths of the job \[nm\].
    pub range: LambdaRange,
    /// Doubtful tables are errors.
    pub strict: bool,
    /// Another integrator than the scene's, by name.
    pub integrator: Option<String>,
    /// Instructions of the ray traversal.
    pub dispatch: Dispatch,
    /// Values that replace those of the scene, as `NAME.PARAM=VALUE`.
    pub set: Vec<String>,
}

impl Default for LoadOptions {
    fn default() -> Self {
        Self {
            range: LambdaRange::VISIBLE,
            strict: false,
            integrator: None,
            dispatch: Dispatch::Detect,
            set: Vec::new(),
        }
    }
}

/// A scene with its render options.
#[derive(Debug)]
pub struct LoadedScene {
    /// The scene.
    pub scene: Scene,
    /// Film.
    pub film: FilmDescription,
    /// Pixel filter.
    pub filter: PixelFilter,
    /// Samples.
    pub sampler: SamplerDescription,
    /// Integrator.
    pub integrator: IntegratorDescription,
    /// Units of the emitters.
    pub units: Units,
    /// Names of the media, by [`tyndall_transport::MediumId`].
    pub media: Vec<String>,
    /// Every parameter and what became of it.
    pub inventory: Inventory,
    /// The files that its places refer to.
    pub sources: SourceMap,
    /// Warnings and notes.
    pub diagnostics: Arc<Diagnostics>,
    /// blake3 over everything read, in order: scene text, meshes, images, spectra.
    pub hash: String,
    /// What the acceleration structure holds.
    pub stats: BuildStats,
    /// Seconds to read the files and make the scene, and to build the acceleration structure.
    pub seconds: [f64; 2],
}

/// Loads a scene file.
///
/// # Errors
/// The first mistake, with its place.
pub fn load_file(path: &Path, options: &LoadOptions) -> Result<LoadedScene, Error> {
    load(Parser::open(path)?, options)
}

/// Loads a scene from memory; `name` is for messages, files are looked for in `dir`.
///
/// # Errors
/// The first mistake, with its place.
pub fn load_text(name: &str, text: &str, dir: &Path, options: &LoadOptions) -> Result<LoadedScene, Error> {
    load(Parser::from_bytes(name, text.as_bytes().to_vec(), dir)?, options)
}

fn load(mut parser: Parser, options: &LoadOptions) -> Result<LoadedScene, Error> {
    let start = Instant::now();
    let diagnostics = parser.diagnostics().clone();
    let mut collected = collect::collect(&mut parser, &diagnostics)?;
    let mut inventory = parser.inventory().clone();
    let overrides = overrides::apply(&mut collected, &mut inventory, &options.set)?;
    let files = RefCell::default();
    let ctx = context::Context {
        range: options.range,
        strict: options.strict,
        warnings: &diagnostics,
        resolver: parser.resolver(),
        files: &files,
    };
    let mut loaded = build::build(&ctx, &collected, options, inventory)?;
    overrides::check(&overrides)?;
    leftovers::mark(&loaded.inventory);
    loaded.hash = hash(&parser, &files.borrow())?;
    loaded.sources = parser.sources().clone();
    loaded.diagnostics = diagnostics.clone();
    loaded.seconds[0] = start.elapsed().as_secs_f64() - loaded.seconds[1];
    Ok(loaded)
}

/// Hash of the scene's text and of the meshes, images and spectra it names, in the order they were read.
fn hash(parser: &Parser, files: &[FoundFile]) -> Result<String, Error> {
    let mut hasher = blake3::Hasher::new();
    let mut add = |bytes: &[u8]| {
        hasher.update(&(bytes.len() as u64).to_le_bytes());
        hasher.update(bytes);
    };
    for file in parser.sources().files() {
        add(file.bytes());
    }
    let mut seen = HashSet::new();
    for file in files.iter().filter(|file| seen.insert(file.path())) {
        add(&file.read()?);
    }
    Ok(hasher.finalize().to_hex().to_string())
}
