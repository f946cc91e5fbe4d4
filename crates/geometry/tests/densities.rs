//! Points on shapes against their densities, per area and per solid angle: chi-square over the surface parameters.
//!
//! The formula of each surface stands here once more, so that parameters, positions and densities that the samplers report
//! are all held to it.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod common;

use common::build;
use tyndall_base::Vec3;
use tyndall_base::vec::vec3;
use tyndall_geometry::dvec::DVec3;
use tyndall_geometry::{
    Accel, BilinearMesh, Cylinder, Disk, Hit, Ray, Shape, ShapeGroup, ShapeSample, Sphere, SurfacePoint,
    Transform, TriangleMesh,
};
use tyndall_testkit::{Rng, chi2_2d};

const DRAWS: usize = 200_000;

/// Parameters in the unit square to a point.
type Surface = Box<dyn Fn([f64; 2]) -> DVec3>;

struct Case {
    name: &'static str,
    shape: Shape,
    point: Surface,
    /// Surface parameters of a sample to the unit square.
    square: fn([f64; 2]) -> [f64; 2],
}

fn case(name: &'static str, shape: Shape, point: impl Fn([f64; 2]) -> DVec3 + 'static) -> Case {
    Case { name, shape, point: Box::new(point), square: |uv| uv }
}

fn d3(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3 { x, y, z }
}

fn turned() -> Transform {
    Transform::translate(0.2, -0.1, 0.4) * Transform::rotate(35.0, [1.0, 2.0, 0.5]).unwrap()
}

fn squeezed() -> Transform {
    turned() * Transform::scale(1.0, 0.4, 0.7).unwrap()
}

fn sphere(name: &'static str, t: Transform, [low, high]: [f64; 2], degrees: f64) -> Case {
    let r = 0.6;
    let shape = Shape::Sphere(Sphere::new(t, r, low, high, degrees).unwrap());
    let (from, to) = ((low / r).acos(), (high / r).acos());
    case(name, shape, move |[u, v]| {
        let (phi, theta) = (u * degrees.to_radians(), from + v * (to - from));
        t.point64(d3(r * theta.sin() * phi.cos(), r * theta.sin() * phi.sin(), r * theta.cos()))
    })
}

fn cylinder(name: &'static str, t: Transform, degrees: f64) -> Case {
    let (r, low, high) = (0.4, -0.3, 0.5);
    let shape = Shape::Cylinder(Cylinder::new(t, r, low, high, degrees).unwrap());
    case(name, shape, move |[u, v]| {
        let phi = u * degrees.to_radians();
        t.point64(d3(r * phi.cos(), r * phi.sin(), low + v * (high - low)))
    })
}

fn disk(name: &'static str, t: Transform, inner: f64, degrees: f64) -> Case {
    let (height, outer) = (0.1, 0.7);
    let shape = Shape::Disk(Disk::new(t, height, outer, inner, degrees).unwrap());
    case(name, shape, move |[u, v]| {
        let (phi, r) = (u * degrees.to_radians(), outer - v * (outer - inner));
        t.point64(d3(r * phi.cos(), r * phi.sin(), height))
    })
}

fn patch(name: &'static str, p: [[f32; 3]; 4]) -> Case {
    let shape = Shape::Bilinear(BilinearMesh::new(vec![[0, 1, 2, 3]], p.map(Vec3::from).to_vec()).unwrap());
    let p = p.map(|p| DVec3::from(Vec3::from(p)));
    case(name, shape, move |[u, v]| {
        p[0] * ((1.0 - u) * (1.0 - v)) + p[1] * (u * (1.0 - v)) + p[2] * ((1.0 - u) * v) + p[3] * (u * v)
    })
}

/// Corners have the parameters (0, 0), (1, 0) and (1, 1): v / u runs along the far edge.
fn triangle() -> Case {
    let p = [vec3(-0.5, -0.3, 0.1), vec3(0.8, 0.0, -0.2), vec3(0.1, 0.9, 0.3)];
    let shape = Shape::Triangles(TriangleMesh::new(vec![[0, 1, 2]], p.to_vec()).unwrap());
    let [a, b, c] = p.map(DVec3::from);
    let point = move |[x, y]: [f64; 2]| a * (1.0 - x) + b * (x - x * y) + c * (x * y);
    Case { square: |[u, v]| [u, if u > 0.0 { v / u } else { 0.5 }], ..case("triangle", shape, point) }
}

fn cases() -> Vec<Case> {
    vec![
        triangle(),
        patch("rectangle", [[-0.5, -0.3, 0.2], [0.7, -0.3, 0.2], [-0.5, 0.4, 0.2], [0.7, 0.4, 0.2]]),
        patch("parallelogram", [[0.0, 0.0, 0.0], [0.8, 0.0, 0.1], [0.3, 0.5, 0.0], [1.1, 0.5, 0.1]]),
        patch("curved patch", [[0.0, 0.0, 0.0], [0.9, 0.0, 0.3], [0.0, 0.8, 0.3], [0.7, 1.0, -0.2]]),
        patch("trapezium", [[0.0, 0.0, 0.0], [0.9, 0.0, 0.0], [0.3, 0.8, 0.0], [0.5, 0.8, 0.0]]),
        sphere("sphere", turned(), [-0.6, 0.6], 360.0),
        sphere("part of a sphere", turned(), [-0.2, 0.5], 200.0),
        sphere("ellipsoid", squeezed(), [-0.6, 0.6], 360.0),
        disk("disk", turned(), 0.0, 360.0),
        disk("elliptic sector", squeezed(), 0.3, 250.0),
        cylinder("cylinder", turned(), 360.0),
        cylinder("part of a squeezed cylinder", squeezed(), 200.0),
    ]
}

/// The vector whose length is the area per unit of both parameters.
fn normal(case: &Case, [u, v]: [f64; 2]) -> DVec3 {
    const H: f64 = 1e-5;
    let along_u = (case.point)([u + H, v]) - (case.point)([u - H, v]);
    let along_v = (case.point)([u, v + H]) - (case.point)([u, v - H]);
    along_u.cross(along_v) * (1.0 / (4.0 * H * H))
}

/// The hit of the surface at these parameters, by a short ray across it.
fn met(case: &Case, accel: &Accel, uv: [f64; 2]) -> Option<(Hit, SurfacePoint)> {
    let (p, n) = ((case.point)(uv), normal(case, uv).normalize());
    let ray = Ray::new((p + n * 0.02).round(), (-n).round());
    let hit = accel.intersect(&ray)?;
    let surface = accel.surface(&ray, &hit);
    assert!((DVec3::from(surface.p) - p).length() < 1e-5, "{}: {surface:?} at {uv:?}", case.name);
    Some((hit, surface))
}

/// A sample's parameters, which have to lead to its position.
fn parameters(case: &Case, s: &ShapeSample) -> [f64; 2] {
    let uv = (case.square)([f64::from(s.uv.x), f64::from(s.uv.y)]).map(|x| x.clamp(0.0, 1.0));
    let off = ((case.point)(uv) - DVec3::from(s.p)).length();
    assert!(off < 2e-5, "{}: {s:?} is {off} from its parameters", case.name);
    uv
}

#[test]
fn points_follow_their_density_per_area() {
    let cases = cases();
    for case in &cases {
        let group = ShapeGroup::from(case.shape.clone());
        let accel = build(vec![group.clone()]);
        let sample = |rng: &mut Rng| Some(parameters(case, &group.sample_area(0, rng.f32x2())));
        let pdf = |uv: [f64; 2]| {
            let Some((hit, surface)) = met(case, &accel, uv) else { return 0.0 };
            f64::from(group.pdf_area(&hit, &surface)) * normal(case, uv).length()
        };
        chi2_2d(sample, pdf, [[0.0, 1.0]; 2], DRAWS, 5).assert_ok(case.name, cases.len());
    }
}

/// Whole spheres are sampled in the cone that they fill, see below.
#[test]
fn points_follow_their_density_per_solid_angle() {
    let cases = cases();
    for case in cases.iter().filter(|c| c.name != "sphere") {
        let group = ShapeGroup::from(case.shape.clone());
        let accel = build(vec![group.clone()]);
        let o = vec3(1.2, -0.8, 1.1);
        let sample =
            |rng: &mut Rng| group.sample_solid_angle(0, o, rng.f32x2()).map(|s| parameters(case, &s));
        let pdf = |uv: [f64; 2]| {
            let Some((hit, surface)) = met(case, &accel, uv) else { return 0.0 };
            // solid angle per unit of both parameters: n . (p - o) / |p - o|^3
            let to = (case.point)(uv) - DVec3::from(o);
            let r2 = to.length_squared();
            let solid = normal(case, uv).dot(to).abs() / (r2 * r2.sqrt());
            f64::from(group.pdf_solid_angle(o, &hit, &surface)) * solid
        };
        chi2_2d(sample, pdf, [[0.0, 1.0]; 2], DRAWS, 6).assert_ok(case.name, cases.len());
    }
}

/// Seen from outside, from near and from afar: even over the cone, whose height and azimuth are the parameters.
#[test]
fn spheres_are_sampled_evenly_in_their_cone() {
    let (centre, radius) = (vec3(0.2, -0.1, 0.4), 0.6);
    let group = ShapeGroup::from(Shape::Sphere(Sphere::whole([0.2, -0.1, 0.4].map(f64::from), 0.6).unwrap()));
    let places = [vec3(0.2, 0.55, 0.4), vec3(1.2, -0.8, 1.1), vec3(30.0, -40.0, 20.0)];
    for o in places {
        let axis = DVec3::from(centre) - DVec3::from(o);
        let (far, axis) = (axis.length(), axis.normalize());
        // 1 - cos of the half-angle, without cancellation
        let sin2 = (radius / far) * (radius / far);
        let height = sin2 / (1.0 + (1.0 - sin2).sqrt());
        let side = axis.cross(d3(0.3, 0.5, -0.8)).normalize();
        let up = axis.cross(side);
        let sample = |rng: &mut Rng| {
            let s = group.sample_solid_angle(0, o, rng.f32x2())?;
            let w = (DVec3::from(s.p) - DVec3::from(o)).normalize();
            let (a, b) = (w.dot(side), w.dot(up));
            let off = a * a + b * b;
            let pdf = f64::from(s.pdf) * std::f64::consts::TAU * height;
            assert!((pdf - 1.0).abs() < 1e-4, "{o:?}: {pdf}");
            let x = off / (1.0 + (1.0 - off).sqrt()) / height;
            Some([x.min(1.0), 0.5 + b.atan2(a) / std::f64::consts::TAU])
        };
        chi2_2d(sample, |_| 1.0, [[0.0, 1.0]; 2], DRAWS, 7).assert_ok(&format!("{o:?}"), places.len());
    }
}
