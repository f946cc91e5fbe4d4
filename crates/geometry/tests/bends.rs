//! How shading normals change along a surface, against normals nearby.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod common;

use common::Rng;
use tyndall_base::Vec3;
use tyndall_base::vec::{vec2, vec3};
use tyndall_geometry::{
    Accel, BilinearMesh, BuildOptions, Cylinder, Disk, InstanceDesc, Ray, Shape, ShapeGroup, Sphere,
    SurfacePoint, Transform, TriangleMesh,
};

/// Corners of a square about the origin, z upwards in the middle of no edge.
fn corners() -> Vec<Vec3> {
    vec![vec3(-1.0, -1.0, 0.0), vec3(1.0, -1.0, 0.3), vec3(-1.0, 1.0, -0.2), vec3(1.0, 1.0, 0.6)]
}

fn normals() -> Vec<Vec3> {
    vec![vec3(-0.4, -0.1, 2.0), vec3(0.3, -0.3, 1.0), vec3(-0.2, 0.4, 0.5), vec3(0.5, 0.2, 1.5)]
}

fn shapes() -> Vec<(&'static str, Shape)> {
    let squash = Transform::rotate(40.0, [1.0, 0.3, 0.2]).unwrap() * Transform::scale(1.0, 0.6, 1.4).unwrap();
    let triangles = || TriangleMesh::new(vec![[0, 1, 3], [0, 3, 2]], corners()).unwrap();
    let patch = || BilinearMesh::new(vec![[0, 1, 2, 3]], corners()).unwrap();
    let uv = || vec![vec2(0.1, 0.2), vec2(1.4, 0.1), vec2(0.3, 2.2), vec2(1.5, 1.7)];
    vec![
        ("sphere", Shape::Sphere(Sphere::new(squash, 1.0, -0.9, 0.9, 300.0).unwrap())),
        ("cylinder", Shape::Cylinder(Cylinder::new(squash, 0.8, -1.0, 1.0, 300.0).unwrap())),
        ("disk", Shape::Disk(Disk::new(squash, 0.1, 1.0, 0.0, 360.0).unwrap())),
        ("facets", Shape::Triangles(triangles())),
        ("smooth", Shape::Triangles(triangles().with_normals(normals()).unwrap())),
        ("textured", Shape::Triangles(triangles().with_normals(normals()).unwrap().with_uv(uv()).unwrap())),
        ("patch", Shape::Bilinear(patch())),
        ("textured patch", Shape::Bilinear(patch().with_uv(uv()).unwrap())),
        ("smooth patch", Shape::Bilinear(patch().with_normals(normals()).unwrap().with_uv(uv()).unwrap())),
    ]
}

fn surface(a: &Accel, ray: &Ray) -> Option<(u32, SurfacePoint)> {
    let hit = a.intersect(ray)?;
    let mut s = a.surface(ray, &hit);
    assert_eq!(s.dn, [Vec3::ZERO; 2], "only where it is asked for");
    a.bend(ray, &hit, &mut s);
    Some((hit.prim, s))
}

#[test]
fn normals_nearby_tell_the_change() {
    const STEP: f32 = 2e-3;
    let stretch =
        Transform::rotate(-70.0, [0.2, 1.0, 0.5]).unwrap() * Transform::scale(1.3, -0.7, 1.0).unwrap();
    for (name, shape) in shapes() {
        for (reverse_orientation, to_world) in [(false, None), (true, None), (true, Some(stretch))] {
            let group = ShapeGroup { reverse_orientation, ..shape.clone().into() };
            let placed = to_world.map(|t| InstanceDesc::at_rest(0, t));
            let objects = if placed.is_some() { vec![vec![0]] } else { vec![] };
            let instances = placed.into_iter().collect();
            let a = Accel::build(vec![group], &objects, instances, &BuildOptions::default()).unwrap();
            let mut rng = Rng::new(7);
            let (mut judged, mut bent) = (0, 0);
            for _ in 0..3000 {
                let target = rng.in_cube() * 0.7;
                let d = rng.direction();
                let o = target - d * 4.0;
                let Some((prim, s)) = surface(&a, &Ray::new(o, d)) else { continue };
                if d.abs_dot(s.ng) < 0.4 {
                    continue;
                }
                for (along, dn) in [s.dpdu, s.dpdv].into_iter().zip(s.dn) {
                    let length = along.length();
                    let step = along * (STEP / length);
                    let ends = [step, -step].map(|step| surface(&a, &Ray::new(o + step, d)));
                    let [Some((p1, s1)), Some((p2, s2))] = ends else { continue };
                    // another primitive, or the far side through a gap
                    let far = (s1.p - s2.p).length() > 4.0 * STEP;
                    if p1 != prim || p2 != prim || far {
                        continue;
                    }
                    let want = (s1.ns - s2.ns) * (0.5 / STEP);
                    let got = dn * (1.0 / length);
                    let near = (got - want).length() < 2e-3 * (1.0 + want.length());
                    assert!(near, "{name} {reverse_orientation} {to_world:?}: {got:?}, expected {want:?}");
                    judged += 1;
                    bent += u32::from(want.length() > 0.05);
                }
            }
            let flat = ["disk", "facets"].contains(&name);
            assert!(judged > 500 && (flat || bent > 300), "{name}: {judged}, {bent} bent");
        }
    }
}
