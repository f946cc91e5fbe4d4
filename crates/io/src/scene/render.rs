//! `Sampler`, `Integrator` and `Option`.

use super::{
    collect::{Collected, Declared},
    context::{Context, refuse},
};
use tyndall_integrators::{Equiangular, Guiding, Settings, pixel::Method};
use tyndall_pbrt::{EntityKind, Error, OptionValue, ParamSet};
use tyndall_transport::{
    light::{LightRules, MediumLights, Selection, Skies},
    sampler::SamplerKind,
};

/// Samples per pixel, their kind and the seed.
#[derive(Clone, Copy, Debug)]
pub struct SamplerDescription {
    /// Points of the first dimensions.
    pub kind: SamplerKind,
    /// Samples per pixel.
    pub spp: u32,
    /// Seed.
    pub seed: u64,
}

/// The sampler; pbrt's default is zsobol with 16 samples per pixel.
pub fn sampler(ctx: &Context<'_>, collected: &Collected) -> Result<SamplerDescription, Error> {
    let mut found = SamplerDescription { kind: SamplerKind::OwenSobol, spp: 16, seed: 0 };
    for (key, name, value) in &collected.globals {
        if key != "seed" {
            let message = format!("Option \"{}\" has no effect here", name.as_str());
            ctx.warnings.warn(collected.place(name), message);
        } else {
            match value {
                OptionValue::Number(seed) if *seed >= 0.0 && seed.fract() == 0.0 => found.seed = *seed as u64,
                _ => {
                    let message = format!("Option \"{}\": expected a whole number >= 0", name.as_str());
                    return Err(Error::in_file(tyndall_pbrt::ErrorKind::Other(message), "scene"));
                }
            }
        }
    }
    let Some(declared) = collected.options.get(&EntityKind::Sampler) else { return Ok(found) };
    let p = &declared.params;
    found.kind = match declared.name.as_str() {
        "zsobol" | "sobol" | "paddedsobol" | "halton" | "pmj02bn" | "stratified" => SamplerKind::OwenSobol,
        "independent" => SamplerKind::Independent,
        other => {
            let hint = "zsobol, sobol, paddedsobol, halton, pmj02bn, stratified or independent";
            return Err(p.error(format!("sampler \"{other}\" is unknown")).hint(hint));
        }
    };
    for name in ["randomization", "jitter"] {
        p.ignore(name, "our points are Owen-scrambled");
    }
    let spp = if declared.name.as_str() == "stratified" {
        p.integer("xsamples", 4)?.saturating_mul(p.integer("ysamples", 4)?)
    } else {
        p.integer("pixelsamples", 16)?
    };
    if spp < 1 {
        return Err(refuse(p, "pixelsamples", "must be at least 1", spp));
    }
    found.spp = spp as u32;
    if let Some(seed) = p.integer_opt("seed")? {
        found.seed = u64::from(seed.unsigned_abs());
    }
    ctx.finish(p, &["pixelsamples", "seed", "xsamples", "ysamples", "jitter", "randomization"]);
    Ok(found)
}

/// The integrator.
#[derive(Clone, Debug)]
pub struct IntegratorDescription {
    /// Its name in the scene.
    pub name: String,
    /// What runs.
    pub method: Method,
    /// Its switches.
    pub settings: Settings,
    /// Media are left out, as pbrt's `path` does.
    pub ignores_media: bool,
    /// How lights are sampled.
    pub lights: LightRules,
}

/// What an integrator's name stands for: the method, and whether media are left out.
pub fn integrator_named(name: &str) -> Option<(Method, bool)> {
    match name {
        "volpath" | "simplevolpath" => Some((Method::Volpath, false)),
        "path" | "simplepath" => Some((Method::Volpath, true)),
        "analog" => Some((Method::Analog, false)),
        "wang-chern" => Some((Method::WangChern, false)),
        _ => None,
    }
}

/// Names for messages.
pub const INTEGRATORS: &str =
    "volpath, analog, wang-chern, path (leaves media out), simplepath and simplevolpath";

const KNOWN: &[&str] = &[
    "maxdepth",
    "regularize",
    "lightsampler",
    "equiangular",
    "lightsampling",
    "mediumlights",
    "skies",
    "exacttransmittance",
    "residualratio",
    "survival",
    "coneclipping",
    "roulettedepth",
    "glow",
    "guiding",
    "eachlight",
    "power",
    "pathreuse",
    "sharedlevel",
    "refine",
    "roulettethreshold",
    "samplebsdf",
    "samplelights",
    "visualizestrategies",
    "visualizeweights",
    "russianroulette",
];

/// The integrator of the scene; pbrt's default is volpath.
pub fn integrator(ctx: &Context<'_>, declared: Option<&Declared>) -> Result<IntegratorDescription, Error> {
    let Some(declared) = declared else {
        let (name, settings) = ("volpath".into(), Settings::default());
        let method = Method::Volpath;
        return Ok(IntegratorDescription {
            name,
            method,
            settings,
            ignores_media: false,
            lights: LightRules::default(),
        });
    };
    let p = &declared.params;
    let name = declared.name.as_str();
    let Some((method, ignores_media)) = integrator_named(name) else {
        let hint = format!("this version has {INTEGRATORS}; --integrator volpath overrides the scene");
        return Err(p.error(format!("integrator \"{name}\" is not supported")).hint(hint));
    };
    if name.starts_with("simple") {
        ctx.warnings
            .note(p.place(), format!("integrator \"{name}\" runs as volpath: the same mean with less noise"));
    }
    for name in ["samplebsdf", "samplelights"] {
        p.ignore(name, "directions are chosen by both techniques");
    }
    let settings = settings(p, method)?;
    let lights = LightRules {
        selection: selection(p)?,
        media: when(p, "mediumlights", [MediumLights::Auto, MediumLights::Off, MediumLights::Always])?,
        skies: skies(p)?,
        each: settings.each_light,
    };
    ctx.finish(p, KNOWN);
    Ok(IntegratorDescription { name: name.into(), method, settings, ignores_media, lights })
}

fn skies(p: &ParamSet) -> Result<Skies, Error> {
    match p.string("skies", "auto")?.as_str() {
        "auto" => Ok(Skies::Auto),
        "always" => Ok(Skies::Always),
        other => Err(refuse(p, "skies", "must be auto or always", format!("\"{other}\""))),
    }
}

fn selection(p: &ParamSet) -> Result<Selection, Error> {
    match p.string("lightsampler", "bvh")?.as_str() {
        // the exhaustive one weighs every light as the tree weighs its leaves
        "bvh" | "exhaustive" => Ok(Selection::Tree),
        "power" => Ok(Selection::Power),
        "uniform" => Ok(Selection::Uniform),
        other => {
            let got = format!("\"{other}\"");
            Err(refuse(p, "lightsampler", "must be bvh, power, uniform or exhaustive", got))
        }
    }
}

/// A technique that is on by itself where it pays: the value for `auto` (the default), `off` or `always`.
fn when<T>(p: &ParamSet, name: &str, [auto, off, always]: [T; 3]) -> Result<T, Error> {
    match p.string(name, "auto")?.as_str() {
        "auto" => Ok(auto),
        "off" => Ok(off),
        "always" => Ok(always),
        other => Err(refuse(p, name, "must be \"auto\", \"off\" or \"always\"", format!("\"{other}\""))),
    }
}

/// The switches of a method where the scene says nothing: the paper's paths meet lights by chance.
pub(super) fn default_settings(method: Method) -> Settings {
    Settings { light_sampling: method != Method::WangChern, ..Settings::default() }
}

fn settings(p: &ParamSet, method: Method) -> Result<Settings, Error> {
    let default = default_settings(method);
    let depth = p.integer("maxdepth", 5)?;
    let equiangular = when(p, "equiangular", [Equiangular::Auto, Equiangular::Off, Equiangular::Always])?;
    let threshold = p.float("roulettethreshold", default.roulette_threshold)?;
    if !(threshold > 0.0 && threshold.is_finite()) {
        return Err(refuse(p, "roulettethreshold", "must be > 0", threshold));
    }
    let roulette = match p.integer_opt("roulettedepth")? {
        None => default.roulette_depth,
        Some(depth) => unlimited(depth),
    };
    Ok(Settings {
        max_depth: unlimited(depth),
        regularize: p.bool("regularize", false)?,
        light_sampling: p.bool("lightsampling", default.light_sampling)?,
        exact_transmittance: p.bool("exacttransmittance", default.exact_transmittance)?,
        residual: p.bool("residualratio", default.residual)?,
        survival: p.bool("survival", default.survival)?,
        equiangular,
        cone_clipping: p.bool("coneclipping", default.cone_clipping)?,
        glow: p.bool("glow", default.glow)?,
        guiding: when(p, "guiding", [Guiding::Auto, Guiding::Off, Guiding::Always])?,
        reuse: p.bool("pathreuse", default.reuse)?,
        level: p.bool("sharedlevel", default.level)?,
        refine: p.bool("refine", default.refine)?,
        each_light: p.bool("eachlight", default.each_light)?,
        power: p.bool("power", default.power)?,
        roulette_depth: if p.bool("russianroulette", true)? { roulette } else { u32::MAX },
        roulette_threshold: threshold,
        ..default
    })
}

/// Negative stands for no limit.
pub fn unlimited(depth: i32) -> u32 {
    u32::try_from(depth).unwrap_or(u32::MAX)
}
