//! Bilinear patch meshes: `S(u,v) = (1-u)(1-v) p00 + u (1-v) p10 + (1-u) v p01 + u v p11`.
//!
//! Corners come in pbrt's order p00, p10, p01, p11. A patch that is a parallelogram (to the precision of its
//! corners) is traversed as flat; one that is a rectangle is also sampled as one. Other patches are met by solving
//! for the ruled line that the ray crosses (Reshetov 2019, "Cool Patches"), in `f64`.

use super::{LocalSurface, NOISE, PrimHit, ShapeGroup, any_tangents, check_coordinates, check_indices};
use super::{check_length, lerp, quadratic_half};
use crate::dvec::{DVec3, dvec3};
use crate::{Bounds3, GeometryError};
use tyndall_base::{Vec2, Vec3};

/// Bilinear patches that share vertices; immutable, so what was checked stays true.
#[derive(Clone, Debug)]
pub struct BilinearMesh {
    indices: Vec<[u32; 4]>,
    p: Vec<Vec3>,
    n: Vec<Vec3>,
    uv: Vec<Vec2>,
    /// Each patch as rays and lights need it, worked out once.
    patches: Vec<Patch>,
}

/// What a patch is to the precision of its corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Form {
    /// A ruled surface.
    Curved,
    /// A parallelogram.
    Flat,
    /// A parallelogram with right angles.
    Rectangle,
}

impl BilinearMesh {
    /// A mesh from vertex indices (p00, p10, p01, p11 a patch) and positions.
    ///
    /// # Errors
    /// When a position is not finite or too large, or an index is out of range.
    pub fn new(indices: Vec<[u32; 4]>, p: Vec<Vec3>) -> Result<Self, GeometryError> {
        check_coordinates(&p, "vertex")?;
        check_indices(indices.iter().flatten().copied(), 4, p.len(), "patch")?;
        let patches = indices.iter().map(|i| Patch::new(i.map(|i| p[i as usize]))).collect();
        Ok(Self { indices, p, n: vec![], uv: vec![], patches })
    }

    /// With per-vertex shading normals (before any reversal); empty for none.
    ///
    /// # Errors
    /// When the length differs from the positions' or a normal is not finite.
    pub fn with_normals(mut self, n: Vec<Vec3>) -> Result<Self, GeometryError> {
        check_length("N", n.len(), self.p.len())?;
        check_coordinates(&n, "normal")?;
        self.n = n;
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

    /// Vertex indices, four a patch.
    pub fn indices(&self) -> &[[u32; 4]] {
        &self.indices
    }

    /// Vertex positions \[m\].
    pub fn positions(&self) -> &[Vec3] {
        &self.p
    }

    /// The corners p00, p10, p01, p11 of patch `prim`.
    #[inline]
    pub fn corners(&self, prim: u32) -> [Vec3; 4] {
        let [a, b, c, d] = self.indices[prim as usize];
        [self.p[a as usize], self.p[b as usize], self.p[c as usize], self.p[d as usize]]
    }

    #[inline]
    pub(crate) fn patch(&self, prim: u32) -> &Patch {
        &self.patches[prim as usize]
    }

    /// Whether patch `prim` is a parallelogram.
    pub fn is_flat(&self, prim: u32) -> bool {
        self.patch(prim).is_flat()
    }

    /// The box around patch `prim`.
    pub fn prim_bounds(&self, prim: u32) -> Bounds3 {
        Bounds3::from_points(self.corners(prim))
    }

    pub(crate) fn local_surface(
        &self,
        prim: u32,
        o: DVec3,
        d: DVec3,
        near: f64,
        group: &ShapeGroup,
    ) -> LocalSurface {
        let (u, v) = self.patch(prim).parameters(o, d, near);
        self.local_at(prim, u, v, group)
    }

    /// The surface at patch coordinates (u, v).
    pub(crate) fn local_at(&self, prim: u32, u: f64, v: f64, group: &ShapeGroup) -> LocalSurface {
        let patch = self.patch(prim);
        let (p, noise) = patch.at(u, v);
        let (mut dpdu, mut dpdv) = (patch.dpdu(v), patch.dpdv(u));
        let n = patch.normal(dpdu, dpdv);
        let mut ng = if group.flips_normal() { -n } else { n };
        let ns = self.shading_normal(prim, u, v, group.reverse_orientation).unwrap_or(ng);
        if ng.dot(ns) < 0.0 {
            ng = -ng;
        }
        if !patch.is_flat() && !(dpdu.cross(dpdv).length_squared() > 0.0) {
            (dpdu, dpdv) = any_tangents(ng);
        }
        let mut uv = [u, v];
        if !self.uv.is_empty() {
            ([dpdu, dpdv], uv) = self.textured(prim, u, v, [dpdu, dpdv]);
        }
        LocalSurface { p, noise, lift: 0.0, ng, ns, dpdu, dpdv, uv }
    }

    /// The given normals at the corners of `prim`, if there are any.
    pub(crate) fn corner_normals(&self, prim: u32) -> Option<[DVec3; 4]> {
        let at = |i: u32| DVec3::from(self.n[i as usize]);
        (!self.n.is_empty()).then(|| self.indices[prim as usize].map(at))
    }

    fn shading_normal(&self, prim: u32, u: f64, v: f64, reverse: bool) -> Option<DVec3> {
        let [n00, n10, n01, n11] = self.corner_normals(prim)?;
        let n = lerp(v, lerp(u, n00, n10), lerp(u, n01, n11));
        let n = if reverse { -n } else { n };
        (n.length_squared() > 0.0).then(|| n.normalize())
    }

    /// Tangents and coordinates by the mesh's texture coordinates (s, t) instead of (u, v).
    fn textured(&self, prim: u32, u: f64, v: f64, [dpdu, dpdv]: [DVec3; 2]) -> ([DVec3; 2], [f64; 2]) {
        let c = self.indices[prim as usize].map(|i| self.uv[i as usize]);
        let axis = |f: fn(Vec2) -> f64| {
            let [a, b, c, d] = c.map(f);
            let value = (a * (1.0 - u) + b * u) * (1.0 - v) + (c * (1.0 - u) + d * u) * v;
            (value, (b - a) * (1.0 - v) + (d - c) * v, (c - a) * (1.0 - u) + (d - b) * u)
        };
        let (s, dsdu, dsdv) = axis(|c| f64::from(c.x));
        let (t, dtdu, dtdv) = axis(|c| f64::from(c.y));
        // the chain rule backwards: d(u,v)/d(s,t) is the inverse of d(s,t)/d(u,v)
        let det = dsdu * dtdv - dsdv * dtdu;
        let inv = if det == 0.0 { 0.0 } else { 1.0 / det };
        let dpds = (dpdu * dtdv - dpdv * dtdu) * inv;
        let dpdt = (dpdv * dsdu - dpdu * dsdv) * inv;
        let cross = dpds.cross(dpdt);
        if !(cross.length_squared() > 0.0) {
            return ([dpdu, dpdv], [s, t]);
        }
        // texture coordinates that mirror must not turn the surface over
        let dpdt = if cross.dot(dpdu.cross(dpdv)) < 0.0 { -dpdt } else { dpdt };
        ([dpds, dpdt], [s, t])
    }
}

/// One patch in `f64`: `p00 + u e + v f + u v g`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Patch {
    pub p00: DVec3,
    pub e: DVec3,
    pub f: DVec3,
    pub g: DVec3,
    form: Form,
    /// Unit normal of a flat patch.
    flat_normal: DVec3,
    /// Area \[m^2\].
    area: f64,
}

impl Patch {
    fn new([p00, p10, p01, p11]: [Vec3; 4]) -> Self {
        let (p00, p10): (DVec3, DVec3) = (p00.into(), p10.into());
        let (p01, p11): (DVec3, DVec3) = (p01.into(), p11.into());
        let (e, f, g) = (p10 - p00, p01 - p00, (p11 - p10) - (p01 - p00));
        let mut patch = Self { p00, e, f, g, form: Form::Curved, flat_normal: DVec3::default(), area: 0.0 };
        patch.form = patch.judge();
        if patch.is_flat() {
            patch.flat_normal = e.cross(f).normalize();
        }
        patch.area = patch.integrated_area();
        patch
    }

    /// Unit normal where the derivatives are these.
    #[inline]
    fn normal(&self, dpdu: DVec3, dpdv: DVec3) -> DVec3 {
        if self.is_flat() {
            return self.flat_normal;
        }
        let cross = dpdu.cross(dpdv);
        if cross.length_squared() > 0.0 { cross.normalize() } else { self.mean_normal() }
    }

    /// Area \[m^2\].
    #[inline]
    pub fn area(&self) -> f64 {
        self.area
    }

    /// Greatest magnitude of a coordinate, for judging what is rounding.
    fn coordinate_size(&self) -> f64 {
        let a = self.p00.abs() + self.e.abs() + self.f.abs();
        a.x.max(a.y).max(a.z)
    }

    /// A parallelogram as far as `f32` corners can tell, and a rectangle to the precision that sampling it needs.
    fn judge(&self) -> Form {
        let g = self.g.abs();
        let rounding = self.coordinate_size() * (4.0 * f64::from(f32::EPSILON));
        let size = self.e.length().min(self.f.length());
        let twist = g.x.max(g.y).max(g.z);
        let flat = twist <= rounding.min(1e-3 * size) && self.e.cross(self.f).length_squared() > 0.0;
        if !flat {
            return Form::Curved;
        }
        let right = self.e.dot(self.f).abs() <= 1e-5 * self.e.length() * self.f.length();
        if right { Form::Rectangle } else { Form::Flat }
    }

    /// A parallelogram.
    #[inline(always)]
    pub fn is_flat(&self) -> bool {
        self.form != Form::Curved
    }

    /// A rectangle.
    #[inline(always)]
    pub fn is_rectangle(&self) -> bool {
        self.form == Form::Rectangle
    }

    pub fn dpdu(&self, v: f64) -> DVec3 {
        self.e + self.g * v
    }

    pub fn dpdv(&self, u: f64) -> DVec3 {
        self.f + self.g * u
    }

    /// Direction of the normal where the parametrisation is degenerate (a corner where two vertices coincide).
    fn mean_normal(&self) -> DVec3 {
        self.dpdu(0.5).cross(self.dpdv(0.5)).normalize()
    }

    /// The point and a bound on its error.
    pub fn at(&self, u: f64, v: f64) -> (DVec3, DVec3) {
        let (e, f, g) = (self.e * u, self.f * v, self.g * (u * v));
        // flat: what the traversal's two triangles leave out; curved: what solving for u and v loses
        let extra = if self.is_flat() {
            self.g.abs()
        } else {
            let lost = 16.0 * NOISE * self.coordinate_size();
            dvec3(lost, lost, lost)
        };
        let size = |p: f64, e: f64, f: f64, g: f64| {
            if e == 0.0 && f == 0.0 && g == 0.0 {
                0.0
            } else {
                NOISE * (p.abs() + e.abs() + f.abs() + g.abs())
            }
        };
        let noise = dvec3(
            size(self.p00.x, e.x, f.x, g.x),
            size(self.p00.y, e.y, f.y, g.y),
            size(self.p00.z, e.z, f.z, g.z),
        );
        (self.p00 + e + f + g, noise + extra)
    }

    /// (u, v) where the line meets the patch, clamped to it.
    pub fn parameters(&self, o: DVec3, d: DVec3, near: f64) -> (f64, f64) {
        if !self.is_flat() {
            // the traversal found a hit; the first solution from there on is that one
            let range = [near - 1e-5 * near.abs(), f64::INFINITY];
            return self.intersect(o, d, range).map_or((0.5, 0.5), |h| (h.u, h.v));
        }
        let across = d.cross(self.f);
        let inv = 1.0 / self.e.dot(across);
        let from = o - self.p00;
        let u = (from.dot(across) * inv).clamp(0.0, 1.0);
        let v = (d.dot(from.cross(self.e)) * inv).clamp(0.0, 1.0);
        (u, v)
    }

    /// The nearest point of a curved patch along `o + t d`, `t_min < t <= t_max`.
    pub fn intersect(&self, o: DVec3, d: DVec3, range: [f64; 2]) -> Option<PrimHit> {
        let a = self.p00 - o;
        // the ray crosses the ruled line from a + u e along f + u g: (a + u e) . (d x (f + u g)) = 0
        let (df, dg) = (d.cross(self.f), d.cross(self.g));
        let (c0, c1, c2) = (a.dot(df), a.dot(dg) + self.e.dot(df), self.e.dot(dg));
        let scale = c0.abs() + c1.abs() + c2.abs();
        let roots = if c2.abs() <= 1e-14 * scale {
            let u = -c0 / c1;
            [u, u]
        } else {
            quadratic_half(c2, 0.5 * c1, 0.25 * c1 * c1 - c2 * c0, c0)?
        };
        let first = self.on_ruling(roots[0], a, d, range);
        let second = self.on_ruling(roots[1], a, d, range);
        match (first, second) {
            (Some(h0), Some(h1)) => Some(if h1.t < h0.t { h1 } else { h0 }),
            (h0, h1) => h0.or(h1),
        }
    }

    /// Where the ray crosses the ruled line at `u`.
    fn on_ruling(&self, u: f64, a: DVec3, d: DVec3, [t_min, t_max]: [f64; 2]) -> Option<PrimHit> {
        let (start, along) = (a + self.e * u, self.f + self.g * u);
        let perpendicular = d.cross(along);
        let inv = 1.0 / perpendicular.length_squared();
        let t = start.cross(along).dot(perpendicular) * inv;
        let v = start.cross(d).dot(perpendicular) * inv;
        // neighbours overlap by what the f32 edge tests of triangles leave open, so that no crack remains
        let size = self.e.abs() + self.f.abs();
        let reach = d.length() * t / (size.x.max(size.y).max(size.z));
        let slack = 0.5 * f64::from(f32::EPSILON) * (1.0 + reach.abs().min(1e4));
        let inside = |x: f64| x >= -slack && x <= 1.0 + slack;
        (t > t_min && t <= t_max && inside(u) && inside(v)).then(|| PrimHit {
            t,
            u: u.clamp(0.0, 1.0),
            v: v.clamp(0.0, 1.0),
        })
    }
}
