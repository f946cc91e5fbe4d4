//! Normals, parametrisation and cuts as pbrt-v4 has them; refusals of bad input.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod common;

use common::{Rng, build};
use tyndall_base::vec::{vec2, vec3};
use tyndall_base::{Vec2, Vec3};
use tyndall_geometry::{
    BilinearMesh, Disk, GeometryError, Ray, Shape, ShapeGroup, Sphere, SurfacePoint, Transform, TriangleMesh,
};

fn surface(group: ShapeGroup, o: Vec3, d: Vec3) -> Option<SurfacePoint> {
    let a = build(vec![group]);
    let ray = Ray::new(o, d);
    a.intersect(&ray).map(|h| a.surface(&ray, &h))
}

const DOWN: Vec3 = vec3(0.0, 0.0, -1.0);

/// Counter-clockwise seen from +z.
fn triangle() -> TriangleMesh {
    TriangleMesh::new(vec![[0, 1, 2]], vec![vec3(0.0, 0.0, 0.0), vec3(2.0, 0.0, 0.0), vec3(0.0, 2.0, 0.0)])
        .unwrap()
}

fn patch() -> BilinearMesh {
    let p = [(0.0, 0.0), (2.0, 0.0), (0.0, 1.0), (2.0, 1.0)].map(|(x, y)| vec3(x, y, 0.0)).to_vec();
    BilinearMesh::new(vec![[0, 1, 2, 3]], p).unwrap()
}

#[test]
fn normals_turn_when_exactly_one_flag_is_set() {
    let shapes = [
        Shape::Triangles(triangle()),
        Shape::Bilinear(patch()),
        Shape::Disk(Disk::new(Transform::IDENTITY, 0.0, 1.0, 0.0, 360.0).unwrap()),
        Shape::Sphere(Sphere::whole([0.0, 0.0, -1.0], 1.0).unwrap()),
    ];
    for shape in shapes {
        for (reverse_orientation, transform_swaps_handedness) in
            [(false, false), (true, false), (false, true), (true, true)]
        {
            let group =
                ShapeGroup { reverse_orientation, transform_swaps_handedness, ..shape.clone().into() };
            let s = surface(group, vec3(0.1, 0.1, 5.0), DOWN).unwrap();
            let up = reverse_orientation == transform_swaps_handedness;
            assert_eq!(s.ng.z > 0.9, up, "{shape:?} {reverse_orientation} {transform_swaps_handedness}");
            assert!(s.ng.abs_dot(s.ns) > 0.9999);
        }
    }
}

/// With vertex normals the geometric normal follows them; they turn with reverse orientation alone.
#[test]
fn vertex_normals_decide_the_side() {
    let normals = vec![vec3(0.0, 0.1, -2.0); 3];
    let mesh = triangle().with_normals(normals).unwrap();
    let s = surface(Shape::Triangles(mesh.clone()).into(), vec3(0.1, 0.1, 5.0), DOWN).unwrap();
    assert!(s.ns.z < -0.99 && s.ng.z < -0.99);
    let reversed = ShapeGroup { reverse_orientation: true, ..Shape::Triangles(mesh.clone()).into() };
    let s = surface(reversed, vec3(0.1, 0.1, 5.0), DOWN).unwrap();
    assert!(s.ns.z > 0.99 && s.ng.z > 0.99);
    let mirrored = ShapeGroup { transform_swaps_handedness: true, ..Shape::Triangles(mesh).into() };
    let s = surface(mirrored, vec3(0.1, 0.1, 5.0), DOWN).unwrap();
    assert!(s.ns.z < -0.99 && s.ng.z < -0.99);
}

#[test]
fn texture_coordinates_and_tangents_are_consistent() {
    let s = surface(Shape::Triangles(triangle()).into(), vec3(0.5, 0.25, 5.0), DOWN).unwrap();
    // corners (0,0), (1,0), (1,1): weights 5/8, 1/4, 1/8
    assert_eq!(s.uv, vec2(0.375, 0.125));
    let uv: Vec<Vec2> = triangle().positions().iter().map(|p| vec2(3.0 * p.x + 1.0, 0.5 * p.y)).collect();
    let mesh = triangle().with_uv(uv).unwrap();
    let s = surface(Shape::Triangles(mesh).into(), vec3(0.5, 0.25, 5.0), DOWN).unwrap();
    assert_eq!(s.uv, vec2(2.5, 0.125));
    assert!(
        (s.dpdu - vec3(1.0 / 3.0, 0.0, 0.0)).length() < 1e-6
            && (s.dpdv - vec3(0.0, 2.0, 0.0)).length() < 1e-6
    );
    // coordinates that do not span the triangle: some tangents across the normal
    let mesh = triangle().with_uv(vec![vec2(0.0, 0.0); 3]).unwrap();
    let s = surface(Shape::Triangles(mesh).into(), vec3(0.5, 0.25, 5.0), DOWN).unwrap();
    assert!(s.dpdu.length() > 0.5 && s.dpdu.dot(s.ng).abs() < 1e-6);
    let s = surface(Shape::Bilinear(patch()).into(), vec3(0.5, 0.25, 5.0), DOWN).unwrap();
    assert_eq!((s.uv, s.dpdu, s.dpdv), (vec2(0.25, 0.25), vec3(2.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0)));
}

/// Both halves of a flat patch report its u and v.
#[test]
fn hits_of_flat_patches_carry_patch_coordinates() {
    let a = build(vec![Shape::Bilinear(patch()).into()]);
    let mut rng = Rng::new(1);
    for _ in 0..1000 {
        let (x, y) = (rng.unit() * 2.0, rng.unit());
        let ray = Ray::new(vec3(x, y, 1.0), DOWN);
        let hit = a.intersect(&ray).unwrap();
        assert!((hit.u - 0.5 * x).abs() < 1e-5 && (hit.v - y).abs() < 1e-5, "{hit:?}");
        assert_eq!(a.surface(&ray, &hit).p, vec3(x, y, 0.0));
    }
}

#[test]
fn sphere_parameters_are_pbrts() {
    let whole = || Shape::Sphere(Sphere::whole([0.0; 3], 2.0).unwrap()).into();
    // u from +x counter-clockwise, v from the south pole
    let s = surface(whole(), vec3(0.0, 9.0, 0.0), vec3(0.0, -1.0, 0.0)).unwrap();
    assert!((s.uv.x - 0.25).abs() < 1e-6 && (s.uv.y - 0.5).abs() < 1e-6);
    assert!(s.dpdu.normalize().dot(vec3(-1.0, 0.0, 0.0)) > 0.9999 && s.dpdv.normalize().z > 0.9999);
    let s = surface(whole(), vec3(0.0, 0.0, 9.0), DOWN).unwrap();
    assert_eq!(s.uv.y, 1.0);
    // the part below z = 1: a ray from above enters by the cut and meets the inside
    let part = Sphere::new(Transform::IDENTITY, 2.0, -2.0, 1.0, 360.0).unwrap();
    let s = surface(Shape::Sphere(part).into(), vec3(0.1, 0.0, 9.0), DOWN).unwrap();
    assert!(s.p.z < -1.9);
    // half a turn
    let half = || -> ShapeGroup {
        Shape::Sphere(Sphere::new(Transform::IDENTITY, 2.0, -2.0, 2.0, 180.0).unwrap()).into()
    };
    assert!(surface(half(), vec3(0.1, 9.0, 0.1), vec3(0.0, -1.0, 0.0)).unwrap().p.y > 1.9);
    assert!(surface(half(), vec3(0.1, -9.0, 0.1), vec3(0.0, 1.0, 0.0)).unwrap().p.y > 1.9);
}

#[test]
fn disks_have_holes_and_cuts() {
    let disk =
        || -> ShapeGroup { Shape::Disk(Disk::new(Transform::IDENTITY, 0.5, 2.0, 1.0, 90.0).unwrap()).into() };
    let at = |x, y| surface(disk(), vec3(x, y, 3.0), DOWN);
    let s = at(1.5, 1e-3).unwrap();
    assert_eq!((s.p.z, s.rounding.bound().z), (0.5, 0.0));
    assert!((s.uv.y - 0.5).abs() < 1e-5);
    assert!(
        at(0.5, 0.1).is_none()
            && at(2.1, 0.1).is_none()
            && at(-1.5, 0.1).is_none()
            && at(1.5, -0.1).is_none()
    );
}

/// A ball of 1 m seen from 10,000 km, and one of 10,000 km stood upon.
#[test]
fn spheres_are_met_to_the_last_digit() {
    let small = Sphere::whole([0.0; 3], 1.0).unwrap();
    let s = surface(Shape::Sphere(small).into(), vec3(0.6, 0.0, 1e7), DOWN).unwrap();
    assert!((s.p.z - 0.8).abs() < 1e-6, "{s:?}");
    let earth = Sphere::whole([0.0, 0.0, -1e7], 1e7).unwrap();
    let a = build(vec![Shape::Sphere(earth).into()]);
    let ray = Ray::new(vec3(0.0, 0.0, 1.5), vec3(0.6, 0.0, -0.8));
    let hit = a.intersect(&ray).unwrap();
    assert!((hit.t - 1.875).abs() < 1e-5, "{hit:?}");
    let s = a.surface(&ray, &hit);
    assert!(!a.occluded(&s.spawn(vec3(0.6, 0.0, 0.8))));
    assert!(a.occluded(&s.spawn(ray.d)));
}

/// No shape meets a ray again that leaves it outwards, and every closed one meets a ray that goes in.
#[test]
fn rays_leave_curved_shapes() {
    let turn = Transform::translate(40.0, -7.0, 300.0) * Transform::rotate(50.0, [1.0, 1.0, 0.2]).unwrap();
    let ball = Sphere::new(turn * Transform::scale(1.0, 3.0, 0.5).unwrap(), 2.0, -2.0, 2.0, 360.0).unwrap();
    let a = build(vec![Shape::Sphere(ball).into()]);
    let mut rng = Rng::new(3);
    for _ in 0..100_000 {
        let o = turn.point(rng.in_cube() * 12.0);
        let target = turn.point(rng.in_cube());
        let ray = Ray::new(o, (target - o).normalize());
        let Some(hit) = a.intersect(&ray) else { continue };
        let s = a.surface(&ray, &hit);
        let w = rng.direction();
        let outwards = w.dot(s.ng) > 0.0;
        // within the rounding of the normal itself the side is open
        if w.dot(s.ng).abs() > 1e-5 {
            assert_eq!(a.occluded(&s.spawn(w)), !outwards, "{s:?} {w:?}");
        }
    }
}

#[test]
fn bad_meshes_are_refused_with_the_place() {
    let p = || vec![vec3(0.0, 0.0, 0.0), vec3(1.0, 0.0, 0.0), vec3(0.0, f32::NAN, 0.0)];
    let error = TriangleMesh::new(vec![[0, 1, 2]], p()).unwrap_err();
    assert!(matches!(error, GeometryError::BadCoordinate { place, .. } if place.index == 2), "{error}");
    let error = TriangleMesh::new(vec![[0, 1, 2], [0, 1, 3]], triangle().positions().to_vec()).unwrap_err();
    assert_eq!(error.to_string(), "triangle 1: expected vertex indices below 3, got 3");
    assert!(triangle().with_normals(vec![Vec3::ZERO]).is_err());
    assert!(Sphere::whole([0.0; 3], -1.0).is_err());
    assert!(Disk::new(Transform::IDENTITY, 0.0, 1.0, 1.0, 360.0).is_err());
}

#[test]
fn triangles_without_area_are_left_out_and_counted() {
    let p = vec![vec3(0.0, 0.0, 0.0), vec3(1.0, 0.0, 0.0), vec3(2.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0)];
    let mesh = TriangleMesh::new(vec![[0, 1, 2], [0, 1, 3], [1, 1, 3]], p).unwrap();
    let a = build(vec![Shape::Triangles(mesh).into()]);
    assert_eq!((a.stats().triangles, a.stats().degenerate), (1, 2));
    let hit = a.intersect(&Ray::new(vec3(0.1, 0.1, 1.0), DOWN)).unwrap();
    assert_eq!(hit.prim, 1);
}
