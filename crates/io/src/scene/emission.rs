//! Emission: pbrt's normalisation, or values as they are given with `"bool absolute" true`.
//!
//! pbrt-v4 divides the spectrum of every light by its integral with y-bar, so that `scale` is a luminance in units
//! that its film does not undo; such scenes have no absolute unit. Ours keep W, m and nm. Spectral lines:
//! `"float lines" [lambda power ...]`, power in the unit of the continuum times nm.

use super::{
    color_space,
    context::{Context, at, refuse},
    spectrum::{self, Light, Purpose},
};
use tyndall_pbrt::{Error, ParamSet};
use tyndall_spectral::{Emission, Line, cie};

/// Which units the scene's emitters use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Units {
    /// An emitter is normalised by pbrt's rule.
    pub normalised: bool,
    /// An emitter has absolute values.
    pub absolute: bool,
}

/// The emission parameter `name` of a light with its `scale` and lines; pbrt's default is the colour space's white.
pub fn of_light(
    ctx: &Context<'_>,
    params: &ParamSet,
    name: &str,
    space: &str,
    units: &mut Units,
) -> Result<Emission, Error> {
    let scale = f64::from(params.float("scale", 1.0)?);
    let lines = lines(params)?;
    let white = || {
        let curve = color_space::find(space).illuminant.clone();
        let photometric = cie::y_integral(&curve);
        Light { curve, photometric }
    };
    let given = spectrum::light(ctx, params, name, Purpose::Illuminant)?;
    let light = match given {
        Some(light) => light,
        None if lines.is_empty() => white(),
        None => Light { curve: tyndall_spectral::Curve::ZERO, photometric: 0.0 },
    };
    build(params, light, lines, scale, units)
}

/// `Le` and `Lescale` of a medium; `None` where it does not emit.
pub fn of_medium(ctx: &Context<'_>, params: &ParamSet, units: &mut Units) -> Result<Option<Emission>, Error> {
    let scale = f64::from(params.float("Lescale", 1.0)?);
    of_medium_scaled(ctx, params, scale, units)
}

/// `Le` of a medium times `scale`.
pub fn of_medium_scaled(
    ctx: &Context<'_>,
    params: &ParamSet,
    scale: f64,
    units: &mut Units,
) -> Result<Option<Emission>, Error> {
    let lines = lines(params)?;
    let Some(light) = spectrum::light(ctx, params, "Le", Purpose::Illuminant)? else {
        params.bool("absolute", false)?;
        return Ok(None);
    };
    if light.curve.bounds(ctx.range)[1] == 0.0 && lines.is_empty() {
        return Ok(None);
    }
    build(params, light, lines, scale, units).map(Some)
}

fn build(
    params: &ParamSet,
    light: Light,
    lines: Vec<Line>,
    scale: f64,
    units: &mut Units,
) -> Result<Emission, Error> {
    if !(scale >= 0.0 && scale.is_finite()) {
        return Err(refuse(params, "scale", "must be finite and >= 0", scale));
    }
    let emission = Emission::new(light.curve, &lines).map_err(|e| at(params, e))?;
    if params.bool("absolute", false)? {
        units.absolute = true;
        return Ok(emission.scaled(scale as f32));
    }
    units.normalised = true;
    let in_lines: f64 =
        lines.iter().map(|l| f64::from(l.power) * f64::from(cie::y_bar().eval(l.lambda))).sum();
    let photometric = light.photometric + in_lines;
    if photometric <= 0.0 {
        let message = "the spectrum has no visible part, so pbrt's normalisation would divide by zero";
        return Err(params.error(message).hint("\"bool absolute\" true takes the values as they are"));
    }
    Ok(emission.scaled((scale / photometric) as f32))
}

fn lines(params: &ParamSet) -> Result<Vec<Line>, Error> {
    let Some(values) = params.floats("lines")? else { return Ok(Vec::new()) };
    if values.len() % 2 == 1 {
        return Err(refuse(
            params,
            "lines",
            "must be pairs of wavelength and power",
            format!("{} numbers", values.len()),
        ));
    }
    Ok(values.as_chunks::<2>().0.iter().map(|&[lambda, power]| Line { lambda, power }).collect())
}
