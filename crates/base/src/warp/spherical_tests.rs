//! Solid angles against their definitions, chi-square of the directions, inverses.

use super::{SphericalRectangle, SphericalTriangle};
use crate::quadrature::adaptive;
use crate::vec::{Vec3, vec3};
use tyndall_testkit::{Rng, chi2_2d, chi2_sphere};

const FAMILY: usize = 12;

/// A triangle is the projection of the points `a + s (b - a) + t (c - a)`, area element `cos / r^2`.
fn solid_angle_by_quadrature(corner: Vec3, e1: Vec3, e2: Vec3, triangle: bool) -> f64 {
    let v = |p: Vec3| p.to_array().map(f64::from);
    let (p, a, b) = (v(corner), v(e1), v(e2));
    let n = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let height = (p[0] * n[0] + p[1] * n[1] + p[2] * n[2]).abs();
    let density = |s: f64, t: f64| {
        let q: [f64; 3] = std::array::from_fn(|i| p[i] + s * a[i] + t * b[i]);
        height / (q[0] * q[0] + q[1] * q[1] + q[2] * q[2]).powf(1.5)
    };
    let top = |s: f64| if triangle { 1.0 - s } else { 1.0 };
    adaptive(|s| adaptive(|t| density(s, t), 0.0, top(s), 1e-11), 0.0, 1.0, 1e-10)
}

fn triangles() -> [[Vec3; 3]; 5] {
    [
        [vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), vec3(0.0, 0.0, 1.0)],
        [vec3(1.0, 2.0, 3.0), vec3(-2.0, 1.5, 0.5), vec3(0.3, -1.0, 2.0)],
        [vec3(5.0, -1.0, 0.1), vec3(-4.0, 3.0, 0.1), vec3(-2.0, -6.0, 0.12)], // almost the hemisphere
        [vec3(10.0, 0.0, 0.0), vec3(10.0, 1.0, 0.2), vec3(11.0, 0.1, 1.0)],
        [vec3(3.0, -1.0, 0.01), vec3(3.0, 1.0, 0.01), vec3(1.0, 0.1, 0.02)], // grazing
    ]
}

fn rectangles() -> [[Vec3; 3]; 5] {
    let tilted = [vec3(0.8, 0.0, 0.6), vec3(-0.6, 0.0, 0.8)];
    [
        [vec3(-1.0, -1.0, 1.0), vec3(2.0, 0.0, 0.0), vec3(0.0, 2.0, 0.0)],
        [vec3(0.5, 1.0, -2.0), tilted[0] * 3.0, vec3(0.0, 1.5, 0.0)],
        [vec3(-4.0, -6.0, 0.1), vec3(9.0, 0.0, 0.0), vec3(0.0, 9.0, 0.0)],
        [vec3(3.0, 0.0, 0.02), vec3(0.0, 2.0, 0.0), vec3(1.0, 0.0, 0.0)],
        [vec3(0.0, 7.0, 1.0), tilted[1] * 0.5, vec3(0.0, 1.0, 0.0)],
    ]
}

#[test]
fn solid_angles_are_those_of_quadrature() {
    let octant = SphericalTriangle::new(triangles()[0]).unwrap().solid_angle();
    assert!((octant - std::f32::consts::FRAC_PI_2).abs() < 1e-6);
    let face = SphericalRectangle::new(rectangles()[0][0], rectangles()[0][1], rectangles()[0][2]).unwrap();
    assert!((face.solid_angle() - 4.0 * std::f32::consts::PI / 6.0).abs() < 1e-6, "a face of the cube");
    for [a, b, c] in triangles() {
        let exact = solid_angle_by_quadrature(a, b - a, c - a, true);
        let ours = SphericalTriangle::new([a, b, c]).unwrap().solid_angle();
        assert!((f64::from(ours) / exact - 1.0).abs() < 1e-6, "{ours} against {exact}");
    }
    for [p, x, y] in rectangles() {
        let exact = solid_angle_by_quadrature(p, x, y, false);
        let ours = SphericalRectangle::new(p, x, y).unwrap().solid_angle();
        assert!((f64::from(ours) / exact - 1.0).abs() < 1e-6, "{ours} against {exact}");
    }
}

/// The coordinates of the point of the plane `corner + s e1 + t e2` in the direction `w`.
fn plane_coordinates(w: Vec3, corner: Vec3, e1: Vec3, e2: Vec3) -> [f64; 2] {
    let v = |p: Vec3| p.to_array().map(f64::from);
    let det = |a: [f64; 3], b: [f64; 3], c: [f64; 3]| {
        a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    let (w, p, a, b) = (v(w), v(corner), v(e1), v(e2));
    let d = det(w, a, b);
    [-det(w, p, b) / d, -det(w, a, p) / d]
}

#[test]
fn triangles_follow_their_density() {
    for (i, [a, b, c]) in triangles().into_iter().enumerate() {
        let triangle = SphericalTriangle::new([a, b, c]).unwrap();
        let (e1, e2) = (b - a, c - a);
        let inside = |w: [f32; 3]| {
            let w = Vec3::from(w);
            let [s, t] = plane_coordinates(w, a, e1, e2);
            let front = (a + e1 * s as f32 + e2 * t as f32).dot(w) > 0.0;
            s >= 0.0 && t >= 0.0 && s + t <= 1.0 && front
        };
        let pdf = |w| if inside(w) { f64::from(triangle.pdf()) } else { 0.0 };
        if i == 1 || i == 2 {
            let test = chi2_sphere(|r| Some(triangle.sample(r.f32x2()).to_array()), pdf, 400_000, i as u64);
            test.assert_ok("triangle on the sphere", FAMILY);
        }
        // the narrow ones in the coordinates of their plane, where the diagonal bounds the square
        let density =
            |p: [f64; 2]| if p[0] + p[1] <= 1.0 { plane_density(triangle.pdf(), p, a, e1, e2) } else { 0.0 };
        let draw = |r: &mut Rng| Some(snap(plane_coordinates(triangle.sample(r.f32x2()), a, e1, e2)));
        chi2_2d(draw, density, UNIT_SQUARE, 200_000, 7).assert_ok(&format!("triangle {i}"), FAMILY);
    }
}

const UNIT_SQUARE: [[f64; 2]; 2] = [[0.0, 1.0], [0.0, 1.0]];

/// Brings what rounding left just outside the square back to its edge.
fn snap(p: [f64; 2]) -> [f64; 2] {
    p.map(|x| if (-1e-4..1.0001).contains(&x) { x.clamp(0.0, 1.0) } else { x })
}

/// A density per steradian as one in plane coordinates: times `cos / r^2` and the area of the parallelogram.
fn plane_density(pdf: f32, [s, t]: [f64; 2], corner: Vec3, e1: Vec3, e2: Vec3) -> f64 {
    let q = corner + e1 * s as f32 + e2 * t as f32;
    f64::from(pdf * q.abs_dot(e1.cross(e2)) / (q.length_squared() * q.length()))
}

#[test]
fn rectangles_follow_their_density() {
    for (i, [p, ex, ey]) in rectangles().into_iter().enumerate() {
        let rectangle = SphericalRectangle::new(p, ex, ey).unwrap();
        let density = |q: [f64; 2]| plane_density(rectangle.pdf(), q, p, ex, ey);
        let draw = |r: &mut Rng| {
            let q = rectangle.sample(r.f32x2());
            let [s, t] = plane_coordinates(q, p, ex, ey);
            let off = (p + ex * s as f32 + ey * t as f32 - q).length();
            assert!(off < 1e-5 * (1.0 + q.length()), "{q:?} lies {off} off the rectangle");
            Some(snap([s, t]))
        };
        chi2_2d(draw, density, UNIT_SQUARE, 200_000, 8).assert_ok(&format!("rectangle {i}"), FAMILY);
    }
}

#[test]
fn small_and_distant_shapes_are_sampled_evenly() {
    for distance in [10.0_f32, 100.0, 1000.0, 5000.0] {
        // far away, uniform in solid angle is uniform in area
        let (p, e1, e2) = (vec3(0.3, -0.2, distance), vec3(0.5, 0.1, 0.3), vec3(-0.05, 0.25, 0.0));
        let draw = |w: Vec3| Some(snap(plane_coordinates(w, p, e1, e2)));
        // f32 directions resolve 1e-7 of the distance: coarse points are spread over what they stand for
        let triangle = SphericalTriangle::new([p, p + e1, p + e2]).unwrap();
        let exact = solid_angle_by_quadrature(p, e1, e2, true);
        assert!((f64::from(triangle.solid_angle()) / exact - 1.0).abs() < 1e-4, "{distance}");
        let rectangle = SphericalRectangle::new(p, e1, e2).unwrap();
        if distance <= 100.0 {
            let density = |q: [f64; 2]| {
                if q[0] + q[1] <= 1.0 { plane_density(triangle.pdf(), q, p, e1, e2) } else { 0.0 }
            };
            let test = chi2_2d(|r| draw(triangle.sample(r.f32x2())), density, UNIT_SQUARE, 200_000, 9);
            test.assert_ok(&format!("triangle at {distance}"), FAMILY);
        }
        // points of the rectangle keep their digits
        let density = |q: [f64; 2]| plane_density(rectangle.pdf(), q, p, e1, e2);
        let draw = |r: &mut Rng| {
            let q = rectangle.sample(r.f32x2()) - p;
            Some(snap([
                f64::from(q.dot(e1) / e1.length_squared()),
                f64::from(q.dot(e2) / e2.length_squared()),
            ]))
        };
        chi2_2d(draw, density, UNIT_SQUARE, 200_000, 10)
            .assert_ok(&format!("rectangle at {distance}"), FAMILY);
    }
}

#[test]
fn inverses_lead_back() {
    let mut rng = Rng::new(11);
    for _ in 0..2000 {
        let u = [0.001 + 0.998 * rng.f32(), 0.001 + 0.998 * rng.f32()];
        for vertices in triangles() {
            let triangle = SphericalTriangle::new(vertices).unwrap();
            let v = triangle.invert(triangle.sample(u));
            assert!(
                (v[0] - u[0]).abs() < 2e-4 && (v[1] - u[1]).abs() < 2e-4,
                "{vertices:?}: {u:?} became {v:?}"
            );
        }
        for [p, x, y] in rectangles() {
            let rectangle = SphericalRectangle::new(p, x, y).unwrap();
            let v = rectangle.invert(rectangle.sample(u));
            assert!((v[0] - u[0]).abs() < 2e-4 && (v[1] - u[1]).abs() < 2e-4, "{p:?}: {u:?} became {v:?}");
        }
    }
}

#[test]
fn degenerate_shapes_are_refused() {
    let (x, y, z) = (vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), vec3(0.0, 0.0, 1.0));
    assert!(SphericalTriangle::new([x, y, x + y]).is_none(), "edge-on");
    assert!(SphericalTriangle::new([x, x, y]).is_none(), "two equal vertices");
    assert!(SphericalTriangle::new([Vec3::ZERO, x, y]).is_none(), "reference point on a vertex");
    assert!(SphericalTriangle::new([x * 1e6, x * 1e6 + y, x * 1e6 + z]).is_none(), "too far");
    assert!(SphericalRectangle::new(x, x, y).is_none(), "edge-on");
    assert!(SphericalRectangle::new(z, Vec3::ZERO, y).is_none(), "no width");
    assert!(SphericalRectangle::new(z * 1e6, x, y).is_none(), "too far");
    assert!(SphericalRectangle::new(vec3(f32::NAN, 0.0, 1.0), x, y).is_none(), "not a number");
}
