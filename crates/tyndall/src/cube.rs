//! An image as NetCDF: the spectral cube with its errors, layers as variables, for xarray and its like.

use crate::{
    Error, Image,
    image::{attribute, ordered},
    statistics, table, units,
};
use std::path::Path;
use tyndall_files::image::{MetaValue, Pixels, SpectralChannel, SpectralKind, spectral_channels};
use tyndall_files::netcdf::{Axis, Dataset, Variable, netcdf_text, write_netcdf};

/// Name of the attribute that tells the job.
const JOB: &str = "tyndall_job";
/// Spectral radiance over wavelength, row and column.
const RADIANCE: &str = "radiance";

/// Writes the image.
///
/// Spectral bands become `radiance(wavelength, y, x)` with the edges of the bands, orders of scattering `order0_radiance` and so
/// on; every other channel is a variable over rows and columns. Standard errors are the variables of the same names with `_se`.
///
/// # Errors
/// When the file cannot be written.
pub fn write(path: &Path, image: &Image) -> Result<(), Error> {
    let window = image.values.window();
    let edges = image.band_edges().filter(|e| e.len() > 1);
    let axis = edges.map(|edges| Axis {
        name: "wavelength",
        unit: "nm",
        long_name: "wavelength in vacuum, centre of the band",
        edges,
    });
    let bands = axis.as_ref().map_or(0, |a| a.edges.len() - 1);
    let absolute = image.is_absolute();
    let mut variables = variables(&image.values, bands, absolute, Kind::Value);
    if let Some(errors) = &image.errors {
        let names: Vec<String> = variables.iter().map(|v| v.name.clone()).collect();
        variables.extend(self::variables(errors, bands, absolute, Kind::Error).into_iter().filter(|v| {
            v.name.starts_with("statistics_")
                || v.name.strip_suffix(SE).is_some_and(|n| names.iter().any(|m| m == n))
        }));
        link_errors(&mut variables);
    }
    let data = Dataset {
        size: [window.width, window.height],
        origin: [window.x0, window.y0],
        axis,
        variables,
        attributes: attributes(image),
    };
    Ok(write_netcdf(path, &data)?)
}

const SE: &str = "_se";

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Value,
    Error,
}

/// Cubes of bands, then the channels that are none.
fn variables(pixels: &Pixels, bands: usize, absolute: bool, kind: Kind) -> Vec<Variable<'_>> {
    let mut out = Vec::new();
    let mut used = Vec::new();
    let emissive = |c: &SpectralChannel<'_>| c.kind == SpectralKind::Stokes(0);
    let spectral: Vec<_> = spectral_channels(pixels).into_iter().filter(emissive).collect();
    let mut layers: Vec<String> = Vec::new();
    for c in &spectral {
        let layer = layer_of(&c.channel.name);
        if !layers.contains(&layer) {
            layers.push(layer);
        }
    }
    for layer in layers {
        let mut cube: Vec<_> = spectral.iter().filter(|c| layer_of(&c.channel.name) == layer).collect();
        cube.sort_by(|a, b| a.lambda_nm.total_cmp(&b.lambda_nm));
        // bands of another kind stay single planes
        if cube.len() == bands {
            used.extend(cube.iter().map(|c| c.channel.name.clone()));
            let planes = cube.iter().map(|c| c.channel.data.as_slice()).collect();
            let unit = table::unit(&cube[0].channel.name, absolute);
            out.push(variable(&cube_name(&layer), unit, planes, true, kind));
        }
    }
    // files sort channels by name; the order here is always the same
    let mut rest = ordered(pixels);
    rest.sort_by_key(|c| statistics::NAMES.iter().position(|n| *n == c.name));
    for channel in rest.into_iter().filter(|c| !used.contains(&c.name)) {
        let unit = table::unit(&channel.name, absolute);
        out.push(variable(&identifier(&channel.name), unit, vec![&channel.data], false, kind));
    }
    out
}

fn variable<'a>(name: &str, unit: &str, planes: Vec<&'a [f32]>, stacked: bool, kind: Kind) -> Variable<'a> {
    let marks = statistics::NAMES.iter().any(|n| identifier(n) == name);
    let (name, long_name) = match kind {
        Kind::Error if !marks => {
            (format!("{name}{SE}"), format!("standard error of {name}; inf where unknown"))
        }
        _ => (name.to_owned(), describe(name)),
    };
    Variable { name, unit: unit.to_owned(), long_name, errors: None, planes, stacked }
}

fn link_errors(variables: &mut [Variable<'_>]) {
    let names: Vec<String> = variables.iter().map(|v| v.name.clone()).collect();
    for v in variables {
        let errors = format!("{}{SE}", v.name);
        v.errors = names.contains(&errors).then_some(errors);
    }
}

/// `order0` of `order0.S0.550,000000nm`; nothing for the image itself.
fn layer_of(channel: &str) -> String {
    channel.split_once("S0.").map_or("", |(layer, _)| layer.trim_end_matches('.')).to_owned()
}

fn cube_name(layer: &str) -> String {
    if layer.is_empty() { RADIANCE.into() } else { format!("{}_{RADIANCE}", identifier(layer)) }
}

/// Letters, digits and `_`: what every program takes as a name.
fn identifier(channel: &str) -> String {
    let plus = channel.replace('+', "plus");
    plus.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect()
}

fn describe(name: &str) -> String {
    match name {
        RADIANCE => "spectral radiance, mean over the band".into(),
        "statistics_samples" => "samples in the pixel".into(),
        "statistics_freedom" => "degrees of freedom of the standard errors".into(),
        "statistics_dominated" => {
            "1 where one sample carries half of the variance of luminance or more".into()
        }
        "statistics_pooled" => "1 where standard errors are those of the tile".into(),
        other => other.replace('_', " "),
    }
}

fn attributes(image: &Image) -> Vec<(String, String)> {
    let text = |name: &str| match image.values.meta.get(name) {
        Some(MetaValue::Text(t)) => Some(t.clone()),
        Some(MetaValue::Int(n)) => Some(n.to_string()),
        Some(MetaValue::Texts(lines)) => Some(lines.join("\n")),
        _ => None,
    };
    let all = [
        (JOB, attribute::JOB),
        ("source", "software"),
        ("scene_hash", attribute::SCENE),
        ("seed", attribute::SEED),
        ("colour_space", attribute::SPACE),
        ("error_mode", attribute::ERROR_MODE),
        ("pixels_share_errors", attribute::SQUARE),
        ("samples_per_pixel", attribute::SAMPLES),
        ("settings", attribute::SETTINGS),
    ];
    let mut out: Vec<_> =
        all.into_iter().filter_map(|(name, from)| Some((name.to_owned(), text(from)?))).collect();
    let unit = if image.is_absolute() { units::ABSOLUTE } else { units::NORMALISED };
    out.push(("unit_of_spectral_radiance".into(), unit.into()));
    out
}

/// The job that a file belongs to.
pub(crate) fn job_of(path: &Path) -> Option<String> {
    netcdf_text(path, JOB)
}
