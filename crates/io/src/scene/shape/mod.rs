//! `Shape`: geometry in the scene's coordinates.

mod curve;
mod mesh;
mod ply;

use super::{
    collect::ShapeRecord,
    context::{Context, at},
    texture::Textures,
};
use tyndall_geometry::{Cylinder, Disk, Shape, Sphere, Transform};
use tyndall_pbrt::Error;

const KNOWN: [&str; 30] = [
    "scheme",
    "basis",
    "degree",
    "type",
    "width",
    "width0",
    "width1",
    "splitdepth",
    "quality",
    "nlevels",
    "P",
    "N",
    "S",
    "uv",
    "indices",
    "faceIndices",
    "filename",
    "radius",
    "zmin",
    "zmax",
    "phimax",
    "height",
    "innerradius",
    "alpha",
    "displacement",
    "edgelength",
    "emissionfilename",
    "extrapolate",
    "interpolation",
    "levels",
];

/// The shapes of a directive: one, or for a PLY file one per kind of face.
pub fn shapes(ctx: &Context<'_>, record: &ShapeRecord, textures: &Textures<'_>) -> Result<Vec<Shape>, Error> {
    let p = &record.declared.params;
    if record.declared.ctm.moves() && !is_carried(record) {
        ctx.warnings.warn(p.place(), UNMOVED);
    }
    let to_world = &placement(record);
    let float = |name: &str, default: f64| p.float64(name, default);
    let made = match record.declared.name.as_str() {
        "trianglemesh" => vec![Shape::Triangles(mesh::triangles(p, to_world)?)],
        "bilinearmesh" => vec![Shape::Bilinear(mesh::bilinear(p, to_world)?)],
        "plymesh" => ply::ply(ctx, p, to_world, textures)?,
        "loopsubdiv" => vec![Shape::Triangles(mesh::subdivided(p, to_world)?)],
        "curve" => vec![Shape::Curves(curve::curves(ctx, p, to_world)?)],
        "sphere" => {
            let radius = float("radius", 1.0)?;
            let (z_min, z_max) = (float("zmin", -radius)?, float("zmax", radius)?);
            let sphere = Sphere::new(*to_world, radius, z_min, z_max, float("phimax", 360.0)?);
            vec![Shape::Sphere(sphere.map_err(|e| at(p, e))?)]
        }
        "disk" => {
            let (height, radius) = (float("height", 0.0)?, float("radius", 1.0)?);
            let disk =
                Disk::new(*to_world, height, radius, float("innerradius", 0.0)?, float("phimax", 360.0)?);
            vec![Shape::Disk(disk.map_err(|e| at(p, e))?)]
        }
        "cylinder" => {
            let (radius, z) = (float("radius", 1.0)?, [float("zmin", -1.0)?, float("zmax", 1.0)?]);
            let cylinder = Cylinder::new(*to_world, radius, z[0], z[1], float("phimax", 360.0)?);
            vec![Shape::Cylinder(cylinder.map_err(|e| at(p, e))?)]
        }
        other => {
            let hint =
                "known are trianglemesh, bilinearmesh, plymesh, loopsubdiv, sphere, disk, cylinder and curve";
            return Err(p.error(format!("shape \"{other}\" is not known")).hint(hint));
        }
    };
    p.ignore("faceIndices", "only per-face textures (Ptex) would need it");
    if p.contains("emissionfilename") {
        p.ignore("emissionfilename", "it only guides how pbrt samples the patch");
        p.warn_at(
            "emissionfilename",
            "emissionfilename: ignored, it only guides how pbrt samples the patch",
            ctx.warnings,
        );
    }
    ctx.finish(p, &KNOWN);
    Ok(made)
}

const UNMOVED: &str = "shapes that emit, and shapes of objects, do not move by themselves: the transformation at the start counts";

/// Whether the shape is made in its own space and carried by an instance that moves.
pub fn is_carried(record: &ShapeRecord) -> bool {
    record.declared.ctm.moves() && record.area_light.is_none() && !record.in_object
}

/// The transformation that the shape's geometry is made with.
pub fn placement(record: &ShapeRecord) -> Transform {
    if is_carried(record) { Transform::IDENTITY } else { record.declared.ctm.start }
}
