//! `cloud`: pbrt-v4's procedural cloud.

use super::super::{
    context::{Context, at, refuse},
    phase,
};
use tyndall_base::vec::vec3;
use tyndall_geometry::Bounds3;
use tyndall_pbrt::{Error, ParamSet};
use tyndall_transport::media::{Cloud, Model, model::Separable};

/// The model of a directive.
pub fn model(ctx: &Context<'_>, params: &ParamSet) -> Result<Model, Error> {
    let p0 = params.point3_opt("p0")?.unwrap_or([0.0; 3]).map(|v| v as f32);
    let p1 = params.point3_opt("p1")?.unwrap_or([1.0; 3]).map(|v| v as f32);
    let bounds = Bounds3::new(vec3(p0[0], p0[1], p0[2]), vec3(p1[0], p1[1], p1[2]));
    let e = bounds.extent();
    if !(e.x > 0.0 && e.y > 0.0 && e.z > 0.0 && e.is_finite()) {
        return Err(refuse(
            params,
            "p1",
            "must differ from p0 in every coordinate",
            format!("{p0:?} to {p1:?}"),
        ));
    }
    let number = |name, default| params.float(name, default);
    let (density, wispiness, frequency) =
        (number("density", 1.0)?, number("wispiness", 1.0)?, number("frequency", 5.0)?);
    let density = Cloud::new(bounds, density, wispiness, frequency).map_err(|e| at(params, e))?;
    let [sigma_a, sigma_s] = super::scaled_coefficients(ctx, params)?;
    let phase = phase::phase(ctx, params)?;
    Ok(Model::Cloud(Separable { density, sigma_a, sigma_s, source: None, phase }))
}
