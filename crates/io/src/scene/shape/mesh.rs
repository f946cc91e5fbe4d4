//! `trianglemesh`, `bilinearmesh`, `loopsubdiv`: meshes written in the scene.

use crate::scene::context::{at, refuse};
use tyndall_base::{Vec2, Vec3, vec::vec2};
use tyndall_geometry::{BilinearMesh, Transform, TriangleMesh, shape::loopsubdiv::loop_subdivide};
use tyndall_pbrt::{Error, ParamSet};

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

pub(super) fn triangles(p: &ParamSet, to_world: &Transform) -> Result<TriangleMesh, Error> {
    let positions = positions(p, to_world)?;
    let indices = corner_indices::<3>(p, positions.len())?;
    let normals = points(p.normals("N")?, |n| to_world.normal(n));
    let tangents = points(p.vector3s("S")?, |s| to_world.vector(s));
    let mesh = TriangleMesh::new(indices, positions).map_err(|e| at(p, e))?;
    let mesh = mesh.with_normals(normals).map_err(|e| at(p, e))?;
    let mesh = mesh.with_tangents(tangents).map_err(|e| at(p, e))?;
    mesh.with_uv(uvs(p)?).map_err(|e| at(p, e))
}

pub(super) fn bilinear(p: &ParamSet, to_world: &Transform) -> Result<BilinearMesh, Error> {
    let positions = positions(p, to_world)?;
    let indices = corner_indices::<4>(p, positions.len())?;
    let normals = points(p.normals("N")?, |n| to_world.normal(n));
    let mesh = BilinearMesh::new(indices, positions).map_err(|e| at(p, e))?;
    let mesh = mesh.with_normals(normals).map_err(|e| at(p, e))?;
    mesh.with_uv(uvs(p)?).map_err(|e| at(p, e))
}

/// Most levels of subdivision: each has four times the triangles of the one before.
const MOST_LEVELS: i32 = 10;

pub(super) fn subdivided(p: &ParamSet, to_world: &Transform) -> Result<TriangleMesh, Error> {
    let positions = positions(p, to_world)?;
    let indices = corner_indices::<3>(p, positions.len())?;
    let levels = p.integer("levels", 3)?;
    if !(0..=MOST_LEVELS).contains(&levels) {
        return Err(refuse(p, "levels", "must be between 0 and 10", levels));
    }
    if p.contains("scheme") && p.string("scheme", "loop")? != "loop" {
        return Err(refuse(p, "scheme", "must be loop", p.string("scheme", "")?));
    }
    let limit = loop_subdivide(indices, &positions, levels as u32).map_err(|e| at(p, e))?;
    // the normals come from the mesh as it stands in the scene: a mirror turns its corners' order round
    let turn = if to_world.swaps_handedness() { -1.0 } else { 1.0 };
    let normals = limit.normals.iter().map(|n| *n * turn).collect();
    let mesh = TriangleMesh::new(limit.indices, limit.positions).map_err(|e| at(p, e))?;
    mesh.with_normals(normals).map_err(|e| at(p, e))
}
