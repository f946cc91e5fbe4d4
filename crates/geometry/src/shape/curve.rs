//! Thin curves: cubic Bezier curves with a width that varies linearly along them, as flat bands that always face the
//! ray, as flat bands shaded like cylinders, or as ribbons with a given normal.
//!
//! A ray is met in a frame that looks along it: the curve is halved until its pieces are nearly straight, then the
//! distance from the axis decides (Nakamaru & Ohno 2002, *Ray tracing for curves primitive*, with pbrt's end tests). `u`
//! runs along the curve, `v` across it. A band faces each ray in its own plane, so a ray that leaves starts off it, by the
//! width along the normal.

use super::{LocalSurface, PrimHit, ShapeGroup, any_tangents, check_coordinates, lerp};
use crate::dvec::{DVec3, dvec3};
use crate::error::{GeometryError, Place};
use crate::{Bounds3, Transform};
use tyndall_base::Vec3;
use tyndall_base::math::f64::{acos, sin, sin_cos};

/// How a curve is shaded and how wide it looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurveKind {
    /// A band that faces the ray.
    Flat,
    /// The same with the normals of a cylinder.
    Cylinder,
    /// A band with normals of its own, interpolated between the ends.
    Ribbon,
}

/// One cubic piece.
#[derive(Clone, Copy, Debug)]
pub struct CurveSegment {
    /// Bezier control points in object space.
    pub points: [Vec3; 4],
    /// Width at the start and the end \[m\].
    pub width: [f32; 2],
    /// Normals at the start and the end, used by ribbons.
    pub normals: [Vec3; 2],
}

/// The curves of one `Shape` directive.
#[derive(Clone, Debug)]
pub struct Curves {
    to_world: Transform,
    kind: CurveKind,
    segments: Vec<CurveSegment>,
    /// Each segment is this many primitives, so that boxes are tight.
    split: u32,
}

/// A hit along a curve, before it becomes a surface.
#[derive(Clone, Copy, Debug)]
struct Met {
    t: f64,
    u: f64,
    v: f64,
    width: f64,
}

impl Curves {
    /// `split` parts a segment.
    ///
    /// # Errors
    /// When a coordinate is not finite or too large, or a width is negative.
    pub fn new(
        to_world: Transform,
        kind: CurveKind,
        segments: Vec<CurveSegment>,
        split: u32,
    ) -> Result<Self, GeometryError> {
        for s in &segments {
            check_coordinates(&s.points, "control point")?;
            check_coordinates(&s.normals, "normal")?;
            if let Some(&value) = s.width.iter().find(|w| !(**w >= 0.0 && w.is_finite())) {
                let place = Place { group: None, element: "width", index: 0 };
                return Err(GeometryError::BadCoordinate { place, value });
            }
        }
        Ok(Self { to_world, kind, segments, split: split.max(1) })
    }

    /// Number of primitives.
    pub fn prim_count(&self) -> usize {
        self.segments.len() * self.split as usize
    }

    /// The segment of a primitive and its range of `u`.
    fn part(&self, prim: u32) -> (&CurveSegment, [f64; 2]) {
        let (segment, part) = (prim / self.split, prim % self.split);
        let at = |k: u32| f64::from(k) / f64::from(self.split);
        (&self.segments[segment as usize], [at(part), at(part + 1)])
    }

    /// The box around a primitive: control points of the part and half the width.
    pub fn prim_bounds(&self, prim: u32) -> Bounds3 {
        let (segment, range) = self.part(prim);
        let reach = 0.5 * segment.width[0].max(segment.width[1]);
        let corners = restrict(segment.control(), range).map(DVec3::round);
        let local = Bounds3::from_points(corners).padded(Vec3::splat(reach));
        self.to_world.bounds(local)
    }

    /// The nearest point along `o + t d` (world), `t_min < t <= t_max`.
    pub(crate) fn intersect(&self, prim: u32, o: DVec3, d: DVec3, range: [f64; 2]) -> Option<PrimHit> {
        self.meet(prim, o, d, range).map(|m| PrimHit { t: m.t, u: m.u, v: m.v })
    }

    fn meet(&self, prim: u32, o: DVec3, d: DVec3, range: [f64; 2]) -> Option<Met> {
        let to_object = self.to_world.inverse();
        let (o, d) = (to_object.point64(o), to_object.vector64(d));
        let (segment, u) = self.part(prim);
        let control = restrict(segment.control(), u);
        let view = View::new(o, d, control[3] - control[0]);
        let seen = control.map(|p| view.project(p));
        let mut search = Search {
            segment,
            ribbon: self.kind == CurveKind::Ribbon,
            d: view.z,
            length: view.length,
            range,
            best: None,
        };
        search.pieces(seen, u, depth_for(&seen, segment));
        search.best
    }

    /// The surface that the ray meets near the parameter `near`.
    pub(crate) fn local_surface(
        &self,
        prim: u32,
        o: DVec3,
        d: DVec3,
        near: f64,
        group: &ShapeGroup,
    ) -> LocalSurface {
        let slack = 1e-5 * near.abs();
        let (segment, u) = self.part(prim);
        let met = self.meet(prim, o, d, [near - slack, near + slack]).unwrap_or(Met {
            t: near,
            u: 0.5 * (u[0] + u[1]),
            v: 0.5,
            width: f64::from(segment.width[0]),
        });
        let to_object = self.to_world.inverse();
        let (lo, ld) = (to_object.point64(o), to_object.vector64(d));
        let along = match derivative(segment.control(), met.u) {
            t if t.length_squared() > 0.0 => t,
            _ => any_tangents(ld.normalize()).0,
        };
        let (across, n) = self.across(segment, &met, along, ld);
        let to_world = &self.to_world;
        let lift = to_world.vector64(n * met.width).length();
        let n = to_world.normal64(n).normalize();
        let n = if group.flips_normal() { -n } else { n };
        LocalSurface {
            p: to_world.point64(lo + ld * met.t),
            noise: DVec3::default(),
            lift,
            ng: n,
            ns: n,
            dpdu: to_world.vector64(along),
            dpdv: to_world.vector64(across),
            uv: [met.u, met.v],
        }
    }

    /// The change of position across the band with v, of the length of its width, and the normal, for a ray along `d`.
    fn across(&self, segment: &CurveSegment, met: &Met, along: DVec3, d: DVec3) -> (DVec3, DVec3) {
        let view = if self.kind == CurveKind::Ribbon { segment.normal(met.u) } else { -d };
        let across = view.cross(along);
        let across = if across.length_squared() > 0.0 {
            across.normalize()
        } else {
            any_tangents(along.normalize()).0
        };
        let n = along.cross(across).normalize();
        let n = if n.dot(view) < 0.0 { -n } else { n };
        // the side on which the search finds v > 1/2
        let across = if d.cross(along).dot(across) < 0.0 { -across } else { across };
        if self.kind != CurveKind::Cylinder {
            return (across * met.width, n);
        }
        // v = 0 and 1 are the silhouettes, where the cylinder's normal is across the view
        let (s, c) = sin_cos((met.v - 0.5) * std::f64::consts::PI);
        ((across * c - n * s) * met.width, n * c + across * s)
    }
}

impl CurveSegment {
    fn control(&self) -> [DVec3; 4] {
        self.points.map(DVec3::from)
    }

    fn width_at(&self, u: f64) -> f64 {
        f64::from(self.width[0]) * (1.0 - u) + f64::from(self.width[1]) * u
    }

    /// The ribbon's unit normal, turned evenly from one end to the other.
    fn normal(&self, u: f64) -> DVec3 {
        let [a, b] = self.normals.map(|n| DVec3::from(n).normalize());
        let angle = acos(a.dot(b).clamp(-1.0, 1.0));
        if angle < 1e-6 {
            return a;
        }
        (a * sin((1.0 - u) * angle) + b * sin(u * angle)) * (1.0 / sin(angle))
    }
}

/// A frame that looks along a ray, with y along the curve as far as it can.
struct View {
    o: DVec3,
    x: DVec3,
    y: DVec3,
    z: DVec3,
    length: f64,
}

impl View {
    fn new(o: DVec3, d: DVec3, along: DVec3) -> Self {
        let length = d.length();
        let z = d * (1.0 / length);
        let x = z.cross(along);
        let x = if x.length_squared() > 1e-24 * along.length_squared() {
            x.normalize()
        } else {
            any_tangents(z).0
        };
        Self { o, x, y: z.cross(x), z, length }
    }

    fn turn(&self, v: DVec3) -> DVec3 {
        dvec3(v.dot(self.x), v.dot(self.y), v.dot(self.z))
    }

    fn project(&self, p: DVec3) -> DVec3 {
        self.turn(p - self.o)
    }
}

/// The recursion over halves of a curve in the ray's frame.
struct Search<'a> {
    segment: &'a CurveSegment,
    ribbon: bool,
    /// Unit direction of the ray in object space.
    d: DVec3,
    /// Its length: the frame's z over this is the ray's parameter.
    length: f64,
    range: [f64; 2],
    best: Option<Met>,
}

impl Search<'_> {
    fn pieces(&mut self, c: [DVec3; 4], u: [f64; 2], depth: u32) {
        if !self.may_meet(&c, u) {
            return;
        }
        if depth == 0 {
            return self.piece(&c, u);
        }
        let middle = 0.5 * (u[0] + u[1]);
        let (first, second) = halves(&c);
        self.pieces(first, [u[0], middle], depth - 1);
        self.pieces(second, [middle, u[1]], depth - 1);
    }

    /// Whether the box of the control points, widened, holds part of the ray.
    fn may_meet(&self, c: &[DVec3; 4], u: [f64; 2]) -> bool {
        let reach = 0.5 * self.segment.width_at(u[0]).max(self.segment.width_at(u[1]));
        let low = c[0].min(c[1]).min(c[2]).min(c[3]);
        let high = c[0].max(c[1]).max(c[2]).max(c[3]);
        let end = self.best.map_or(self.range[1], |b| b.t);
        let across = low.x <= reach && high.x >= -reach && low.y <= reach && high.y >= -reach;
        across && low.z - reach <= end * self.length && high.z + reach >= self.range[0] * self.length
    }

    /// A nearly straight piece: the distance of the axis from it.
    fn piece(&mut self, c: &[DVec3; 4], u: [f64; 2]) {
        // the origin must lie between the perpendiculars at both ends, so that neighbours join without gap or overlap
        let before = (c[1].y - c[0].y) * -c[0].y + c[0].x * (c[0].x - c[1].x);
        let after = (c[2].y - c[3].y) * -c[3].y + c[3].x * (c[3].x - c[2].x);
        let (sx, sy) = (c[3].x - c[0].x, c[3].y - c[0].y);
        let length2 = sx * sx + sy * sy;
        if before < 0.0 || after < 0.0 || length2 == 0.0 {
            return;
        }
        let w = (-(c[0].x * sx + c[0].y * sy) / length2).clamp(0.0, 1.0);
        let at = u[0] * (1.0 - w) + u[1] * w;
        let mut width = self.segment.width_at(at);
        if self.ribbon {
            width *= self.segment.normal(at).dot(self.d).abs();
        }
        let p = evaluate(c, w);
        let distance = (p.x * p.x + p.y * p.y).sqrt();
        let t = p.z / self.length;
        let nearer = self.best.is_none_or(|b| t < b.t);
        if distance > 0.5 * width || !(t > self.range[0] && t <= self.range[1] && nearer) {
            return;
        }
        let slope = derivative(*c, w);
        let side = if slope.x * -p.y + p.x * slope.y > 0.0 { 1.0 } else { -1.0 };
        let v = if width > 0.0 { 0.5 + side * distance / width } else { 0.5 };
        self.best = Some(Met { t, u: at, v, width });
    }
}

/// Halvings after which a piece departs from its chord by less than a twentieth of the width (Wang 1984).
fn depth_for(c: &[DVec3; 4], segment: &CurveSegment) -> u32 {
    let bend = |i: usize| {
        let b = (c[i] - c[i + 1] * 2.0 + c[i + 2]).abs();
        b.x.max(b.y).max(b.z)
    };
    let tolerance = 0.05 * f64::from(segment.width[0].max(segment.width[1]));
    let mut ratio = std::f64::consts::SQRT_2 * 6.0 * bend(0).max(bend(1)) / (8.0 * tolerance);
    let mut depth = 0;
    while ratio >= 1.0 && depth < 10 {
        ratio *= 0.25;
        depth += 1;
    }
    depth
}

fn evaluate(c: &[DVec3; 4], u: f64) -> DVec3 {
    let [a, b, d] = [lerp(u, c[0], c[1]), lerp(u, c[1], c[2]), lerp(u, c[2], c[3])];
    lerp(u, lerp(u, a, b), lerp(u, b, d))
}

fn derivative(c: [DVec3; 4], u: f64) -> DVec3 {
    let [a, b, d] = [c[1] - c[0], c[2] - c[1], c[3] - c[2]];
    lerp(u, lerp(u, a, b), lerp(u, b, d)) * 3.0
}

/// De Casteljau at one half.
fn halves(c: &[DVec3; 4]) -> ([DVec3; 4], [DVec3; 4]) {
    let [a, b, d] = [lerp(0.5, c[0], c[1]), lerp(0.5, c[1], c[2]), lerp(0.5, c[2], c[3])];
    let (e, f) = (lerp(0.5, a, b), lerp(0.5, b, d));
    let middle = lerp(0.5, e, f);
    ([c[0], a, e, middle], [middle, f, d, c[3]])
}

/// The control points of a part (blossoms).
fn restrict(c: [DVec3; 4], [u0, u1]: [f64; 2]) -> [DVec3; 4] {
    let blossom = |a: f64, b: f64, e: f64| {
        let first = [lerp(a, c[0], c[1]), lerp(a, c[1], c[2]), lerp(a, c[2], c[3])];
        lerp(e, lerp(b, first[0], first[1]), lerp(b, first[1], first[2]))
    };
    [blossom(u0, u0, u0), blossom(u0, u0, u1), blossom(u0, u1, u1), blossom(u1, u1, u1)]
}
