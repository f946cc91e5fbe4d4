//! Boxes of media that share faces: the medium of a ray does not depend on which of the faces it meets.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use tyndall_base::vec::{Vec3, vec3};
use tyndall_geometry::{Accel, BuildOptions, Ray, Shape, ShapeGroup, Transform, TriangleMesh};
use tyndall_transport::scene::{BOUNDARY, Boundary, ShapeBinding};
use tyndall_transport::touching::may_touch;
use tyndall_transport::{MaterialId, MediumId, Scene};

const AIR: MediumId = MediumId::VACUUM;
const A: MediumId = MediumId(0);
const B: MediumId = MediumId(1);

/// A box from `lo` to `hi`, with the medium inside and the one outside.
type Body = (Vec3, Vec3, MediumId, MediumId);

fn mesh((lo, hi, ..): &Body, to_world: &Transform) -> Shape {
    let corner = |k: u32| {
        let pick = |bit: u32, lo: f32, hi: f32| if k >> bit & 1 == 0 { lo } else { hi };
        to_world.point(vec3(pick(0, lo.x, hi.x), pick(1, lo.y, hi.y), pick(2, lo.z, hi.z)))
    };
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let indices = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Shape::Triangles(TriangleMesh::new(indices, (0..8).map(corner).collect()).unwrap())
}

fn scene(bodies: &[Body], to_world: &Transform) -> Scene {
    let group = |b: &Body| ShapeGroup { mask: BOUNDARY, ..mesh(b, to_world).into() };
    let binding = |&(_, _, inside, outside): &Body| ShapeBinding {
        material: MaterialId::INTERFACE,
        boundary: Some(Boundary { inside, outside }),
        first_light: None,
        alpha: None,
    };
    let groups = bodies.iter().map(group).collect();
    let accel = Accel::build(groups, &[], vec![], &BuildOptions::default()).unwrap();
    let shapes: Vec<_> = bodies.iter().map(binding).collect();
    let has_touching_boundaries = may_touch(&accel, &shapes, bodies.len());
    Scene { accel, shapes, has_boundaries: true, has_touching_boundaries, ..Scene::empty() }
}

/// The innermost body around `p`: the smallest one.
fn medium_at(bodies: &[Body], p: Vec3) -> MediumId {
    let holds = |b: &&Body| (0..3).all(|k| p[k] > b.0[k] && p[k] < b.1[k]);
    let size = |b: &Body| (b.1 - b.0).x;
    let inside: Vec<&Body> = bodies.iter().filter(holds).collect();
    inside.iter().min_by(|a, b| size(a).total_cmp(&size(b))).map_or(AIR, |b| b.2)
}

/// Fractional parts of multiples of irrationals, from -1 to 1.
fn point(i: u32) -> Vec3 {
    let at = |irrational: f64| ((f64::from(i) * irrational).fract() * 2.0 - 1.0) as f32;
    vec3(at(0.819_172_513_396_164_4), at(0.671_043_606_703_789_2), at(0.549_700_477_901_970_3))
}

#[test]
fn rays_know_where_they_are_whatever_the_order() {
    let one = vec3(1.0, 1.0, 1.0);
    let middle = vec3(0.0, 1.0, 1.0);
    let side_by_side = [(-one, middle, A, AIR), (vec3(0.0, -1.0, -1.0), one, B, AIR)];
    let alike = [(-one, middle, A, AIR), (vec3(0.0, -1.0, -1.0), one, A, AIR)];
    let in_a_corner = [(-one, one, A, AIR), (Vec3::ZERO, one, B, A)];
    let slanted = Transform::translate(0.3, -0.2, 0.1) * Transform::rotate(33.0, [0.3, 0.5, 1.0]).unwrap();
    for bodies in [side_by_side, alike, in_a_corner] {
        let swapped = [bodies[1], bodies[0]];
        for (order, to_world) in
            [bodies, swapped].iter().flat_map(|o| [(o, Transform::IDENTITY), (o, slanted)])
        {
            let scene = scene(order, &to_world);
            assert!(scene.has_touching_boundaries);
            for i in 0..2000 {
                let (start, through) = (point(i).normalize() * 4.0, point(5 * i + 3) * 0.9);
                let d = (through - start).normalize();
                let (mut ray, mut medium) = (Ray::new(to_world.point(start), to_world.vector(d)), AIR);
                while let Some(hit) = scene.intersect(&ray) {
                    let isect = scene.interaction(&ray, &hit);
                    medium = isect.medium_towards(ray.d, medium);
                    let beyond = to_world.inverse().point(isect.surface.p) + d * 1e-4;
                    // a grazed edge says nothing
                    let edge = (0..3)
                        .filter(|&k| [-1.0, 0.0, 1.0].iter().any(|x| (beyond[k] - x).abs() < 1e-3))
                        .count();
                    if edge < 2 {
                        assert_eq!(medium, medium_at(order, beyond), "{order:?}, ray {i}, at {beyond:?}");
                    }
                    ray = isect.surface.spawn(ray.d);
                }
                assert_eq!(medium, AIR);
            }
        }
    }
}

#[test]
fn boxes_apart_are_not_looked_at_twice() {
    let one = vec3(1.0, 1.0, 1.0);
    let (a, within) = ((-one, one, A, AIR), (-one * 0.5, one * 0.5, B, A));
    let beside = (vec3(1.01, -1.0, -1.0), vec3(2.0, 1.0, 1.0), B, AIR);
    for bodies in [[a, within], [a, beside]] {
        assert!(!scene(&bodies, &Transform::IDENTITY).has_touching_boundaries);
    }
}
