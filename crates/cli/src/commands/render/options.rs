//! From the arguments of `tyndall render` to the library's options.

use std::path::Path;

use tyndall::engine::{EngineError, Quantity, Shard, Target, container};
use tyndall::film::{ErrorMode, Guide, SampleCounts};
use tyndall::geometry::Dispatch;
use tyndall::integrators::layers::{Aov, Orders};
use tyndall::spectral::{LambdaRange, strategy::Rule};
use tyndall::{Options, Spectral, WavelengthPdf, memory};

use super::super::scene;
use crate::args::value::{self, Bands, Crop};
use crate::args::{self, InstructionSet, LightArgs, RenderArgs, SpectralStrategy, StopArgs, WavelengthRule};
use crate::exit::Failure;

/// Wavelengths on a path of `--spectral hero` unless told otherwise.
const HERO: u32 = 8;
/// Wavelengths of the set that a path of `--spectral opaw` carries unless told otherwise.
const OPAW: u32 = 16;

/// The options.
///
/// # Errors
/// When a guide cannot be read, or a range cannot be.
pub fn options(args: &RenderArgs) -> Result<Options, Failure> {
    let mut o = scene::reading(&args.reading)?;
    light(&args.light, &mut o);
    output(args, &mut o);
    stop(&args.stop, &mut o);
    o.dispatch = dispatch(args.run.isa);
    o.shard = args.run.shard.map(|s| Shard { index: s.index, count: s.count });
    if let Some(path) = &args.run.guide {
        o.guide = guide(path)?;
        if o.guide.counts.is_some() && o.target.take().is_some() {
            tracing::info!("the guide fixes the number of samples of each pixel: --until is left out");
        }
    }
    if let (Some(bands), None) = (&args.output.bands, args.reading.range) {
        o.range = covering(o.range, bands);
    }
    Ok(o)
}

fn light(args: &LightArgs, o: &mut Options) {
    o.integrator = args.integrator.map(|i| i.name().to_owned());
    o.max_depth = args.max_depth.map(|d| u32::try_from(d).unwrap_or(u32::MAX));
    o.seed = args.seed;
    o.clamp = args.firefly_clamp.map(|c| c as f32);
    let rule = match args.wavelength_rule {
        Some(WavelengthRule::Endpoints) => Rule::Endpoints,
        Some(WavelengthRule::Meyer) => Rule::Meyer,
        Some(WavelengthRule::Midpoint) | None => Rule::Midpoint,
    };
    let count = args.wavelengths.or((rule == Rule::Meyer).then_some(4));
    o.spectral = match args.strategy() {
        SpectralStrategy::Hero => Spectral::Hero { wavelengths: count.unwrap_or(HERO) },
        SpectralStrategy::Opow => Spectral::Opow { set: count.map(|n| (n, rule)) },
        SpectralStrategy::Opaw => Spectral::Opaw { set: (count.unwrap_or(OPAW), rule) },
        SpectralStrategy::Swc => Spectral::Swc { wavelengths: count.unwrap_or(HERO) },
    };
    o.light_sampling = args.light_sampling.map(|s| s == args::Switch::On);
    o.wavelength_pdf = match args.wavelength_pdf {
        None => WavelengthPdf::Auto,
        Some(args::WavelengthPdf::Light) => WavelengthPdf::Light,
        Some(args::WavelengthPdf::Visible) => WavelengthPdf::Visible,
        Some(args::WavelengthPdf::Uniform) => WavelengthPdf::Uniform,
    };
}

fn output(args: &RenderArgs, o: &mut Options) {
    let out = &args.output;
    o.resolution = out.resolution.map(|r| [r.width, r.height]);
    o.crop = out.crop.map(|Crop { x, y }| [x[0], x[1], y[0], y[1]].map(|f| f as f32));
    o.band_edges = out.bands.as_ref().map(|b| b.edges().into_iter().map(|e| e as f32).collect());
    o.aovs = unique(out.aovs.iter().map(|a| aov(*a)));
    o.orders = out.split_orders.iter().flat_map(|orders| &orders.0).map(order).collect();
}

const fn dispatch(isa: InstructionSet) -> Dispatch {
    match isa {
        InstructionSet::Auto => Dispatch::Detect,
        InstructionSet::Portable => Dispatch::Portable,
        InstructionSet::Avx2 => Dispatch::Avx2,
        InstructionSet::Avx512 => Dispatch::Avx512,
    }
}

fn unique(aovs: impl Iterator<Item = Aov>) -> Vec<Aov> {
    let mut out = Vec::new();
    for aov in aovs {
        if !out.contains(&aov) {
            out.push(aov);
        }
    }
    out
}

const fn aov(aov: value::Aov) -> Aov {
    match aov {
        value::Aov::Depth => Aov::Depth,
        value::Aov::Normal => Aov::Normal,
        value::Aov::Albedo => Aov::Albedo,
        value::Aov::Transmittance => Aov::Transmittance,
        value::Aov::FirstScatter => Aov::FirstScatter,
    }
}

fn order(o: &value::Order) -> Orders {
    Orders { name: format!("order{o}"), first: o.from, last: if o.and_more { u32::MAX } else { o.from } }
}

fn stop(args: &StopArgs, o: &mut Options) {
    o.spp = args.spp;
    o.time = args.time.map(|t| t.0);
    o.errors = match args.error_mode() {
        args::ErrorMode::Conservative => ErrorMode::Conservative,
        args::ErrorMode::Replicated => ErrorMode::REPLICATED,
    };
    o.target = args.until.map(|t| Target {
        quantity: if t.bands { Quantity::Channels } else { Quantity::Luminance },
        probes: args.probe.iter().map(|p| (p.x, p.y)).collect(),
        ..Target::luminance(t.relative)
    });
}

/// The range with the bands, so that bands beyond the visible are not dark.
fn covering(range: LambdaRange, bands: &Bands) -> LambdaRange {
    LambdaRange { min: range.min.min(bands.range.from as f32), max: range.max.max(bands.range.to as f32) }
}

/// What another job has learned: from its film or checkpoint.
fn guide(path: &Path) -> Result<Guide, Failure> {
    let read = container::read(path, memory::available(), |_| Ok(()));
    let (_, state) = read.map_err(|e: EngineError| Failure::of(e.into()))?;
    let Some(counts) = &state.guide.counts else {
        return Err(Failure::input(
            format!("{}: the film has learned nothing", path.display()),
            Some("a guide comes from the film (-o NAME.film) of a run with --until"),
        ));
    };
    // the film's guide speaks of its last look alone; the job as a whole takes everything after the pilot
    let first = vec![Target::luminance(1.0).pilot; counts.end().len()];
    let whole = SampleCounts::new(counts.bounds(), first, counts.end().to_vec());
    whole.map(Guide::with_counts).map_err(|e| Failure::of(e.into()))
}
