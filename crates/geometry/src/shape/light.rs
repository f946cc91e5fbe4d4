//! Points sampled on shapes as lights, by area and by the solid angle seen from a point.
//!
//! Contract: [`ShapeGroup::sample_area`] returns a density per square metre, [`ShapeGroup::sample_solid_angle`] one
//! per steradian at the reference point, and the `pdf_` twins give the same densities for a point met by a ray. From
//! where a shape is far away, or seen under too small or too large an angle for its solid-angle map, and for shapes that have
//! none, points come from the area and densities are converted by `r^2 / |cos|`.

use super::sphere::{Cone, Sphere};
use super::{LocalSurface, Shape, ShapeGroup, bilinear::Patch, triangle::cross_edges};
use crate::dvec::{DVec3, dvec3};
use crate::surface::{Rounding, ShapeSample};
use crate::{Hit, SurfacePoint};
use tyndall_base::warp::{
    SphericalRectangle, SphericalTriangle, pdf_bilinear, sample_bilinear, sample_uniform_triangle,
};
use tyndall_base::{Vec3, vec::vec2};

impl LocalSurface {
    /// What shapes give that cannot be sampled.
    fn nowhere() -> Self {
        let (zero, up) = (DVec3::default(), dvec3(0.0, 0.0, 1.0));
        let (x, y) = (dvec3(1.0, 0.0, 0.0), dvec3(0.0, 1.0, 0.0));
        Self { p: zero, noise: zero, lift: 0.0, ng: up, ns: up, dpdu: x, dpdv: y, uv: [0.0; 2] }
    }

    /// This world-space point as a sample.
    pub(crate) fn sampled(&self, pdf: f64) -> ShapeSample {
        let (p, rounding) = Rounding::of(self.p, self.noise);
        let uv = vec2(self.uv[0] as f32, self.uv[1] as f32);
        ShapeSample { p, rounding, n: self.ng.round(), uv, pdf: pdf as f32 }
    }
}

impl ShapeGroup {
    /// Area of a primitive in the shape's coordinates \[m^2\].
    pub fn area(&self, prim: u32) -> f32 {
        (match &self.shape {
            Shape::Triangles(m) => 0.5 * cross_edges(m.corners(prim)).length(),
            Shape::Bilinear(m) => m.patch(prim).area(),
            Shape::Sphere(s) => s.area(),
            Shape::Disk(s) => s.area(),
            Shape::Cylinder(s) => s.area(),
            // curves are no lights
            Shape::Curves(_) => 1.0,
        }) as f32
    }

    /// A point of primitive `prim`: uniform on triangles, parallelograms, spheres and disks, nearly so on curved
    /// patches and stretched spheres.
    pub fn sample_area(&self, prim: u32, u: [f32; 2]) -> ShapeSample {
        match &self.shape {
            Shape::Triangles(m) => {
                let [_, b1, b2] = sample_uniform_triangle(u).map(f64::from);
                let area = 0.5 * cross_edges(m.corners(prim)).length();
                m.local_at(prim, [1.0 - b1 - b2, b1, b2], self).sampled(1.0 / area)
            }
            Shape::Bilinear(m) => {
                let patch = m.patch(prim);
                let [x, y] = if patch.is_flat() { u } else { sample_bilinear(u, patch.corner_stretch()) };
                m.local_at(prim, x.into(), y.into(), self).sampled(patch.pdf_area(x, y))
            }
            Shape::Sphere(s) => s.sample_area(u, self),
            Shape::Disk(s) => s.sample_area(u, self),
            Shape::Cylinder(s) => s.sample_area(u, self),
            Shape::Curves(_) => LocalSurface::nowhere().sampled(0.0),
        }
    }

    /// Density per square metre with which [`Self::sample_area`] chooses the point of a sample that
    /// [`Self::sample_solid_angle`] drew from `reference`.
    pub fn pdf_area_of(&self, prim: u32, reference: Vec3, sample: &ShapeSample) -> f32 {
        match &self.shape {
            Shape::Sphere(s) => s.pdf_area(sample.p) as f32,
            Shape::Cylinder(s) => s.pdf_area(sample.p) as f32,
            Shape::Bilinear(m) if !m.patch(prim).is_flat() => {
                // curved patches are sampled by area only
                let v = DVec3::from(sample.p) - DVec3::from(reference);
                let r2 = v.length_squared();
                (f64::from(sample.pdf) * v.dot(sample.n.into()).abs() / (r2 * r2.sqrt())) as f32
            }
            _ => 1.0 / self.area(prim),
        }
    }

    /// Density per square metre with which [`Self::sample_area`] chooses the point of `hit`.
    pub fn pdf_area(&self, hit: &Hit, surface: &SurfacePoint) -> f32 {
        (match &self.shape {
            Shape::Triangles(_) | Shape::Disk(_) => 1.0 / f64::from(self.area(hit.prim)),
            Shape::Bilinear(m) => m.patch(hit.prim).pdf_area(hit.u, hit.v),
            Shape::Sphere(s) => s.pdf_area(surface.p),
            Shape::Cylinder(s) => s.pdf_area(surface.p),
            Shape::Curves(_) => 0.0,
        }) as f32
    }

    /// A point of primitive `prim` for lighting `reference`; `None` where the sample is seen edge-on.
    ///
    /// Uniform in solid angle on triangles (Arvo 1995) and rectangles (Urena et al. 2013) that are near, and on whole
    /// spheres from outside.
    pub fn sample_solid_angle(&self, prim: u32, reference: Vec3, u: [f32; 2]) -> Option<ShapeSample> {
        let along = |w: Vec3, pdf: f32| {
            Some(self.local_surface(prim, reference.into(), w.into(), 0.0).sampled(f64::from(pdf)))
        };
        match self.view(prim, reference) {
            View::Triangle(t) => along(t.sample(u), t.pdf()),
            View::Rectangle(r) => along(r.sample(u), r.pdf()),
            View::Sphere(s, cone) => Some(s.sample_cone(&cone, u, self)),
            View::Area => {
                let sample = self.sample_area(prim, u);
                let pdf = per_solid_angle(sample.pdf, reference, sample.p, sample.n)?;
                Some(ShapeSample { pdf, ..sample })
            }
        }
    }

    /// Density per steradian with which [`Self::sample_solid_angle`] chooses, from `reference`, the point of `hit`.
    pub fn pdf_solid_angle(&self, reference: Vec3, hit: &Hit, surface: &SurfacePoint) -> f32 {
        match self.view(hit.prim, reference) {
            View::Triangle(t) => t.pdf(),
            View::Rectangle(r) => r.pdf(),
            View::Sphere(_, cone) => cone.pdf() as f32,
            View::Area => {
                let pdf = self.pdf_area(hit, surface);
                per_solid_angle(pdf, reference, surface.p, surface.ng).unwrap_or(0.0)
            }
        }
    }

    /// [`Self::pdf_solid_angle`] for a point known by position, normal and the density per area of
    /// [`Self::sample_area`] there.
    pub fn pdf_solid_angle_at(&self, prim: u32, reference: Vec3, p: Vec3, n: Vec3, pdf_area: f32) -> f32 {
        match self.view(prim, reference) {
            View::Triangle(t) => t.pdf(),
            View::Rectangle(r) => r.pdf(),
            View::Sphere(_, cone) => cone.pdf() as f32,
            View::Area => per_solid_angle(pdf_area, reference, p, n).unwrap_or(0.0),
        }
    }

    /// How `prim` is sampled from `reference`.
    fn view(&self, prim: u32, reference: Vec3) -> View<'_> {
        match &self.shape {
            Shape::Triangles(m) => {
                let corners = m.corners(prim);
                let [a, b, c] = corners;
                let side2 =
                    (b - a).length_squared().max((c - a).length_squared()).max((c - b).length_squared());
                if is_far(side2, (a + b + c) * (1.0 / 3.0), reference) {
                    return View::Area;
                }
                SphericalTriangle::new(corners.map(|p| p - reference)).map_or(View::Area, View::Triangle)
            }
            Shape::Bilinear(m) if m.patch(prim).is_rectangle() => {
                let [p00, p10, p01, p11] = m.corners(prim);
                if is_far((p11 - p00).length_squared(), (p00 + p11) * 0.5, reference) {
                    return View::Area;
                }
                let seen = SphericalRectangle::new(p00 - reference, p10 - p00, p01 - p00);
                seen.map_or(View::Area, View::Rectangle)
            }
            Shape::Sphere(s) => {
                s.cone_from(reference.into()).map_or(View::Area, |cone| View::Sphere(s, cone))
            }
            Shape::Bilinear(_) | Shape::Disk(_) | Shape::Cylinder(_) | Shape::Curves(_) => View::Area,
        }
    }
}

/// Flat shapes that are seen from twice their size or farther are sampled by area: what a point sends varies little then,
/// and the map of their solid angle costs more than that variation (measured: 5 % of the time of a picture for 2 % of its
/// variance).
const FAR: f32 = 2.0;

/// Whether `reference` is that far from the middle of a shape whose greatest extent squared is `size2`.
#[inline(always)]
fn is_far(size2: f32, middle: Vec3, reference: Vec3) -> bool {
    size2 * (FAR * FAR) < (middle - reference).length_squared()
}

/// The solid angle in which a primitive is sampled.
enum View<'a> {
    Triangle(SphericalTriangle),
    Rectangle(SphericalRectangle),
    Sphere(&'a Sphere, Cone),
    Area,
}

/// A density per area as one per solid angle; `None` where that is infinite or meaningless.
fn per_solid_angle(pdf: f32, reference: Vec3, p: Vec3, n: Vec3) -> Option<f32> {
    let v = DVec3::from(p) - DVec3::from(reference);
    let r2 = v.length_squared();
    let cosine_r = v.dot(n.into()).abs();
    let pdf = f64::from(pdf) * r2 * r2.sqrt() / cosine_r;
    (cosine_r > 0.0 && pdf.is_finite()).then_some(pdf as f32)
}

impl Patch {
    /// `|dS/du x dS/dv|` at the corners p00, p10, p01, p11.
    fn corner_stretch(&self) -> [f32; 4] {
        [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].map(|(u, v)| self.stretch(u, v) as f32)
    }

    /// Area of the surface per area of the parameters.
    fn stretch(&self, u: f64, v: f64) -> f64 {
        self.dpdu(v).cross(self.dpdv(u)).length()
    }

    fn pdf_area(&self, u: f32, v: f32) -> f64 {
        if self.is_flat() {
            return 1.0 / self.area();
        }
        f64::from(pdf_bilinear([u, v], self.corner_stretch())) / self.stretch(u.into(), v.into())
    }

    /// Area by a product of five-point Gauss-Legendre rules; exact for flat patches.
    pub(super) fn integrated_area(&self) -> f64 {
        if self.is_flat() {
            return self.e.cross(self.f).length();
        }
        gauss(|u| gauss(|v| self.stretch(u, v)))
    }
}

/// The integral of a smooth function over [0, 1] by Gauss and Legendre's five-point rule (Abramowitz & Stegun 25.4.30).
pub(crate) fn gauss(f: impl Fn(f64) -> f64) -> f64 {
    const X: [f64; 3] = [0.0, 0.538_469_310_105_683_1, 0.906_179_845_938_664];
    const W: [f64; 3] = [0.568_888_888_888_888_9, 0.478_628_670_499_366_5, 0.236_926_885_056_189_1];
    let at = |x: f64| f(0.5 + 0.5 * x);
    0.5 * (W[0] * at(X[0]) + W[1] * (at(X[1]) + at(-X[1])) + W[2] * (at(X[2]) + at(-X[2])))
}
