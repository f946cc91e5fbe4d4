//! `plymesh`: a mesh in a file, displaced or not.

use crate::scene::{
    context::{Context, at, refuse},
    texture::Textures,
};
use tyndall_base::Vec3;
use tyndall_files::mesh::{PlyMesh, read_ply};
use tyndall_geometry::{BilinearMesh, Shape, Transform, TriangleMesh, shape::dice::Diceable};
use tyndall_pbrt::{Error, ParamSet};
use tyndall_transport::texture::TextureContext;

pub(super) fn ply(
    ctx: &Context<'_>,
    p: &ParamSet,
    to_world: &Transform,
    textures: &Textures<'_>,
) -> Result<Vec<Shape>, Error> {
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
    if let Some(displaced) = displaced(p, &mesh, to_world, textures)? {
        return Ok(vec![Shape::Triangles(displaced)]);
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

/// Most triangles that dicing may make: more would not fit in most machines' memory.
const MOST_TRIANGLES: usize = 1 << 26;

/// The mesh cut to edges of at most `edgelength` in the scene and moved along its normals by `displacement`.
fn displaced(
    p: &ParamSet,
    mesh: &PlyMesh,
    to_world: &Transform,
    textures: &Textures<'_>,
) -> Result<Option<TriangleMesh>, Error> {
    let Some(height) = textures.float(p, "displacement")? else {
        p.ignore("edgelength", "only displacement has use for it");
        return Ok(None);
    };
    let longest = p.float("edgelength", 1.0)?;
    if !(longest > 0.0 && longest.is_finite()) {
        return Err(refuse(p, "edgelength", "must be > 0", longest));
    }
    let mut dice = diceable(mesh);
    if !dice.dice(longest, MOST_TRIANGLES, |a, b| (to_world.point(a) - to_world.point(b)).length()) {
        let expected = format!("must leave fewer than {MOST_TRIANGLES} triangles");
        return Err(refuse(p, "edgelength", &expected, longest));
    }
    for i in 0..dice.positions.len() {
        let n = dice.normals[i].normalize();
        if n.is_finite() {
            let at = TextureContext { p: to_world.point(dice.positions[i]), n, uv: dice.uv[i] };
            dice.positions[i] += n * height.eval(&at);
        }
    }
    let normals = dice.smooth_normals().iter().map(|n| to_world.normal(*n)).collect();
    let positions = dice.positions.iter().map(|v| to_world.point(*v)).collect();
    let made = TriangleMesh::new(dice.indices, positions).map_err(|e| at(p, e))?;
    let made = made.with_normals(normals).map_err(|e| at(p, e))?;
    made.with_uv(dice.uv).map(Some).map_err(|e| at(p, e))
}

/// All faces as triangles, with normals and texture coordinates.
fn diceable(mesh: &PlyMesh) -> Diceable {
    let halves = |&[a, b, c, d]: &[u32; 4]| [[a, b, d], [a, d, c]];
    let indices: Vec<[u32; 3]> =
        mesh.triangles.iter().copied().chain(mesh.quads.iter().flat_map(halves)).collect();
    let mut dice = Diceable {
        indices,
        positions: mesh.positions.clone(),
        normals: mesh.normals.clone(),
        uv: mesh.uv.clone(),
    };
    if dice.normals.is_empty() {
        dice.normals = dice.smooth_normals();
    }
    dice.uv.resize(dice.positions.len(), tyndall_base::Vec2::default());
    dice
}
