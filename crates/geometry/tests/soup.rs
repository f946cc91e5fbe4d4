//! The tree against a test of every primitive, on random triangles, patches, spheres and disks.

mod common;

use common::{Rng, accel, soup};
use tyndall_base::vec::vec3;
use tyndall_geometry::dvec::DVec3;
use tyndall_geometry::{Accel, BuildOptions, Dispatch, Ray, Shape, TriangleMesh};

/// Moeller-Trumbore in `f64` over all triangles.
fn brute(mesh: &TriangleMesh, ray: &Ray) -> Option<(f64, u32)> {
    let (o, d) = (DVec3::from(ray.o), DVec3::from(ray.d));
    let mut best: Option<(f64, u32)> = None;
    for prim in 0..mesh.indices().len() as u32 {
        let [a, b, c] = mesh.corners(prim).map(DVec3::from);
        let (e1, e2) = (b - a, c - a);
        let p = d.cross(e2);
        let det = e1.dot(p);
        let s = o - a;
        let (u, q) = (s.dot(p) / det, s.cross(e1));
        let (v, t) = (d.dot(q) / det, e2.dot(q) / det);
        let inside = u >= 0.0 && v >= 0.0 && u + v <= 1.0;
        if inside && t > 0.0 && t <= f64::from(ray.t_max) && best.is_none_or(|(b, _)| t < b) {
            best = Some((t, prim));
        }
    }
    best
}

#[test]
fn random_triangles_agree_with_brute_force() {
    for (seed, size) in [(1, 0.5), (2, 0.05), (3, 0.005)] {
        let mesh = soup(3000, size, seed);
        let accel = accel(mesh.clone());
        let mut rng = Rng::new(seed);
        let mut hits = 0;
        for _ in 0..2000 {
            let ray = rng.ray();
            // at some triangle, as small ones are seldom met by chance
            let [a, b, c] = mesh.corners(rng.below(3000) as u32);
            let ray = Ray { d: ((a + b + c) * (1.0 / 3.0) - ray.o).normalize(), ..ray };
            let (hit, want) = (accel.intersect(&ray), brute(&mesh, &ray));
            assert_eq!(hit.map(|h| h.prim), want.map(|w| w.1), "{ray:?} {hit:?} {want:?}");
            assert_eq!(accel.occluded(&ray), want.is_some());
            if let (Some(hit), Some((t, _))) = (hit, want) {
                hits += 1;
                assert!((f64::from(hit.t) - t).abs() <= 1e-7 * t);
                let s = accel.surface(&ray, &hit);
                assert!((s.p - ray.at(hit.t)).length() < 1e-5);
                let short = Ray { t_max: hit.t * 0.999, ..ray };
                assert!(accel.intersect(&short).is_none_or(|h| h.t <= short.t_max && h.prim != hit.prim));
            }
        }
        assert!(hits > 1900, "{hits} hits say little");
    }
}

#[test]
fn every_instruction_set_gives_the_same_bits() {
    let groups = || vec![Shape::Triangles(soup(20_000, 0.05, 7)).into()];
    let build = |dispatch| Accel::build(groups(), &[], vec![], &BuildOptions { dispatch }).unwrap();
    let plain = build(Dispatch::Portable);
    let there_are =
        [Dispatch::Avx2, Dispatch::Avx512, Dispatch::Detect].into_iter().filter(|d| d.is_available());
    let fast: Vec<Accel> = there_are.map(build).collect();
    let mut rng = Rng::new(9);
    for _ in 0..20_000 {
        let ray = rng.ray();
        let bits =
            |a: &Accel| a.intersect(&ray).map(|h| (h.t.to_bits(), h.prim, h.u.to_bits(), h.v.to_bits()));
        for fast in &fast {
            assert_eq!(bits(fast), bits(&plain));
            assert_eq!(fast.occluded(&ray), plain.occluded(&ray));
        }
    }
}

#[test]
fn a_grazing_ray_within_a_plane_invents_nothing() {
    // rays along a large tilted triangle's plane but beside it
    let p = vec![vec3(0.0, 0.0, 0.0), vec3(1.0, 0.1, 0.3), vec3(0.2, 1.0, -0.4)];
    let mesh = TriangleMesh::new(vec![[0, 1, 2]], p.clone()).unwrap();
    let accel = accel(mesh.clone());
    let mut rng = Rng::new(4);
    for _ in 0..20_000 {
        let at = |a: f32, b: f32| p[1] * a + p[2] * b;
        let o = at(rng.signed() * 3.0, rng.signed() * 3.0);
        let target = at(rng.signed() * 3.0, rng.signed() * 3.0);
        let ray = Ray::new(o, (target - o).normalize());
        if let Some(hit) = accel.intersect(&ray) {
            let q = ray.at(hit.t);
            assert!(mesh.prim_bounds(0).padded(vec3(1e-4, 1e-4, 1e-4)).contains(q), "{ray:?} {hit:?}");
        }
    }
}
