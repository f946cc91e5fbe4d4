//! `MakeNamedMedium`: media and their phase functions.

mod cloud;
mod grid;
mod mixture;
mod nanovdb;
mod place;
mod rgb;
mod spectral;

use super::{
    collect::Declared,
    context::{Context, at, refuse},
    emission, phase,
    spectrum::{self, Purpose},
};
use tyndall_geometry::Transform;
use tyndall_pbrt::{Error, ParamSet};
use tyndall_spectral::{Curve, colour::SpaceName, media_presets, upsample};
use tyndall_transport::media::{Homogeneous, Medium};

const KNOWN: [&str; 40] = [
    "type",
    "preset",
    "sigma_a",
    "sigma_s",
    "scale",
    "Le",
    "Lescale",
    "g",
    "phase",
    "absolute",
    "extrapolate",
    "interpolation",
    "depolarisation",
    "alpha",
    "g2",
    "weight",
    "n",
    "mu",
    "k",
    "lines",
    "density",
    "filename",
    "temperature",
    "temperatureoffset",
    "temperaturecutoff",
    "temperaturescale",
    "nx",
    "ny",
    "nz",
    "p0",
    "p1",
    "edge",
    "majorantscale",
    "wispiness",
    "frequency",
    "gridname",
    "temperaturename",
    "bands",
    "media",
    "phasetable",
];

/// Names for messages.
const CLASSES: &str = "homogeneous, uniformgrid, rgbgrid, spectralgrid, cloud, nanovdb, mixture";

/// Finds a medium that was made before.
pub type Known<'a> = dyn Fn(&str) -> Option<&'a Medium> + 'a;

/// The medium of a directive.
pub fn medium(
    ctx: &Context<'_>,
    declared: &Declared,
    units: &mut emission::Units,
    known: &Known<'_>,
) -> Result<Medium, Error> {
    let params = &declared.params;
    let class = params.string("type", "")?;
    let medium = match class.as_str() {
        "homogeneous" => Medium::Homogeneous(homogeneous(ctx, params, units)?),
        "uniformgrid" => {
            let model = grid::model(ctx, params, units)?;
            place::place(ctx, declared, grid::to_medium(params, &model)?, model)?
        }
        "rgbgrid" => {
            let model = rgb::model(ctx, declared, units)?;
            place::place(ctx, declared, grid::to_medium(params, &model)?, model)?
        }
        "spectralgrid" => {
            let model = spectral::model(ctx, params)?;
            place::place(ctx, declared, grid::to_medium(params, &model)?, model)?
        }
        "cloud" => place::place(ctx, declared, Transform::IDENTITY, cloud::model(ctx, params)?)?,
        "nanovdb" => {
            let (model, to_medium) = nanovdb::model(ctx, params, units)?;
            place::place(ctx, declared, to_medium, model)?
        }
        "mixture" => mixture::medium(ctx, declared, known)?,
        "" => return Err(params.missing("string", "type")),
        other => {
            let got = format!("\"{other}\"");
            return Err(refuse(params, "type", "must be a medium that is supported", got)
                .hint(format!("one of {CLASSES}")));
        }
    };
    ctx.finish(params, &KNOWN);
    Ok(medium)
}

fn homogeneous(
    ctx: &Context<'_>,
    params: &ParamSet,
    units: &mut emission::Units,
) -> Result<Homogeneous, Error> {
    let [sigma_a, sigma_s] = scaled_coefficients(ctx, params)?;
    let le = emission::of_medium(ctx, params, units)?;
    let phase = phase::phase(ctx, params)?;
    Homogeneous::new(sigma_a, sigma_s, le, phase, ctx.range).map_err(|e| at(params, e))
}

/// sigma_a and sigma_s times `scale`, all checked.
fn scaled_coefficients(ctx: &Context<'_>, params: &ParamSet) -> Result<[Curve; 2], Error> {
    let coefficients = coefficients(ctx, params)?;
    for (name, curve) in ["sigma_a", "sigma_s"].into_iter().zip(&coefficients) {
        let least = curve.min_value(ctx.range);
        if least < 0.0 {
            return Err(refuse(params, name, "must be >= 0", format!("{least} 1/m")));
        }
    }
    let scale = scale(params)?;
    Ok(coefficients.map(|c| c.scaled(scale)))
}

/// The factor of all coefficients.
fn scale(params: &ParamSet) -> Result<f32, Error> {
    let scale = params.float("scale", 1.0)?;
    if scale >= 0.0 && scale.is_finite() {
        return Ok(scale);
    }
    Err(refuse(params, "scale", "must be finite and >= 0", scale))
}

/// sigma_a, sigma_s: of a preset (in 1/mm as pbrt has them, used as they stand), else given, else 1.
fn coefficients(ctx: &Context<'_>, params: &ParamSet) -> Result<[Curve; 2], Error> {
    let preset = params.string("preset", "")?;
    if !preset.is_empty() {
        return match media_presets::medium_preset(&preset) {
            Some(p) => {
                params.warn_at("preset", PRESET_NOTE, ctx.warnings);
                for name in ["sigma_a", "sigma_s"] {
                    params.ignore(name, "the preset gives it");
                }
                let spectrum = |rgb| upsample::unbounded(SpaceName::Srgb, rgb).map_err(|e| at(params, e));
                Ok([spectrum(p.sigma_a)?, spectrum(p.sigma_prime_s)?])
            }
            None => {
                let names: Vec<_> = media_presets::names().collect();
                let hint = tyndall_pbrt::did_you_mean(&preset, names.iter().copied())
                    .unwrap_or_else(|| format!("known presets: {}", names.join(", ")));
                Err(refuse(params, "preset", "must be a known medium", format!("\"{preset}\"")).hint(hint))
            }
        };
    }
    let one = |name| {
        Ok::<_, Error>(spectrum::float_or_curve(ctx, params, name, Purpose::Unbounded)?.unwrap_or(Curve::ONE))
    };
    Ok([one("sigma_a")?, one("sigma_s")?])
}

const PRESET_NOTE: &str = "preset coefficients are reduced scattering and absorption in 1/mm, used as 1 per scene unit as pbrt does";
