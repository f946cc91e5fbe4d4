//! Where a medium stands: its directive's transformation and its box.

use super::super::{
    collect::Declared,
    context::{Context, at, refuse},
};
use std::sync::Arc;
use tyndall_geometry::Transform;
use tyndall_pbrt::{Error, ParamSet};
use tyndall_transport::media::{Heterogeneous, Medium, Model};

/// The model under the transformation of the directive; `to_medium` leads from its grid to the medium's space.
pub fn place(
    ctx: &Context<'_>,
    declared: &Declared,
    to_medium: Transform,
    model: Model,
) -> Result<Medium, Error> {
    let params = &declared.params;
    if declared.ctm.moves() {
        ctx.warnings.warn(params.place(), "moving media are not supported in this version: the start counts");
    }
    with(ctx, params, declared.ctm.start * to_medium, model)
}

/// The model with its map to the world.
pub fn with(
    ctx: &Context<'_>,
    params: &ParamSet,
    to_world: Transform,
    model: Model,
) -> Result<Medium, Error> {
    let scale = params.float("majorantscale", 1.0)?;
    if !(scale >= 1.0 && scale.is_finite()) {
        return Err(refuse(params, "majorantscale", "must be finite and >= 1", scale));
    }
    let medium = Heterogeneous::new(model, to_world, scale, ctx.range).map_err(|e| at(params, e))?;
    Ok(Medium::Heterogeneous(Arc::new(medium)))
}
