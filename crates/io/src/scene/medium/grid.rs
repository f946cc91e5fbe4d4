//! `uniformgrid`: pbrt-v4's parameters, and `"string edge" "fade"|"clamp"`.

use super::super::{
    context::{Context, at, refuse},
    emission, phase,
};
use tyndall_geometry::Transform;
use tyndall_pbrt::{Error, ParamSet};
use tyndall_spectral::{Curve, Emission};
use tyndall_transport::media::{
    Dense, Edge, Model,
    density::Density,
    emission::{Source, Thermal},
    model::Separable,
};

/// From the voxels of a grid to the box from `p0` to `p1` in the medium's space, the unit cube by default.
pub fn to_medium(params: &ParamSet, model: &Model) -> Result<Transform, Error> {
    let p0 = params.point3_opt("p0")?.unwrap_or([0.0; 3]);
    let p1 = params.point3_opt("p1")?.unwrap_or([1.0; 3]);
    let corner = |f: fn(f64, f64) -> f64| std::array::from_fn(|k| f(p0[k], p1[k]));
    let [lo, hi]: [[f64; 3]; 2] = [corner(f64::min), corner(f64::max)];
    if (0..3).any(|k| hi[k] - lo[k] <= 0.0 || !(hi[k] - lo[k]).is_finite()) {
        let got = format!("{p0:?} to {p1:?}");
        return Err(refuse(params, "p1", "must differ from p0 in every coordinate", got));
    }
    let dims = match model {
        Model::Dense(m) => m.density.dims(),
        Model::Rgb(m) => m.dims,
        Model::Spectral(m) => m.dims(),
        _ => [1; 3],
    };
    let edge = |k: usize| (hi[k] - lo[k]) / dims[k] as f64;
    let scale = Transform::scale(edge(0), edge(1), edge(2)).map_err(|e| at(params, e))?;
    Ok(Transform::translate(lo[0], lo[1], lo[2]) * scale)
}

/// `nx`, `ny`, `nz`.
pub fn dims(params: &ParamSet) -> Result<[usize; 3], Error> {
    let mut dims = [1; 3];
    for (n, name) in dims.iter_mut().zip(["nx", "ny", "nz"]) {
        let given = params.integer(name, 1)?;
        // a grid of more voxels than this could not be written out
        *n = usize::try_from(given)
            .ok()
            .filter(|n| (1..=1 << 20).contains(n))
            .ok_or_else(|| refuse(params, name, "must be between 1 and 1048576", given))?;
    }
    Ok(dims)
}

/// `edge`.
pub fn edge(params: &ParamSet) -> Result<Edge, Error> {
    match params.string("edge", "fade")?.as_str() {
        "fade" => Ok(Edge::Fade),
        "clamp" => Ok(Edge::Clamp),
        other => Err(refuse(params, "edge", "must be \"fade\" or \"clamp\"", format!("\"{other}\""))),
    }
}

/// The model of a directive.
pub fn model(ctx: &Context<'_>, params: &ParamSet, units: &mut emission::Units) -> Result<Model, Error> {
    let (dims, edge) = (dims(params)?, edge(params)?);
    let Some(density) = list(params, "density", dims, edge)? else {
        return Err(params.missing("float", "density"));
    };
    let [sigma_a, sigma_s] = super::scaled_coefficients(ctx, params)?;
    let source = source(ctx, params, dims, edge, units)?;
    let phase = phase::phase(ctx, params)?;
    Ok(Model::Dense(Separable { density, sigma_a, sigma_s, source, phase }))
}

/// A grid of numbers >= 0.
fn list(params: &ParamSet, name: &str, dims: [usize; 3], edge: Edge) -> Result<Option<Dense>, Error> {
    let Some(values) = params.floats(name)? else { return Ok(None) };
    let count = dims.iter().product::<usize>();
    if values.len() != count {
        let expected =
            format!("must be nx ny nz = {} x {} x {} = {count} numbers", dims[0], dims[1], dims[2]);
        return Err(refuse(params, name, &expected, format!("{} numbers", values.len())));
    }
    if let Some(bad) = values.iter().position(|v| !(*v >= 0.0 && v.is_finite())) {
        return Err(params.error_at_index(name, bad, "must be finite and >= 0", &values[bad].to_string()));
    }
    Dense::new(dims, &values, edge).map(Some).map_err(|e| at(params, e))
}

/// Emission: a spectrum times a grid, or a black body of a grid of temperatures.
fn source(
    ctx: &Context<'_>,
    params: &ParamSet,
    dims: [usize; 3],
    edge: Edge,
    units: &mut emission::Units,
) -> Result<Option<Source<Dense>>, Error> {
    // one number is a factor, more are a grid
    let single = params.floats("Lescale")?.filter(|v| v.len() == 1 && dims != [1; 3]).map(|v| v[0]);
    let grid = if single.is_none() { list(params, "Lescale", dims, edge)? } else { None };
    let factor = single.unwrap_or(1.0);
    let Some(temperature) = list(params, "temperature", dims, edge)? else {
        let le = emission::of_medium_scaled(ctx, params, f64::from(factor), units)?;
        return Ok(le.map(|le| Source::Spectrum { le, scale: grid }));
    };
    if params.contains("Le") {
        let hint = "a medium glows by a spectrum or by its temperature";
        return Err(params.error("both \"Le\" and \"temperature\" are given").hint(hint));
    }
    thermal(params, temperature, None, factor, grid, units)
}

/// A black body; `None` where nothing is hot.
pub fn thermal<D: Density>(
    params: &ParamSet,
    temperature: D,
    place: Option<Transform>,
    le_scale: f32,
    le_grid: Option<D>,
    units: &mut emission::Units,
) -> Result<Option<Source<D>>, Error> {
    let cutoff = params.float("temperaturecutoff", 0.0)?;
    let offset = params.float("temperatureoffset", cutoff)?;
    let scale = params.float("temperaturescale", 1.0)?;
    for (name, value) in [("temperatureoffset", offset), ("temperaturescale", scale), ("Lescale", le_scale)] {
        if !value.is_finite() || (name == "Lescale" && value < 0.0) {
            return Err(refuse(params, name, "must be finite", value));
        }
    }
    let absolute = params.bool("absolute", false)?;
    let e = temperature.extrema(temperature.bounds());
    let hottest = ((e.max - offset) * scale).max((e.min - offset) * scale);
    if hottest.is_nan() || hottest <= 100.0 || le_scale == 0.0 {
        return Ok(None);
    }
    let curve = if absolute { Curve::blackbody_absolute(hottest) } else { Curve::blackbody(hottest) };
    let curve = curve.map_err(|e| at(params, e))?;
    let hottest = Emission::from(curve.scaled(le_scale));
    *if absolute { &mut units.absolute } else { &mut units.normalised } = true;
    Ok(Some(Source::Thermal(Box::new(Thermal {
        temperature,
        place,
        offset,
        scale,
        le_scale,
        le_grid,
        absolute,
        hottest,
    }))))
}
