//! A scene and options become a pass and a job.

use crate::{
    Error, Options,
    camera_matrices::CameraMatrices,
    options::{Spectral, WavelengthPdf},
    provenance::{entry, join},
    strategy,
};
use std::{path::Path, sync::Arc};
use tyndall_engine::Job;
use tyndall_film::{Channels, ErrorMode, FilmSpec, PixelBounds};
use tyndall_geometry::Dispatch;
use tyndall_integrators::{
    isa::Isa,
    layers::{Aov, Layers},
    pixel::{Lanes, PixelPass},
    refine::Refinement,
    reuse::Level,
};
use tyndall_io::{LoadOptions, LoadedScene, load_file, load_text, scene::crop_bounds};
use tyndall_spectral::LambdaRange;
use tyndall_transport::Scene;

/// The scene that is rendered when none is named: a Cornell box filled with bluish fog, absolute units.
pub const BUILT_IN_NAME: &str = "cornell-fog";
const BUILT_IN: &str = include_str!("../scenes/cornell-fog.pbrt");

/// Where a scene comes from.
#[derive(Clone, Copy, Debug)]
pub enum Source<'a> {
    /// The scene inside the program.
    BuiltIn,
    /// A file.
    File(&'a Path),
    /// A text with a name for messages; files are looked for in the folder.
    Text(&'a str, &'a str, &'a Path),
}

/// Everything needed to render.
#[derive(Debug)]
pub struct Plan {
    /// The scene's description beside the scene itself.
    pub loaded: LoadedScene,
    /// Turns units of work into patches.
    pub pass: PixelPass,
    /// What is to be done.
    pub job: Job,
    /// Spectral range of the job.
    pub range: LambdaRange,
    /// The spectral strategy.
    pub spectral: Spectral,
    /// What a reader of the image should know about the strategy.
    pub notes: Vec<String>,
    /// The integrator's name.
    pub integrator: String,
    /// The image's channels: RGB, then bands.
    pub channels: Channels,
}

/// Loads the scene and nothing more.
pub fn load(source: Source<'_>, options: &Options) -> Result<LoadedScene, Error> {
    let load = LoadOptions {
        range: options.range,
        strict: options.strict,
        integrator: options.integrator.clone(),
        dispatch: options.dispatch,
        set: options.set.clone(),
    };
    let loaded = match source {
        Source::BuiltIn => {
            load_text(&format!("{BUILT_IN_NAME}.pbrt (built in)"), BUILT_IN, Path::new(""), &load)?
        }
        Source::File(path) => load_file(path, &load)?,
        Source::Text(name, text, dir) => load_text(name, text, dir, &load)?,
    };
    if loaded.scene.emitters().is_empty() {
        loaded.diagnostics.warn_without_place("nothing in the scene gives light: the picture will be black");
    }
    Ok(loaded)
}

/// Loads the scene and plans the job.
pub fn plan(source: Source<'_>, options: &Options) -> Result<Plan, Error> {
    let mut loaded = load(source, options)?;
    reframe(&mut loaded, options)?;
    if let Some(edges) = &options.band_edges {
        loaded.film.band_edges.clone_from(edges);
    }
    check_bands(&loaded.film.band_edges, options.range)?;
    let channels = strategy::channels(&loaded.film, options)?;
    let settings = {
        let mut s = loaded.integrator.settings.clone();
        s.sampler = loaded.sampler.kind;
        s.max_depth = options.max_depth.unwrap_or(s.max_depth);
        s.light_sampling = options.light_sampling.unwrap_or(s.light_sampling);
        s
    };
    let method = loaded.integrator.method;
    let spectral = strategy::effective(options.spectral, method)?;
    strategy::check_method(method, &settings, &loaded.scene)?;
    strategy::check_media(method, spectral, &loaded)?;
    let pdf = strategy::density(options.wavelength_pdf, method);
    let wavelengths = strategy::sampler(&loaded, options, spectral, pdf)?;
    let lanes = strategy::lanes(method, spectral)?;
    let sharing = strategy::sharing(spectral, &wavelengths, &loaded.scene);
    strategy::check_layers(spectral, options)?;
    let layers = Layers {
        orders: options.orders.clone(),
        aovs: aovs(&loaded, options),
        flat: flat(&channels, options.range),
    };
    let seed = options.seed.unwrap_or(loaded.sampler.seed);
    let spec = Arc::new(film_spec(&loaded, options, &channels, &layers, seed));
    let spp = options.spp.unwrap_or(loaded.sampler.spp);
    let mut job = Job::new(spec, spp);
    job.scene_hash.clone_from(&loaded.hash);
    job.settings = identity(&loaded, options, &settings, lanes, spectral, pdf);
    (job.target, job.time, job.shard) = (options.target.clone(), options.time, options.shard);
    job.guide = options.guide.clone();
    job.validate()?;
    let replicates = match options.errors {
        ErrorMode::Conservative => 1,
        ErrorMode::Replicated { replicates } => replicates,
    };
    let notes = strategy::notes(spectral, &loaded.scene, options.range);
    let scene = std::mem::replace(&mut loaded.scene, Scene::empty());
    let pass = PixelPass {
        scene: Arc::new(scene),
        method,
        settings,
        lanes,
        sharing,
        wavelengths,
        channels: channels.clone(),
        filter: loaded.filter.clone(),
        layers,
        resolution: loaded.film.resolution,
        seed,
        replicates,
        isa: isa(options.dispatch)?,
        grouping: None,
        level: Level::NONE,
        refinement: Refinement::default(),
    }
    .learning(loaded.film.resolution);
    Arc::make_mut(&mut job.film).square = pass.shared_side();
    let integrator = loaded.integrator.name.clone();
    Ok(Plan { loaded, pass, job, range: options.range, spectral, notes, integrator, channels })
}

fn isa(dispatch: Dispatch) -> Result<Isa, Error> {
    Isa::choose(dispatch).ok_or_else(|| {
        let what = format!("--isa: this processor does not have the instructions of {dispatch:?}");
        Error::options(what, Some("auto takes the fastest that it has; the numbers are the same".into()))
    })
}

/// Another size, another part.
fn reframe(loaded: &mut LoadedScene, options: &Options) -> Result<(), Error> {
    if let Some(resolution) = options.resolution {
        let scene = std::mem::replace(&mut loaded.scene, Scene::empty());
        loaded.scene = Scene { camera: scene.camera.clone().resized(resolution), ..scene };
        loaded.film.resolution = resolution;
        loaded.film.bounds = PixelBounds::new(0, 0, resolution[0], resolution[1]);
    }
    if let Some(crop) = options.crop {
        loaded.film.bounds = crop_bounds(crop, loaded.film.resolution);
        if loaded.film.bounds.area() == 0 {
            return Err(Error::options(
                format!(
                    "--crop: expected a window that holds a pixel, got {crop:?} of {:?}",
                    loaded.film.resolution
                ),
                Some("x0,x1,y0,y1 are fractions of the picture from its upper left corner".into()),
            ));
        }
    }
    Ok(())
}

/// Bands beyond the range of the job would be dark in silence.
fn check_bands(edges: &[f32], range: LambdaRange) -> Result<(), Error> {
    let (Some(&first), Some(&last)) = (edges.first(), edges.last()) else { return Ok(()) };
    if range.contains(first) && range.contains(last) {
        return Ok(());
    }
    Err(Error::options(
        format!("spectral bands: expected edges within {range}, got {first} to {last} nm"),
        Some(format!("--range {}:{} covers them", first.min(range.min), last.max(range.max))),
    ))
}

/// The layers that are asked for, else those of a `gbuffer` film.
fn aovs(loaded: &LoadedScene, options: &Options) -> Vec<Aov> {
    if options.aovs.is_empty() && loaded.film.gbuffer {
        return vec![Aov::Depth, Aov::Normal, Aov::Albedo];
    }
    options.aovs.clone()
}

/// The channels' response to a flat spectrum of value 1 over the range.
fn flat(channels: &Channels, range: LambdaRange) -> Vec<f32> {
    let steps = 4 * range.width().ceil() as usize;
    let mut sum = vec![0.0f64; channels.len()];
    let mut out = vec![0.0f32; channels.len()];
    for i in 0..steps {
        let lambda = range.min + range.width() * (i as f32 + 0.5) / steps as f32;
        let w = tyndall_spectral::Wavelengths::continuum([lambda], [1.0 / range.width()]);
        channels.respond(&tyndall_spectral::Spectrum([1.0]), &w, &mut out);
        sum.iter_mut().zip(&out).for_each(|(s, o)| *s += f64::from(*o) / steps as f64);
    }
    sum.into_iter().map(|s| s as f32).collect()
}

fn film_spec(
    loaded: &LoadedScene,
    options: &Options,
    channels: &Channels,
    layers: &Layers,
    seed: u64,
) -> FilmSpec {
    let group = channels.group(crate::units::channel_unit(&loaded.units));
    let mut spec = FilmSpec::new(loaded.film.resolution, group.clone(), channels.luminance(), options.errors);
    for layer in layers.groups(&group) {
        spec = spec.with_group(layer);
    }
    spec.bounds = loaded.film.bounds;
    spec.weights = loaded.filter.weights();
    spec.clamp = options.clamp;
    spec.seed = seed;
    spec
}

/// Whatever the samples depend on beyond the film: jobs that differ here do not mix. With it a film on disk becomes an
/// image without its scene, see [`crate::Provenance`].
fn identity(
    loaded: &LoadedScene,
    options: &Options,
    settings: &tyndall_integrators::Settings,
    lanes: Lanes,
    spectral: Spectral,
    pdf: WavelengthPdf,
) -> Vec<(String, String)> {
    let pair = |k: &str, v: String| (k.to_owned(), v);
    let wavelengths = match (spectral, spectral.set()) {
        (_, Some((count, _))) => count.to_string(),
        (Spectral::Opow { .. }, None) => "continuum".into(),
        _ => lanes.count().to_string(),
    };
    let rule = spectral.set().map_or_else(|| format!("{pdf:?}"), |(_, rule)| format!("{rule:?}"));
    vec![
        pair(entry::INTEGRATOR, loaded.integrator.name.clone()),
        pair("integrator settings", format!("{settings:?}")),
        pair(entry::SPECTRAL, spectral.name().into()),
        pair(entry::WAVELENGTHS, wavelengths),
        pair("wavelength density", rule),
        pair(entry::RANGE, join(&[options.range.min, options.range.max])),
        pair("pixel filter", format!("{:?}", loaded.filter)),
        pair("overrides", options.set.join(" ")),
        pair(entry::SPACE, loaded.film.space.name().into()),
        pair(entry::UNITS, crate::units::of(&loaded.units).into()),
        pair(entry::BANDS, join(&loaded.film.band_edges)),
        pair(entry::CAMERA, join(&CameraMatrices::of(&loaded.scene.camera).numbers())),
    ]
}
