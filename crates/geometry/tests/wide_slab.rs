//! A slab 8,000 wide and 1 thick with a black plane 0.001 under it: rays meet top, bottom and plane in that order,
//! from inside, from far away, upright and tilted, and never the surface they leave.
//!
//! Tilted by 17 degrees the corners lie some 4,000 from the origin, where neighbouring `f32` are 0.00024 apart: each
//! surface is then off by up to half that per axis, the gap of 0.001 is known to about +-0.0004, and the order of the
//! surfaces still holds everywhere, which is what is asserted. What `f32` corners cannot hold at that tilt is a gap
//! below about 0.0005.

mod common;

use common::{Rng, build};
use tyndall_base::Vec3;
use tyndall_base::vec::vec3;
use tyndall_geometry::{Accel, BilinearMesh, Ray, Shape, SurfacePoint, Transform, TriangleMesh};

const TOP: u32 = 0;
const BOTTOM: u32 = 1;
const PLANE: u32 = 2;
const HALF: f32 = 4000.0;

fn rectangle(z: f32, to_world: &Transform, patches: bool) -> Shape {
    let p = [(-HALF, -HALF), (HALF, -HALF), (-HALF, HALF), (HALF, HALF)];
    let p = p.map(|(x, y)| to_world.point(vec3(x, y, z))).to_vec();
    if patches {
        Shape::Bilinear(BilinearMesh::new(vec![[0, 1, 2, 3]], p).expect("a valid mesh"))
    } else {
        Shape::Triangles(TriangleMesh::new(vec![[0, 1, 3], [0, 3, 2]], p).expect("a valid mesh"))
    }
}

fn scene(to_world: &Transform, patches: bool) -> Accel {
    build([1.0, 0.0, -0.001].map(|z| rectangle(z, to_world, patches).into()).to_vec())
}

/// A point of the slab, at all scales of distance from its faces.
fn inside(rng: &mut Rng, to_world: &Transform, least: f32) -> Vec3 {
    let depth = least.max(tyndall_base::math::exp(-12.0 * rng.unit()) * 0.5);
    let z = if rng.below(2) == 0 { depth } else { 1.0 - depth };
    to_world.point(vec3(rng.signed() * 3900.0, rng.signed() * 3900.0, z))
}

fn meet(a: &Accel, ray: &Ray) -> Option<(u32, SurfacePoint)> {
    a.intersect(ray).map(|h| (h.shape, a.surface(ray, &h)))
}

/// A direction at all scales of grazing that stays within the width before it has crossed `drop`.
fn slanted(rng: &mut Rng, to_world: &Transform, down: bool) -> Vec3 {
    let tilt = tyndall_base::math::exp(-6.0 * rng.unit());
    let (sin, cos) = tyndall_base::math::sin_cos_turns(rng.unit());
    let across = (1.0 - tilt * tilt).max(0.0).sqrt();
    to_world.vector(vec3(across * cos, across * sin, if down { -tilt } else { tilt }).normalize())
}

fn check_order(to_world: &Transform, patches: bool, least: f32, seed: u64) {
    let a = scene(to_world, patches);
    let mut rng = Rng::new(seed);
    let within = |p: Vec3| {
        let q = to_world.inverse().point(p);
        q.x.abs() < 3990.0 && q.y.abs() < 3990.0
    };
    let mut counted = 0;
    for i in 0..100_000 {
        let o = inside(&mut rng, to_world, least);
        // down through the bottom: bottom, then the plane, then nothing
        let ray = Ray::new(o, slanted(&mut rng, to_world, true));
        let first = meet(&a, &ray);
        let Some((BOTTOM, s)) = first else {
            assert!(first.is_none() && !within(ray.at(2000.0)), "{i}: {ray:?} met {first:?}");
            continue;
        };
        if !within(s.p) {
            continue;
        }
        counted += 1;
        let next = s.spawn(ray.d);
        let (shape, under) =
            meet(&a, &next).unwrap_or_else(|| panic!("{i}: {next:?} stepped over the plane"));
        assert_eq!(shape, PLANE, "{i}: left the bottom along {next:?}");
        assert!(!a.occluded(&under.spawn(ray.d)), "{i}: the plane is the last");
        // reflected from the plane: the bottom from below, then the top, then nothing
        let up = slanted(&mut rng, to_world, false);
        let (shape, s) = meet(&a, &under.spawn(up)).unwrap_or_else(|| panic!("{i}: nothing above the plane"));
        assert_eq!(shape, BOTTOM);
        if !within(s.p) {
            continue;
        }
        let out = s.spawn(up);
        match meet(&a, &out) {
            Some((TOP, s)) => assert!(!a.occluded(&s.spawn(up)), "{i}: the top is the last"),
            other => assert!(other.is_none() && !within(out.at(2000.0)), "{i}: {other:?}"),
        }
        // scattered back at the bottom's inner side
        let (shape, _) = meet(&a, &s.spawn(-ray.d)).unwrap_or((TOP, s));
        assert_eq!(shape, TOP, "{i}: reflected inside");
    }
    assert!(counted > 50_000, "{counted} rays say little");
}

fn check_from_afar(to_world: &Transform, patches: bool, seed: u64) {
    let a = scene(to_world, patches);
    let mut rng = Rng::new(seed);
    for distance in [10.0, 1e3, 1e5] {
        for i in 0..20_000 {
            let target = to_world.point(vec3(rng.signed() * 3000.0, rng.signed() * 3000.0, 0.5));
            let side = if i % 2 == 0 { 1.0 } else { -1.0 };
            let from = vec3(rng.signed(), rng.signed(), side * (0.3 + rng.unit()));
            let eye = target + to_world.vector(from.normalize()) * distance;
            let mut ray = Ray::new(eye, (target - eye).normalize());
            let mut met = vec![];
            while let Some((shape, s)) = meet(&a, &ray) {
                met.push(shape);
                ray = s.spawn(ray.d);
                assert!(met.len() < 9, "{i}: endless {met:?}");
            }
            let want = if side > 0.0 { [TOP, BOTTOM, PLANE] } else { [PLANE, BOTTOM, TOP] };
            assert_eq!(met, want, "{i}: from {distance} away: {ray:?}");
        }
    }
}

#[test]
fn upright_slab_inside() {
    check_order(&Transform::IDENTITY, false, 0.0, 1);
    check_order(&Transform::IDENTITY, true, 0.0, 2);
}

#[test]
fn upright_slab_from_afar() {
    check_from_afar(&Transform::IDENTITY, false, 3);
    check_from_afar(&Transform::IDENTITY, true, 4);
}

/// Shifted and lying in another axis: no zero coordinate to help.
#[test]
fn shifted_slab() {
    let t = Transform::translate(0.0, 0.0, 3.0) * Transform::rotate(90.0, [1.0, 0.0, 0.0]).unwrap();
    check_order(&t, false, 1e-6, 5);
    check_from_afar(&t, true, 6);
}

#[test]
fn slab_tilted_by_17_degrees() {
    let t = Transform::rotate(17.0, [0.2, 1.0, 0.0]).unwrap();
    // a scattering point is itself rounded to 0.00024, so it keeps that distance from the faces
    check_order(&t, false, 1e-3, 7);
    check_order(&t, true, 1e-3, 8);
    check_from_afar(&t, false, 9);
    check_from_afar(&t, true, 10);
}
