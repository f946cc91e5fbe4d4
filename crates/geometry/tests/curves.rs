//! Curves: against dense chains of points, joints, kinds, transforms.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod common;

use common::{Rng, build};
use tyndall_base::Vec3;
use tyndall_base::vec::vec3;
use tyndall_geometry::{CurveKind, CurveSegment, Curves, Ray, Shape, ShapeGroup, Transform};

const POINTS: [[f32; 3]; 4] = [[-1.0, -0.5, 0.0], [-0.3, 1.1, 0.4], [0.4, -1.2, -0.3], [1.0, 0.6, 0.2]];

fn segment(width: [f32; 2]) -> CurveSegment {
    CurveSegment {
        points: POINTS.map(Vec3::from),
        width,
        normals: [vec3(0.0, 0.0, 1.0), vec3(0.0, 0.6, 0.8)],
    }
}

fn curve(kind: CurveKind, split: u32) -> ShapeGroup {
    Shape::Curves(Curves::new(Transform::IDENTITY, kind, vec![segment([0.08, 0.02])], split).unwrap()).into()
}

fn at(u: f64) -> [f64; 3] {
    let s = 1.0 - u;
    let w = [s * s * s, 3.0 * s * s * u, 3.0 * s * u * u, u * u * u];
    std::array::from_fn(|k| (0..4).map(|i| w[i] * f64::from(POINTS[i][k])).sum())
}

/// Distance of a parallel ray along -z from the axis, found by brute force, the width there, and whether it is an end.
fn distance(x: f64, y: f64) -> (f64, f64, bool) {
    let n = 1000;
    (0..=n)
        .map(|i| {
            let u = f64::from(i) / f64::from(n);
            let p = at(u);
            ((p[0] - x).hypot(p[1] - y), 0.08 * (1.0 - u) + 0.02 * u, i == 0 || i == n)
        })
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .unwrap()
}

#[test]
fn rays_meet_the_band_and_nothing_else() {
    let mut rng = Rng::new(5);
    let mut hits = 0;
    for split in [1, 8] {
        let a = build(vec![curve(CurveKind::Flat, split)]);
        for _ in 0..1500 {
            // near the axis, where it is decided
            let p = at(f64::from(rng.unit()));
            let off = |r: f32| f64::from(0.1 * (r - 0.5));
            let (x, y) = (p[0] + off(rng.unit()), p[1] + off(rng.unit()));
            let (d, width, at_end) = distance(x, y);
            // the axis is followed to a twentieth of the width
            if (d - 0.5 * width).abs() < 0.1 * 0.08 || at_end {
                continue;
            }
            let ray = Ray::new(vec3(x as f32, y as f32, 5.0), vec3(0.0, 0.0, -1.0));
            let hit = a.intersect(&ray);
            assert_eq!(hit.is_some(), d < 0.5 * width, "{x} {y}: {d} of {width}");
            assert_eq!(a.occluded(&ray), hit.is_some());
            if let Some(hit) = hit {
                hits += 1;
                let s = a.surface(&ray, &hit);
                assert!((s.p - ray.at(hit.t)).length() < 1e-4 && s.ng.dot(ray.d) < -0.1, "{s:?}");
                let v = f64::from(s.uv.y);
                // v grows along dp/dv
                let step = s.dpdv * 0.2;
                let next = Ray::new(ray.o + step, ray.d);
                if let Some(hit) = a.intersect(&next) {
                    let more = a.surface(&next, &hit).uv.y - s.uv.y;
                    assert!((0.0..0.4).contains(&more), "{more} at {v}");
                }
                assert!(((v - 0.5).abs() * width - d).abs() < 0.15 * width && s.dpdu.length() > 0.0);
                // whatever leaves does not meet the band again
                let up = s.spawn(vec3(0.0, 0.1, 1.0).normalize());
                assert!(a.intersect(&up).is_none());
            }
        }
    }
    assert!(hits > 500, "{hits}");
}

#[test]
fn cylinders_bulge_and_ribbons_narrow() {
    let straight = |kind, normals| {
        let points = [0.0, 1.0, 2.0, 3.0].map(|x| vec3(x, 0.0, 0.0));
        let segment = CurveSegment { points, width: [0.2, 0.2], normals };
        let curves = Curves::new(Transform::IDENTITY, kind, vec![segment], 4).unwrap();
        build(vec![Shape::Curves(curves).into()])
    };
    let up = vec3(0.0, 0.0, 1.0);
    let down = |y: f32| Ray::new(vec3(1.3, y, 2.0), vec3(0.0, 0.0, -1.0));
    let a = straight(CurveKind::Cylinder, [up, up]);
    for y in [-0.09f32, -0.03, 0.0, 0.06] {
        let ray = down(y);
        let s = a.surface(&ray, &a.intersect(&ray).unwrap());
        // pbrt turns the normal evenly with v
        let tilt = (y / 0.2) * std::f32::consts::PI;
        assert!((s.ns - vec3(0.0, tilt.sin(), tilt.cos())).length() < 1e-3, "{y}: {s:?}");
        assert!((s.uv.x - 1.3 / 3.0).abs() < 1e-4);
        // v grows along dp/dv, which is a tangent
        let grows = (s.uv.y - 0.5) * y;
        assert!(s.dpdv.y * grows >= 0.0 && s.dpdv.dot(s.ns).abs() < 1e-4, "{y}: {s:?}");
    }
    // a ribbon seen at 60 degrees from its normal is half as wide
    let slanted = vec3(0.0, 0.75f32.sqrt(), 0.5);
    let a = straight(CurveKind::Ribbon, [slanted, slanted]);
    assert!(a.intersect(&down(0.045)).is_some() && a.intersect(&down(0.055)).is_none());
    let ray = down(0.0);
    let s = a.surface(&ray, &a.intersect(&ray).unwrap());
    assert!((s.ng - slanted).length() < 1e-3, "{s:?}");
}

#[test]
fn transforms_carry_curves_along() {
    let t = Transform::translate(3.0, -2.0, 0.5) * Transform::rotate(40.0, [1.0, 2.0, 3.0]).unwrap();
    let plain = build(vec![curve(CurveKind::Flat, 4)]);
    let moved = Curves::new(t, CurveKind::Flat, vec![segment([0.08, 0.02])], 4).unwrap();
    let moved = build(vec![Shape::Curves(moved).into()]);
    let mut rng = Rng::new(8);
    let mut hits = 0;
    for _ in 0..3000 {
        let p = at(f64::from(rng.unit())).map(|x| x as f32);
        let o = vec3(p[0] + 0.02, p[1] - 0.01, 4.0);
        let ray = Ray::new(o, (Vec3::from(p) - o + vec3(0.03 * (rng.unit() - 0.5), 0.0, 0.0)).normalize());
        let there = Ray::new(t.point(ray.o), t.vector(ray.d));
        let (a, b) = (plain.intersect(&ray), moved.intersect(&there));
        if let (Some(a), Some(b)) = (&a, &b) {
            hits += 1;
            assert!((a.t - b.t).abs() < 1e-3, "{a:?} {b:?}");
        }
    }
    assert!(hits > 1500, "{hits}");
}

/// A ray that leaves starts off the band along its normal, however close to a coordinate plane that is: a strip just
/// above a floor does not throw its rays below the floor.
#[test]
fn rays_leave_along_the_normal() {
    let points = [[-1.0, 0.15, 0.0], [-0.3, 0.15, 0.1], [0.4, 0.15, 0.1], [1.0, 0.15, 0.0]].map(Vec3::from);
    let normals = [vec3(0.0, 0.0, 1.0); 2];
    let strip = CurveSegment { points, width: [0.2; 2], normals };
    let turned = Transform::rotate(45.0, [0.0, 1.0, 0.0]).unwrap();
    for to_world in [Transform::IDENTITY, turned] {
        let band = Curves::new(to_world, CurveKind::Flat, vec![strip], 1).unwrap();
        let a = build(vec![Shape::Curves(band).into()]);
        let mut rng = Rng::new(3);
        for _ in 0..200 {
            // level but for a hair's breadth, so that a small part of the normal points down
            let o = to_world.point(vec3(rng.unit() - 0.5, 0.16, 3.0));
            let d = to_world.vector(vec3(0.02 * (rng.unit() - 0.5), 1e-3, -1.0)).normalize();
            let ray = Ray::new(o, d);
            let hit = a.intersect(&ray).expect("the strip is wide");
            let s = a.surface(&ray, &hit);
            let out = s.spawn(-d).o;
            assert!(out.y > 0.1, "{out:?} from {:?}", s.p);
            let off = (out - s.p).length();
            assert!((0.199..0.201).contains(&off), "{off}");
            assert!((out - s.p).normalize().dot(-d) > 0.99);
        }
    }
}
