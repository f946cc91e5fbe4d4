//! How the shading normal changes along a surface: `dn(w)` for a tangent `w`, from which bumps on curved surfaces are
//! made.
//!
//! Every shading normal here is `n = m / |m|` of some vector `m` that is easily differentiated, so that
//! `dn = (dm - n (n . dm)) / |m|`: of quadrics the point itself under the map's inverse transpose, of meshes what is
//! interpolated between corners, of curved patches `dp/du x dp/dv` (the equations of Weingarten; do Carmo 1976,
//! *Differential Geometry of Curves and Surfaces*, 3-3). Disks are flat, and curves are taken for flat, as in pbrt.

use super::bilinear::{BilinearMesh, Patch};
use super::{LocalSurface, Shape, ShapeGroup, TriangleMesh, lerp};
use crate::Transform;
use crate::dvec::{DVec3, dvec3};

impl ShapeGroup {
    /// Change of the unit shading normal of `s`, the surface where `o + t d` meets `prim` near the parameter `near`, with
    /// its u and v \[1 per unit of u, v\]; zero where the surface has no certain derivative.
    pub(crate) fn normal_change(
        &self,
        prim: u32,
        (o, d): (DVec3, DVec3),
        near: f64,
        s: &LocalSurface,
    ) -> [DVec3; 2] {
        let along = [s.dpdu, s.dpdv];
        let (m, changes) = match &self.shape {
            Shape::Sphere(q) => of_quadric(&q.to_world, dvec3(1.0, 1.0, 1.0), s.p, along),
            Shape::Cylinder(q) => of_quadric(&q.to_world, dvec3(1.0, 1.0, 0.0), s.p, along),
            Shape::Triangles(mesh) if mesh.has_normals() => of_triangle(mesh, prim, s.p, along),
            Shape::Bilinear(mesh) => {
                let patch = mesh.patch(prim);
                of_patch(mesh, prim, patch, patch.parameters(o, d, near), along)
            }
            Shape::Triangles(_) | Shape::Disk(_) | Shape::Curves(_) => return [DVec3::default(); 2],
        };
        // to the side that the surface's normal was turned to
        let side = if m.dot(s.ns) < 0.0 { -1.0 } else { 1.0 };
        changes.map(|dm| unit_change(m, dm) * side)
    }
}

/// Change of `m / |m|` when `m` changes by `dm`; zero where that is not a number.
pub(crate) fn unit_change(m: DVec3, dm: DVec3) -> DVec3 {
    let inv = 1.0 / m.length();
    let n = m * inv;
    let change = (dm - n * n.dot(dm)) * inv;
    if change.length_squared().is_finite() { change } else { DVec3::default() }
}

/// The normal of a sphere, or of a cylinder about the axis that `axes` leaves out, is the point's own direction.
fn of_quadric(to_world: &Transform, axes: DVec3, p: DVec3, along: [DVec3; 2]) -> (DVec3, [DVec3; 2]) {
    let to_object = to_world.inverse();
    let normal = |q: DVec3| to_world.normal64(dvec3(q.x * axes.x, q.y * axes.y, q.z * axes.z));
    (normal(to_object.point64(p)), along.map(|w| normal(to_object.vector64(w))))
}

/// Interpolated between corners.
fn of_triangle(mesh: &TriangleMesh, prim: u32, p: DVec3, along: [DVec3; 2]) -> (DVec3, [DVec3; 2]) {
    let [a, b, c] = mesh.corners(prim).map(DVec3::from);
    let [na, nb, nc] = mesh.corner_normals(prim);
    let (mb, mc) = (nb - na, nc - na);
    let change = |w: DVec3| {
        let [wb, wc] = coordinates(b - a, c - a, w);
        mb * wb + mc * wc
    };
    (na + change(p - a), along.map(change))
}

/// Interpolated between corners, or of the patch itself.
fn of_patch(
    mesh: &BilinearMesh,
    prim: u32,
    patch: &Patch,
    (u, v): (f64, f64),
    along: [DVec3; 2],
) -> (DVec3, [DVec3; 2]) {
    let (pu, pv) = (patch.dpdu(v), patch.dpdv(u));
    let (m, mu, mv) = match mesh.corner_normals(prim) {
        Some([n00, n10, n01, n11]) => (
            lerp(v, lerp(u, n00, n10), lerp(u, n01, n11)),
            lerp(v, n10 - n00, n11 - n01),
            lerp(u, n01 - n00, n11 - n10),
        ),
        None => (pu.cross(pv), pu.cross(patch.g), patch.g.cross(pv)),
    };
    let change = |w: DVec3| {
        let [wu, wv] = coordinates(pu, pv, w);
        mu * wu + mv * wv
    };
    (m, along.map(change))
}

/// `w` in the plane of `e` and `f`, by their lengths.
fn coordinates(e: DVec3, f: DVec3, w: DVec3) -> [f64; 2] {
    let n = e.cross(f);
    let inv = 1.0 / n.length_squared();
    [w.cross(f).dot(n) * inv, e.cross(w).dot(n) * inv]
}
