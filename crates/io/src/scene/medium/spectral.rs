//! `spectralgrid`: K bands per voxel, ours.
//!
//! `"float bands" [e0 ... eK]` \[nm\], `"float sigma_a"` and `"float sigma_s"`: K numbers for each voxel, x fastest.

use super::super::{
    context::{Context, at, refuse},
    phase,
};
use super::grid::{dims, edge};
use tyndall_pbrt::{Error, ParamSet};
use tyndall_transport::media::{Model, model::SpectralGrid};

/// The model of a directive.
pub fn model(ctx: &Context<'_>, params: &ParamSet) -> Result<Model, Error> {
    let dims = dims(params)?;
    let Some(bands) = params.floats("bands")? else { return Err(params.missing("float", "bands")) };
    let [Some(first), Some(last)] = [bands.first(), bands.last()].map(Option::<&f32>::copied) else {
        return Err(refuse(params, "bands", "must be two limits of bands or more", "none"));
    };
    if first > ctx.range.min || last < ctx.range.max {
        let expected = format!("must cover {} to {} nm", ctx.range.min, ctx.range.max);
        return Err(refuse(params, "bands", &expected, format!("{first} to {last} nm")));
    }
    let lists = [params.floats("sigma_a")?, params.floats("sigma_s")?];
    let longest = lists.iter().flatten().map(|l| l.len()).max().unwrap_or(0);
    if longest == 0 {
        return Err(
            params.error("a medium of class spectralgrid needs \"float sigma_a\" or \"float sigma_s\"")
        );
    }
    // an absent coefficient is zero
    let [sigma_a, sigma_s] = lists.map(|l| l.map_or_else(|| vec![0.0; longest], |l| l.into_owned()));
    let (scale, edge, phase) = (super::scale(params)?, edge(params)?, phase::phase(ctx, params)?);
    let grid = SpectralGrid::new(dims, bands.into_owned(), [&sigma_a, &sigma_s], edge, scale, phase);
    grid.map(Model::Spectral).map_err(|e| at(params, e))
}
