//! Triangle meshes.
//!
//! Parametrisation, normals and their orientation are pbrt-v4's: without texture coordinates the corners have
//! (0,0), (1,0), (1,1); with per-vertex normals the geometric normal is turned to the side of the shading normal.

use super::{LocalSurface, NOISE, ShapeGroup, any_tangents, check_coordinates, check_indices, check_length};
use crate::dvec::{DVec3, dvec3};
use crate::{Bounds3, GeometryError};
use tyndall_base::{Vec2, Vec3};

/// Triangles that share vertices; immutable, so what was checked stays true.
#[derive(Clone, Debug)]
pub struct TriangleMesh {
    indices: Vec<[u32; 3]>,
    p: Vec<Vec3>,
    n: Vec<Vec3>,
    s: Vec<Vec3>,
    uv: Vec<Vec2>,
}

impl TriangleMesh {
    /// A mesh from vertex indices and positions.
    ///
    /// # Errors
    /// When a position is not finite or too large, or an index is out of range.
    pub fn new(indices: Vec<[u32; 3]>, p: Vec<Vec3>) -> Result<Self, GeometryError> {
        check_coordinates(&p, "vertex")?;
        check_indices(indices.iter().flatten().copied(), 3, p.len(), "triangle")?;
        Ok(Self { indices, p, n: vec![], s: vec![], uv: vec![] })
    }

    /// With per-vertex shading normals (any length, in the mesh's space, before any reversal); empty for none.
    ///
    /// # Errors
    /// When the length differs from the positions' or a normal is not finite.
    pub fn with_normals(mut self, n: Vec<Vec3>) -> Result<Self, GeometryError> {
        check_length("N", n.len(), self.p.len())?;
        check_coordinates(&n, "normal")?;
        self.n = n;
        Ok(self)
    }

    /// With per-vertex shading tangents; empty for none.
    ///
    /// # Errors
    /// When the length differs from the positions' or a tangent is not finite.
    pub fn with_tangents(mut self, s: Vec<Vec3>) -> Result<Self, GeometryError> {
        check_length("S", s.len(), self.p.len())?;
        check_coordinates(&s, "tangent")?;
        self.s = s;
        Ok(self)
    }

    /// With per-vertex texture coordinates; empty for none.
    ///
    /// # Errors
    /// When the length differs from the positions'.
    pub fn with_uv(mut self, uv: Vec<Vec2>) -> Result<Self, GeometryError> {
        check_length("uv", uv.len(), self.p.len())?;
        self.uv = uv;
        Ok(self)
    }

    /// Vertex indices, three a triangle.
    pub fn indices(&self) -> &[[u32; 3]] {
        &self.indices
    }

    /// Vertex positions \[m\].
    pub fn positions(&self) -> &[Vec3] {
        &self.p
    }

    /// Whether shading normals were given.
    pub fn has_normals(&self) -> bool {
        !self.n.is_empty()
    }

    /// The corners of triangle `prim`.
    #[inline]
    pub fn corners(&self, prim: u32) -> [Vec3; 3] {
        let [a, b, c] = self.indices[prim as usize];
        [self.p[a as usize], self.p[b as usize], self.p[c as usize]]
    }

    /// The given normals at the corners of `prim`; there have to be some.
    pub(crate) fn corner_normals(&self, prim: u32) -> [DVec3; 3] {
        self.indices[prim as usize].map(|i| DVec3::from(self.n[i as usize]))
    }

    /// The component of the normal of triangle `prim` along `d`, times twice the triangle's area.
    #[inline]
    pub(crate) fn normal_along(&self, prim: u32, d: DVec3) -> f64 {
        cross_edges(self.corners(prim)).dot(d)
    }

    /// The box around triangle `prim`.
    pub fn prim_bounds(&self, prim: u32) -> Bounds3 {
        Bounds3::from_points(self.corners(prim))
    }

    /// Texture coordinates at the corners of `prim`.
    fn corner_uv(&self, prim: u32) -> [[f64; 2]; 3] {
        if self.uv.is_empty() {
            return [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]];
        }
        self.indices[prim as usize].map(|i| {
            let uv = self.uv[i as usize];
            [f64::from(uv.x), f64::from(uv.y)]
        })
    }

    /// An interpolated per-vertex vector.
    fn interpolate(&self, values: &[Vec3], prim: u32, b: [f64; 3]) -> DVec3 {
        let [v0, v1, v2] = self.indices[prim as usize].map(|i| DVec3::from(values[i as usize]));
        v0 * b[0] + v1 * b[1] + v2 * b[2]
    }

    /// Interpolated unit shading normal of `prim`, reversed with `reverse`; `None` without normals or where they cancel.
    fn shading_normal(&self, prim: u32, b: [f64; 3], reverse: bool) -> Option<DVec3> {
        if self.n.is_empty() {
            return None;
        }
        let n = self.interpolate(&self.n, prim, b);
        let n = if reverse { -n } else { n };
        (n.length_squared() > 0.0).then(|| n.normalize())
    }

    /// Unit geometric normal of `prim` at barycentric `b`, oriented, and the shading normal.
    fn normals(&self, prim: u32, b: [f64; 3], group: &ShapeGroup) -> (DVec3, DVec3) {
        let n = cross_edges(self.corners(prim)).normalize();
        let n = if group.flips_normal() { -n } else { n };
        match self.shading_normal(prim, b, group.reverse_orientation) {
            Some(ns) if n.dot(ns) < 0.0 => (-n, ns),
            Some(ns) => (n, ns),
            // where the given normals cancel, the geometric one serves for both
            None => (n, n),
        }
    }

    pub(crate) fn local_surface(&self, prim: u32, o: DVec3, d: DVec3, group: &ShapeGroup) -> LocalSurface {
        let b = barycentric(self.corners(prim), o, d);
        self.local_at(prim, b, group)
    }

    /// The surface at barycentric coordinates.
    pub(crate) fn local_at(&self, prim: u32, b: [f64; 3], group: &ShapeGroup) -> LocalSurface {
        let corners = self.corners(prim);
        let (p, noise) = at_barycentric(corners, b);
        let (ng, ns) = self.normals(prim, b, group);
        let uv = self.corner_uv(prim);
        let spanned = if self.uv.is_empty() { Some(plain_tangents(corners)) } else { tangents(corners, uv) };
        let (dpdu, dpdv) = spanned.unwrap_or_else(|| any_tangents(ng));
        let at = |k: usize| b[0] * uv[0][k] + b[1] * uv[1][k] + b[2] * uv[2][k];
        let s = if self.s.is_empty() { DVec3::default() } else { self.interpolate(&self.s, prim, b) };
        let dpdu = if s.length_squared() > 0.0 { s } else { dpdu };
        LocalSurface { p, noise, lift: 0.0, ng, ns, dpdu, dpdv, uv: [at(0), at(1)] }
    }
}

/// Twice the area vector, in the direction that the vertex order gives.
pub(crate) fn cross_edges([a, b, c]: [Vec3; 3]) -> DVec3 {
    let a = DVec3::from(a);
    (DVec3::from(b) - a).cross(DVec3::from(c) - a)
}

/// Barycentric coordinates where the line `o + t d` pierces the plane, clamped to the triangle
/// (Moeller & Trumbore 1997, in `f64`).
pub(crate) fn barycentric([a, b, c]: [Vec3; 3], o: DVec3, d: DVec3) -> [f64; 3] {
    let a = DVec3::from(a);
    let (e1, e2) = (DVec3::from(b) - a, DVec3::from(c) - a);
    let across = d.cross(e2);
    let inv = 1.0 / e1.dot(across);
    let from_a = o - a;
    let b1 = (from_a.dot(across) * inv).clamp(0.0, 1.0);
    let b2 = (d.dot(from_a.cross(e1)) * inv).clamp(0.0, 1.0 - b1);
    [1.0 - b1 - b2, b1, b2]
}

/// The point and a bound on its rounding error; an axis in which the corners agree is exact.
pub(crate) fn at_barycentric([a, b, c]: [Vec3; 3], w: [f64; 3]) -> (DVec3, DVec3) {
    let a = DVec3::from(a);
    let (e1, e2) = ((DVec3::from(b) - a) * w[1], (DVec3::from(c) - a) * w[2]);
    let size = |a: f64, e1: f64, e2: f64| {
        if e1 == 0.0 && e2 == 0.0 { 0.0 } else { NOISE * (a.abs() + e1.abs() + e2.abs()) }
    };
    (a + e1 + e2, dvec3(size(a.x, e1.x, e2.x), size(a.y, e1.y, e2.y), size(a.z, e1.z, e2.z)))
}

/// [`tangents`] of the coordinates (0,0), (1,0), (1,1).
fn plain_tangents([a, b, c]: [Vec3; 3]) -> (DVec3, DVec3) {
    let (a, b, c) = (DVec3::from(a), DVec3::from(b), DVec3::from(c));
    (b - a, c - b)
}

/// Derivatives of position by texture coordinates; `None` where these do not span the triangle.
fn tangents([a, b, c]: [Vec3; 3], uv: [[f64; 2]; 3]) -> Option<(DVec3, DVec3)> {
    let c = DVec3::from(c);
    let (ac, bc) = (DVec3::from(a) - c, DVec3::from(b) - c);
    let (ua, va) = (uv[0][0] - uv[2][0], uv[0][1] - uv[2][1]);
    let (ub, vb) = (uv[1][0] - uv[2][0], uv[1][1] - uv[2][1]);
    let det = ua * vb - va * ub;
    if !(det.abs() > 1e-15 * (ua.abs() + ub.abs()) * (va.abs() + vb.abs())) {
        return None;
    }
    let (dpdu, dpdv) = ((ac * vb - bc * va) * (1.0 / det), (bc * ua - ac * ub) * (1.0 / det));
    (dpdu.cross(dpdv).length_squared() > 0.0).then_some((dpdu, dpdv))
}
