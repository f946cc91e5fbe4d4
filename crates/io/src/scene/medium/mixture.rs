//! `mixture`, ours: several media in one, `"string media" ["smoke" "fog"]`, each with its own parameters and place.

use super::super::{
    collect::Declared,
    context::{Context, at, refuse},
};
use super::{Known, place};
use std::sync::Arc;
use tyndall_geometry::Transform;
use tyndall_pbrt::Error;
use tyndall_transport::media::{Heterogeneous, Medium, Model, model::Mixed};

/// The medium of a directive; `known` finds media that were made before.
pub fn medium(ctx: &Context<'_>, declared: &Declared, known: &Known<'_>) -> Result<Medium, Error> {
    let params = &declared.params;
    let Some(names) = params.strings("media")? else { return Err(params.missing("string", "media")) };
    let find = |name: &tyndall_pbrt::Text| -> Result<Arc<Heterogeneous>, Error> {
        match known(name.as_str()) {
            Some(Medium::Heterogeneous(m)) => Ok(m.clone()),
            Some(Medium::Homogeneous(_) | Medium::Painted(_)) => {
                let got = format!("\"{}\", which is homogeneous", name.as_str());
                let hint =
                    "a uniformgrid of one voxel with \"string edge\" \"clamp\" is homogeneous in its box";
                Err(refuse(params, "media", "must be media with bounds", got).hint(hint))
            }
            None => {
                let got = format!("\"{}\"", name.as_str());
                Err(refuse(params, "media", "must be media that were made before", got))
            }
        }
    };
    let species = names.iter().map(find).collect::<Result<Vec<_>, _>>()?;
    let model = Model::Mixed(Mixed::new(species).map_err(|e| at(params, e))?);
    place::with(ctx, params, Transform::IDENTITY, model)
}
