//! `Shape`: geometry in the scene's coordinates.

use super::{
    collect::ShapeRecord,
    context::{Context, at, refuse},
    state::Moving,
};
use tyndall_base::{Vec2, Vec3, vec::vec2};
use tyndall_files::mesh::read_ply;
use tyndall_geometry::{BilinearMesh, Disk, Shape, Sphere, Transform, TriangleMesh};
use tyndall_pbrt::{Error, ParamSet};

const KNOWN: [&str; 20] = [
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
pub fn shapes(ctx: &Context<'_>, record: &ShapeRecord) -> Result<Vec<Shape>, Error> {
    let p = &record.declared.params;
    let to_world = &placed(ctx, p, &record.declared.ctm);
    let float = |name: &str, default: f64| p.float64(name, default);
    let made = match record.declared.name.as_str() {
        "trianglemesh" => vec![Shape::Triangles(triangles(p, to_world)?)],
        "bilinearmesh" => vec![Shape::Bilinear(bilinear(p, to_world)?)],
        "plymesh" => ply(ctx, p, to_world)?,
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
        other => {
            let hint = "this version has trianglemesh, bilinearmesh, plymesh, sphere and disk";
            return Err(p.error(format!("shape \"{other}\" is not supported")).hint(hint));
        }
    };
    for name in ["displacement", "emissionfilename"] {
        if p.contains(name) {
            p.unsupported(name, "comes in a later version");
            p.warn_at(name, format!("{name}: not supported in this version"), ctx.warnings);
        }
    }
    for name in ["faceIndices", "edgelength"] {
        p.ignore(name, "nothing here needs it");
    }
    ctx.finish(p, &KNOWN);
    Ok(made)
}

fn placed(ctx: &Context<'_>, p: &ParamSet, ctm: &Moving) -> Transform {
    if ctm.moves() {
        let message = "moving shapes are not supported in this version: the transformation at the shutter's start counts";
        ctx.warnings.warn(p.place(), message);
    }
    ctm.start
}

fn points(values: Option<Vec<[f32; 3]>>, map: impl Fn(Vec3) -> Vec3) -> Vec<Vec3> {
    values.unwrap_or_default().into_iter().map(|v| map(v.into())).collect()
}

fn uvs(p: &ParamSet) -> Result<Vec<Vec2>, Error> {
    let uv = match p.type_of("uv") {
        Some(tyndall_pbrt::ParamType::Float) => {
            let flat = p.floats("uv")?.unwrap_or_default();
            flat.as_chunks::<2>().0.to_vec()
        }
        _ => p.point2s("uv")?.unwrap_or_default(),
    };
    Ok(uv.into_iter().map(|[u, v]| vec2(u, v)).collect())
}

fn corner_indices<const K: usize>(p: &ParamSet, vertices: usize) -> Result<Vec<[u32; K]>, Error> {
    let indices: Vec<i32> = match p.integers("indices")? {
        Some(indices) => indices.to_vec(),
        // one face over the first vertices, as pbrt
        None if vertices == K => (0..K as i32).collect(),
        None => return Err(p.missing("integer", "indices")),
    };
    if !indices.len().is_multiple_of(K) {
        return Err(refuse(p, "indices", &format!("must be a multiple of {K} vertices"), indices.len()));
    }
    for (i, index) in indices.iter().enumerate() {
        if *index < 0 || *index as usize >= vertices {
            let expected = format!("must be between 0 and {}, the last vertex of \"P\"", vertices.max(1) - 1);
            return Err(p.error_at_index("indices", i, &expected, &index.to_string()));
        }
    }
    Ok(indices.as_chunks::<K>().0.iter().map(|f| f.map(|i| i as u32)).collect())
}

fn positions(p: &ParamSet, to_world: &Transform) -> Result<Vec<Vec3>, Error> {
    let positions = points(p.point3s("P")?, |v| to_world.point(v));
    if positions.is_empty() { Err(p.missing("point3", "P")) } else { Ok(positions) }
}

fn triangles(p: &ParamSet, to_world: &Transform) -> Result<TriangleMesh, Error> {
    let positions = positions(p, to_world)?;
    let indices = corner_indices::<3>(p, positions.len())?;
    let normals = points(p.normals("N")?, |n| to_world.normal(n));
    let tangents = points(p.vector3s("S")?, |s| to_world.vector(s));
    let mesh = TriangleMesh::new(indices, positions).map_err(|e| at(p, e))?;
    let mesh = mesh.with_normals(normals).map_err(|e| at(p, e))?;
    let mesh = mesh.with_tangents(tangents).map_err(|e| at(p, e))?;
    mesh.with_uv(uvs(p)?).map_err(|e| at(p, e))
}

fn bilinear(p: &ParamSet, to_world: &Transform) -> Result<BilinearMesh, Error> {
    let positions = positions(p, to_world)?;
    let indices = corner_indices::<4>(p, positions.len())?;
    let normals = points(p.normals("N")?, |n| to_world.normal(n));
    let mesh = BilinearMesh::new(indices, positions).map_err(|e| at(p, e))?;
    let mesh = mesh.with_normals(normals).map_err(|e| at(p, e))?;
    mesh.with_uv(uvs(p)?).map_err(|e| at(p, e))
}

fn ply(ctx: &Context<'_>, p: &ParamSet, to_world: &Transform) -> Result<Vec<Shape>, Error> {
    let text = p.string_opt("filename")?.ok_or_else(|| p.missing("string", "filename"))?;
    let path = ctx.file(p, "filename", text)?;
    let mesh = read_ply(&path).map_err(|e| at(p, e))?;
    if mesh.fanned_faces + mesh.skipped_faces > 0 {
        let (fanned, skipped) = (mesh.fanned_faces, mesh.skipped_faces);
        let message = format!(
            "{}: {fanned} faces of more than 4 corners cut into fans, {skipped} of fewer than 3 left out",
            path.display()
        );
        ctx.warnings.warn(p.place(), message);
    }
    let positions: Vec<Vec3> = mesh.positions.iter().map(|v| to_world.point(*v)).collect();
    let normals: Vec<Vec3> = mesh.normals.iter().map(|n| to_world.normal(*n)).collect();
    let mut made = Vec::new();
    if !mesh.triangles.is_empty() {
        let m = TriangleMesh::new(mesh.triangles, positions.clone()).map_err(|e| at(p, e))?;
        let m = m.with_normals(normals.clone()).map_err(|e| at(p, e))?;
        made.push(Shape::Triangles(m.with_uv(mesh.uv.clone()).map_err(|e| at(p, e))?));
    }
    if !mesh.quads.is_empty() {
        let m = BilinearMesh::new(mesh.quads, positions).map_err(|e| at(p, e))?;
        let m = m.with_normals(normals).map_err(|e| at(p, e))?;
        made.push(Shape::Bilinear(m.with_uv(mesh.uv).map_err(|e| at(p, e))?));
    }
    if made.is_empty() {
        return Err(p.error(format!("{}: the mesh has no faces", path.display())));
    }
    Ok(made)
}
