//! Samplers against their densities and against quadrature.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod common;

use common::{Rng, build};
use tyndall_base::Vec3;
use tyndall_base::vec::vec3;
use tyndall_geometry::dvec::DVec3;
use tyndall_geometry::{
    BilinearMesh, Cylinder, Disk, Ray, Shape, ShapeGroup, Sphere, Transform, TriangleMesh,
};

fn turned() -> Transform {
    Transform::translate(0.2, -0.1, 0.4) * Transform::rotate(35.0, [1.0, 2.0, 0.5]).unwrap()
}

fn triangle() -> Shape {
    let p = vec![vec3(-0.5, -0.3, 0.1), vec3(0.8, 0.0, -0.2), vec3(0.1, 0.9, 0.3)];
    Shape::Triangles(TriangleMesh::new(vec![[0, 1, 2]], p).unwrap())
}

fn patch(p: [[f32; 3]; 4]) -> Shape {
    Shape::Bilinear(BilinearMesh::new(vec![[0, 1, 2, 3]], p.map(Vec3::from).to_vec()).unwrap())
}

fn rectangle() -> Shape {
    let t = turned();
    let p = [(-0.5, -0.3), (0.7, -0.3), (-0.5, 0.4), (0.7, 0.4)]
        .map(|(x, y)| t.point(vec3(x, y, 0.0)).to_array());
    patch(p)
}

fn shapes() -> Vec<(&'static str, Shape)> {
    let squash = turned() * Transform::scale(1.0, 0.4, 0.7).unwrap();
    let sphere = |t, lo, hi, phi| Shape::Sphere(Sphere::new(t, 0.6, lo, hi, phi).unwrap());
    let disk = |t, inner, phi| Shape::Disk(Disk::new(t, 0.1, 0.7, inner, phi).unwrap());
    let cylinder = |t, phi| Shape::Cylinder(Cylinder::new(t, 0.4, -0.3, 0.5, phi).unwrap());
    vec![
        ("cylinder", cylinder(turned(), 360.0)),
        ("part of a squeezed cylinder", cylinder(squash, 200.0)),
        ("triangle", triangle()),
        ("rectangle", rectangle()),
        ("parallelogram", patch([[0.0, 0.0, 0.0], [0.8, 0.0, 0.1], [0.3, 0.5, 0.0], [1.1, 0.5, 0.1]])),
        ("curved patch", patch([[0.0, 0.0, 0.0], [0.9, 0.0, 0.3], [0.0, 0.8, 0.3], [0.7, 1.0, -0.2]])),
        ("trapezium", patch([[0.0, 0.0, 0.0], [0.9, 0.0, 0.0], [0.3, 0.8, 0.0], [0.5, 0.8, 0.0]])),
        ("sphere", sphere(turned() * Transform::scale(1.3, 1.3, 1.3).unwrap(), -0.6, 0.6, 360.0)),
        ("part of a sphere", sphere(turned(), -0.2, 0.5, 200.0)),
        ("ellipsoid", sphere(squash, -0.6, 0.6, 360.0)),
        ("disk", disk(turned(), 0.0, 360.0)),
        ("elliptic sector", disk(squash, 0.3, 250.0)),
    ]
}

fn mean_and_error(x: &[f64]) -> (f64, f64) {
    let n = x.len() as f64;
    let mean = x.iter().sum::<f64>() / n;
    let var = x.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n - 1.0);
    (mean, (var / n).sqrt())
}

/// Five standard errors, and what `f32` may take.
fn assert_near(name: &str, (mean, error): (f64, f64), want: f64) {
    assert!(
        (mean - want).abs() <= 5.0 * error + 2e-6 * want.abs(),
        "{name}: {mean} +- {error}, expected {want}"
    );
}

/// A smooth function of the direction: its integral over the shape's solid angle must come out of both samplers alike.
fn smooth(w: Vec3) -> f64 {
    f64::from(1.0 + 0.5 * w.x - 0.3 * w.y * w.z)
}

/// Samplers stratified 512 x 512 with a jitter.
fn strata(rng: &mut Rng) -> Vec<[f32; 2]> {
    let n = 512;
    let cell = |i: usize, r: f32| ((i as f32 + r) / n as f32).min(1.0 - f32::EPSILON);
    (0..n * n).map(|k| [cell(k % n, rng.unit()), cell(k / n, rng.unit())]).collect()
}

#[test]
fn area_densities_integrate_to_the_area_and_match_hits() {
    for (name, shape) in shapes() {
        let group = ShapeGroup::from(shape);
        let a = build(vec![group.clone()]);
        let mut rng = Rng::new(11);
        let samples: Vec<_> = strata(&mut rng).into_iter().map(|u| group.sample_area(0, u)).collect();
        // the mean of 1 / density is the area
        let inverse: Vec<f64> = samples.iter().map(|s| 1.0 / f64::from(s.pdf)).collect();
        let (mean, error) = mean_and_error(&inverse);
        let area = f64::from(group.area(0));
        assert_near(name, (mean, error), area);
        for s in samples.iter().step_by(1001) {
            assert!((s.n.length() - 1.0).abs() < 1e-6, "{name}");
            let ray = Ray::new(s.p + s.n * 0.05, -s.n);
            let hit = a.intersect(&ray).unwrap_or_else(|| panic!("{name}: {s:?} is not on the shape"));
            let surface = a.surface(&ray, &hit);
            assert!((surface.p - s.p).length() < 2e-6, "{name}: {surface:?} {s:?}");
            assert!(surface.ng.dot(s.n) > 0.999, "{name}: {surface:?} {s:?}");
            assert!((group.pdf_area(&hit, &surface) / s.pdf - 1.0).abs() < 1e-3, "{name}");
        }
    }
}

/// An integral over the shape's directions comes out alike by sampling the shape and by plain directions.
#[test]
fn solid_angle_sampling_agrees_with_plain_directions() {
    for (name, shape) in shapes() {
        let group = ShapeGroup::from(shape);
        let a = build(vec![group.clone()]);
        for (k, o) in
            [vec3(1.2, -0.8, 1.1), vec3(0.3, 0.1, 2.5), vec3(0.15, 0.05, 0.25)].into_iter().enumerate()
        {
            // curved shapes are seen twice along some directions: sampling counts both sheets, a ray the first
            let mut rng = Rng::new(17 + k as u64);
            let count_all = |w: Vec3| {
                let mut sheets = 0.0;
                let mut ray = Ray::new(o, w);
                while let Some(h) = a.intersect(&ray) {
                    sheets += 1.0;
                    assert!(sheets < 9.0, "{name}: endless at {h:?} of {ray:?}: {:?}", a.surface(&ray, &h));
                    ray = a.surface(&ray, &h).spawn(w);
                }
                sheets
            };
            let cone = name == "sphere" && (o - vec3(0.2, -0.1, 0.4)).length() > 0.6 * 1.3;
            let plain: Vec<f64> = (0..100_000)
                .map(|_| {
                    let w = rng.direction();
                    let sheets = if cone {
                        f64::from(a.intersect(&Ray::new(o, w)).is_some() as u8)
                    } else {
                        count_all(w)
                    };
                    sheets * smooth(w) * 4.0 * std::f64::consts::PI
                })
                .collect();
            let want = mean_and_error(&plain);
            let sampled: Vec<f64> = strata(&mut rng)
                .into_iter()
                .step_by(4)
                .map(|u| {
                    group
                        .sample_solid_angle(0, o, u)
                        .map_or(0.0, |s| smooth((s.p - o).normalize()) / f64::from(s.pdf))
                })
                .collect();
            let got = mean_and_error(&sampled);
            let error = (want.1 * want.1 + got.1 * got.1).sqrt();
            assert!(
                (got.0 - want.0).abs() < 4.5 * error,
                "{name} from {o:?}: {got:?}, by directions {want:?}"
            );
        }
    }
}

/// The density that a met point reports is the one it was sampled with.
#[test]
fn solid_angle_densities_match_hits() {
    for (name, shape) in shapes() {
        let group = ShapeGroup::from(shape);
        let a = build(vec![group.clone()]);
        let mut rng = Rng::new(23);
        for _ in 0..3000 {
            let o = rng.in_cube() * 3.0;
            let Some(s) = group.sample_solid_angle(0, o, [rng.unit(), rng.unit()]) else { continue };
            let w = (DVec3::from(s.p) - DVec3::from(o)).normalize().round();
            let ray = Ray::new(o, w);
            let Some(hit) = a.intersect(&ray) else { continue };
            let surface = a.surface(&ray, &hit);
            let graze = w.abs_dot(s.n) < 0.02;
            if (surface.p - s.p).length() < 1e-4 && !graze {
                let pdf = group.pdf_solid_angle(o, &hit, &surface);
                assert!((pdf / s.pdf - 1.0).abs() < 2e-3, "{name}: {pdf} {}", s.pdf);
            }
            // the ray to a sample is not stopped by the sample's own surface; a curved one may hide its far side
            if graze && !["triangle", "rectangle", "parallelogram", "disk", "elliptic sector"].contains(&name)
            {
                continue;
            }
            let ray = s.ray_from(o, 0.0).expect("apart");
            if let Some(h) = a.intersect(&ray) {
                assert!(
                    (ray.at(h.t) - s.p).length() > 1e-3,
                    "{name}: {s:?} hides itself from {o:?}: {ray:?} {h:?} cosine {}",
                    w.dot(s.n)
                );
            }
        }
    }
}

/// Triangle, rectangle and cone samplers spread evenly: chi-square over the octants' halves of their solid angle.
#[test]
fn solid_angle_samplers_are_uniform() {
    let o = vec3(0.9, -0.6, 1.0);
    for (name, shape) in [
        ("triangle", triangle()),
        ("rectangle", rectangle()),
        ("sphere", Shape::Sphere(Sphere::whole([0.1, 0.0, 0.0], 0.7).unwrap())),
    ] {
        let group = ShapeGroup::from(shape);
        let a = build(vec![group.clone()]);
        let mut rng = Rng::new(31);
        // cells: direction components split at the mean direction
        let middle = (0..1000).filter_map(|_| group.sample_solid_angle(0, o, [rng.unit(), rng.unit()]));
        let middle = middle.fold(Vec3::ZERO, |m, s| m + (s.p - o).normalize()) * 1e-3;
        let cell = |w: Vec3| {
            let d = w - middle;
            usize::from(d.x > 0.0)
                + 2 * usize::from(d.y > 0.0)
                + 4 * usize::from(d.z > 0.0)
                + 8 * usize::from(d.x > d.y)
        };
        let (mut sampled, mut expected) = ([0u32; 16], [0u32; 16]);
        let n = 200_000;
        for _ in 0..n {
            if let Some(s) = group.sample_solid_angle(0, o, [rng.unit(), rng.unit()]) {
                sampled[cell((s.p - o).normalize())] += 1;
            }
        }
        let mut met = 0u32;
        while met < n {
            let w = rng.direction();
            if a.occluded(&Ray::new(o, w)) {
                met += 1;
                expected[cell(w)] += 1;
            }
        }
        // two samples of equal size: sum (a - b)^2 / (a + b) is chi-square with cells - 1 degrees of freedom
        let used: Vec<usize> = (0..16).filter(|&k| sampled[k] + expected[k] > 20).collect();
        let chi2: f64 = used
            .iter()
            .map(|&k| {
                let (a, b) = (f64::from(sampled[k]), f64::from(expected[k]));
                (a - b) * (a - b) / (a + b)
            })
            .sum();
        let dof = used.len() as f64 - 1.0;
        // Wilson & Hilferty: the 1 - 1e-4 quantile
        let c = 2.0 / (9.0 * dof);
        let limit = dof * (1.0 - c + 3.72 * c.sqrt()).powi(3);
        assert!(
            chi2 < limit,
            "{name}: chi-square {chi2} over {dof} dof, limit {limit}: {sampled:?} {expected:?}"
        );
    }
}
