//! `nanovdb`: pbrt-v4's parameters; densities and temperatures from a NanoVDB or OpenVDB file.

use super::super::{
    context::{Context, at, refuse},
    emission, phase,
};
use super::grid::thermal;
use tyndall_files::{
    FileError,
    volume::{Class, Grid, Piece, Volume},
};
use tyndall_geometry::Transform;
use tyndall_pbrt::{Error, ParamSet};
use tyndall_transport::{
    TransportError,
    media::{Bricks, Model, density::Node, model::Separable},
};

/// A grid and the map from its voxels to the medium's space.
struct Loaded {
    bricks: Bricks,
    to_medium: Transform,
}

/// The model of a directive and the map from its voxels to the medium's space.
pub fn model(
    ctx: &Context<'_>,
    params: &ParamSet,
    units: &mut emission::Units,
) -> Result<(Model, Transform), Error> {
    let Some(name) = params.string_opt("filename")? else { return Err(params.missing("string", "filename")) };
    let path = ctx.file(params, "filename", name)?;
    let file = Volume::open(&path).map_err(|e| at(params, e))?;
    let wanted = params.string("gridname", "density")?;
    let Some(density) = load(ctx, params, &file, "gridname", &wanted)? else {
        let hint = format!("the file has {}", file.names().join(", "));
        return Err(
            refuse(params, "gridname", "must be a grid of the file", format!("\"{wanted}\"")).hint(hint)
        );
    };
    let temperature_name = params.string("temperaturename", "temperature")?;
    let temperature = load(ctx, params, &file, "temperaturename", &temperature_name)?;
    let le_scale = params.float("Lescale", 1.0)?;
    let source = match temperature {
        Some(t) => {
            let place = t.to_medium.inverse() * density.to_medium;
            let place = (t.to_medium != density.to_medium).then_some(place);
            thermal(params, t.bricks, place, le_scale, None, units)?
        }
        None => {
            if params.contains("temperaturename") {
                let message =
                    format!("the file has no grid \"{temperature_name}\": the medium does not glow");
                params.warn_at("temperaturename", message, ctx.warnings);
            }
            for name in ["temperatureoffset", "temperaturecutoff", "temperaturescale", "absolute"] {
                params.ignore(name, "the file has no temperatures");
            }
            None
        }
    };
    let [sigma_a, sigma_s] = super::scaled_coefficients(ctx, params)?;
    let phase = phase::phase(ctx, params)?;
    let model = Separable { density: density.bricks, sigma_a, sigma_s, source, phase };
    Ok((Model::Sparse(model), density.to_medium))
}

/// The grid called `name`, if the file has it.
fn load(
    ctx: &Context<'_>,
    params: &ParamSet,
    file: &Volume,
    param: &str,
    name: &str,
) -> Result<Option<Loaded>, Error> {
    let Some(grid) = file.grid(name).map_err(|e| at(params, e))? else { return Ok(None) };
    if !matches!(grid.class(), Class::FogVolume | Class::Unknown) {
        let got = format!("\"{name}\", a grid of class {:?}", grid.class());
        return Err(refuse(params, param, "must be a fog volume", got));
    }
    let (bricks, negative) = fill(&grid).map_err(|e| at(params, e))?;
    if negative > 0 {
        let message = format!("grid \"{name}\": {negative} negative values count as 0");
        params.warn_at(param, message, ctx.warnings);
    }
    let [x, y, z] = grid.to_world();
    let to_medium = Transform::new([x, y, z, [0.0, 0.0, 0.0, 1.0]]).map_err(|e| at(params, e))?;
    Ok(Some(Loaded { bricks, to_medium }))
}

/// What can go wrong on the way from a file to a grid.
#[derive(Debug, thiserror::Error)]
enum FillError {
    #[error(transparent)]
    File(#[from] FileError),
    #[error("{0}")]
    Grid(#[from] TransportError),
    #[error("its tiles overlap")]
    Overlap,
}

/// The voxels of a grid, and how many of them were negative.
fn fill(grid: &Grid<'_>) -> Result<(Bricks, usize), FillError> {
    let mut negative = 0;
    let mut positive = |v: f32| {
        // a NaN stays, to be refused
        if v < 0.0 {
            negative += 1;
            0.0
        } else {
            v
        }
    };
    let [first, last] = grid.index_box();
    let mut bricks = Bricks::new(first, last, positive(grid.background()))?;
    // no more large tiles than the box has room for
    let mut room = (0..3).map(|k| i64::from((last[k] >> 7) - (first[k] >> 7)) + 1).product::<i64>();
    grid.visit::<FillError>(|origin, piece| {
        match piece {
            Piece::Brick(values) => bricks.set(origin, Node::Brick(&values.map(&mut positive)))?,
            Piece::Tile(8, value) => bricks.set(origin, Node::Tile8(positive(value)))?,
            Piece::Tile(128, value) => bricks.set(origin, Node::Tile128(positive(value)))?,
            Piece::Tile(edge, value) => {
                let value = positive(value);
                let axis = |k: usize| {
                    let end = origin[k].saturating_add(edge as i32 - 1).min(last[k]);
                    (origin[k].max(first[k]) >> 7)..=(end >> 7)
                };
                for x in axis(0) {
                    for y in axis(1) {
                        for z in axis(2) {
                            room -= 1;
                            if room < 0 {
                                return Err(FillError::Overlap);
                            }
                            bricks.set([x << 7, y << 7, z << 7], Node::Tile128(value))?;
                        }
                    }
                }
            }
        }
        Ok(())
    })?;
    Ok((bricks, negative))
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_transport::media::density::Density;

    #[test]
    fn bounds_reach_one_voxel_beyond_the_last() {
        let b = Bricks::new([-3, 0, 5], [4, 0, 9], 0.0).unwrap().bounds();
        assert_eq!((b.lo.to_array(), b.hi.to_array()), ([-3.0, 0.0, 5.0], [5.0, 1.0, 10.0]));
    }
}
