//! `rgbgrid`: pbrt-v4's grid of RGB coefficients.

use super::super::{
    collect::Declared,
    color_space,
    context::{Context, at, refuse},
    emission, phase,
};
use super::grid::{dims, edge};
use tyndall_pbrt::{Error, ParamSet};
use tyndall_spectral::{Emission, SpaceName, colour::ColourSpace};
use tyndall_transport::media::{
    Model,
    model::{Rgb, RgbGrid},
};

/// The model of a directive.
pub fn model(ctx: &Context<'_>, declared: &Declared, units: &mut emission::Units) -> Result<Model, Error> {
    let params = &declared.params;
    let dims = dims(params)?;
    let space = color_space::name(&declared.color_space);
    let scale = super::scale(params)?;
    let sigma_a = list(params, "sigma_a", dims, space, scale)?;
    let sigma_s = list(params, "sigma_s", dims, space, scale)?;
    if sigma_a.is_none() && sigma_s.is_none() {
        return Err(params.error("a medium of class rgbgrid needs \"rgb sigma_a\" or \"rgb sigma_s\""));
    }
    let le_scale = params.float("Lescale", 1.0)?;
    if !(le_scale >= 0.0 && le_scale.is_finite()) {
        return Err(refuse(params, "Lescale", "must be finite and >= 0", le_scale));
    }
    let le = list(params, "Le", dims, space, 1.0)?.filter(|_| le_scale > 0.0);
    if params.contains("Le") && sigma_a.is_none() {
        return Err(params.error("\"Le\" needs \"sigma_a\": a medium emits where it absorbs"));
    }
    let white = le.is_some().then(|| {
        units.normalised = true;
        Emission::from(ColourSpace::get(space).illuminant.scaled(le_scale))
    });
    let (edge, phase) = (edge(params)?, phase::phase(ctx, params)?);
    Ok(Model::Rgb(RgbGrid {
        dims,
        sigma_a,
        sigma_s,
        absent: scale,
        le,
        white,
        edge,
        phase,
        range: ctx.range,
    }))
}

fn list(
    params: &ParamSet,
    name: &str,
    dims: [usize; 3],
    space: SpaceName,
    factor: f32,
) -> Result<Option<Vec<Rgb>>, Error> {
    let Some(values) = params.rgbs(name)? else { return Ok(None) };
    let count = dims.iter().product::<usize>();
    if values.len() != count {
        let expected =
            format!("must be nx ny nz = {} x {} x {} = {count} colours", dims[0], dims[1], dims[2]);
        return Err(refuse(params, name, &expected, format!("{} colours", values.len())));
    }
    values
        .into_iter()
        .map(|rgb| Rgb::new(space, rgb, factor))
        .collect::<Result<_, _>>()
        .map(Some)
        .map_err(|e| at(params, e))
}
