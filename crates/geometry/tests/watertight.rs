//! Closed meshes do not leak: rays from inside aimed at vertices, edges and near them always meet something.

mod common;

use common::{Rng, accel, build, meshes};
use tyndall_base::Vec3;
use tyndall_base::vec::vec3;
use tyndall_geometry::{
    Accel, BilinearMesh, BuildOptions, Dispatch, InstanceDesc, Ray, Shape, Transform, TriangleMesh,
};

/// A point of a random triangle: a vertex, a point of an edge, or within a few ulps of one.
fn target(mesh: &TriangleMesh, rng: &mut Rng) -> Vec3 {
    let prim = rng.below(mesh.indices().len() as u64) as u32;
    let [a, b, _] = mesh.corners(prim);
    let q = if rng.below(4) == 0 { a } else { a + (b - a) * rng.unit() };
    let mut nudge = |x: f32| match rng.below(4) {
        0 => x.next_up(),
        1 => x.next_down(),
        _ => x,
    };
    vec3(nudge(q.x), nudge(q.y), nudge(q.z))
}

fn leaks(
    accel: &Accel,
    mesh: &TriangleMesh,
    rays: usize,
    seed: u64,
    origin: impl Fn(&mut Rng) -> Vec3,
) -> usize {
    let mut rng = Rng::new(seed);
    let mut leak = |_: &usize| {
        let o = origin(&mut rng);
        let v = target(mesh, &mut rng) - o;
        // unit and plain directions, and some along an axis plane
        let d = if rng.below(2) == 0 { v.normalize() } else { v };
        accel.intersect(&Ray::new(o, d)).is_none() || !accel.occluded(&Ray::new(o, d))
    };
    (0..rays).filter(|i| leak(i)).count()
}

#[test]
fn an_icosphere_holds_its_rays() {
    let (faces, p) = meshes::icosphere(3);
    let mesh = TriangleMesh::new(faces, p).unwrap();
    let a = accel(mesh.clone());
    assert_eq!(leaks(&a, &mesh, 1_000_000, 1, |r| r.in_cube() * 0.5), 0);
    // from vertices to vertices and along edges, and from the symmetric centre
    assert_eq!(leaks(&a, &mesh, 300_000, 2, |_| Vec3::ZERO), 0);
}

#[test]
fn a_cave_holds_its_rays() {
    let mesh = meshes::cave(5);
    let a = accel(mesh.clone());
    assert_eq!(leaks(&a, &mesh, 1_000_000, 3, |r| r.in_cube() * 0.4), 0);
}

#[test]
fn the_portable_path_holds_too() {
    let mesh = meshes::cave(4);
    let groups = vec![Shape::Triangles(mesh.clone()).into()];
    let a = Accel::build(groups, &[], vec![], &BuildOptions { dispatch: Dispatch::Portable }).unwrap();
    assert_eq!(leaks(&a, &mesh, 50_000, 4, |r| r.in_cube() * 0.4), 0);
}

/// A long box far from the origin, turned, so that every coordinate is rounded.
#[test]
fn a_long_tilted_box_far_away_holds_its_rays() {
    let turn = Transform::translate(3000.0, -1500.0, 700.0)
        * Transform::rotate(17.0, [0.3, 1.0, 0.2]).unwrap()
        * Transform::scale(4000.0, 1.0, 30.0).unwrap();
    let corner = |i: u32| {
        let s = |bit: u32| if i & bit == 0 { -1.0 } else { 1.0 };
        turn.point(vec3(s(1), s(2), s(4)))
    };
    let quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    let faces = quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect();
    let mesh = TriangleMesh::new(faces, (0..8).map(corner).collect()).unwrap();
    let a = accel(mesh.clone());
    let inside = |r: &mut Rng| turn.point(r.in_cube() * 0.9);
    assert_eq!(leaks(&a, &mesh, 400_000, 5, inside), 0);
}

/// Six patches in pbrt's corner order, axis-aligned and turned: flat, so met as triangles.
#[test]
fn a_box_of_patches_holds_its_rays() {
    for degrees in [0.0, 17.0] {
        let turn =
            Transform::rotate(degrees, [0.2, 1.0, 0.4]).unwrap() * Transform::scale(3.0, 1.0, 2.0).unwrap();
        let corner = |i: u32| {
            let s = |bit: u32| if i & bit == 0 { -1.0 } else { 1.0 };
            turn.point(vec3(s(1), s(2), s(4)))
        };
        let patches =
            vec![[0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 4, 5], [2, 3, 6, 7], [0, 2, 4, 6], [1, 3, 5, 7]];
        let p: Vec<Vec3> = (0..8).map(corner).collect();
        let mesh = BilinearMesh::new(patches, p.clone()).unwrap();
        let a = build(vec![Shape::Bilinear(mesh).into()]);
        assert_eq!(a.stats().triangles, 12, "all patches are flat");
        let edges = vec![[0, 1, 3], [2, 6, 4], [5, 7, 1], [7, 6, 4], [1, 3, 7], [4, 5, 0]];
        let edges = TriangleMesh::new(edges, p).unwrap();
        assert_eq!(leaks(&a, &edges, 300_000, 6, |r| turn.point(r.in_cube() * 0.99)), 0);
    }
}

/// A closed surface of patches that are not flat.
#[test]
fn a_ball_of_curved_patches_holds_its_rays() {
    let n = 12u32;
    let (mut p, mut patches) = (vec![], vec![]);
    for face in 0..6u32 {
        let first = p.len() as u32;
        for i in 0..=n {
            for j in 0..=n {
                let (a, b) = (2.0 * i as f32 / n as f32 - 1.0, 2.0 * j as f32 / n as f32 - 1.0);
                let s = if face % 2 == 0 { 1.0 } else { -1.0 };
                let q = [vec3(s, a, b), vec3(a, s, b), vec3(a, b, s)][face as usize / 2];
                let q = q.normalize();
                p.push(q * (1.0 + 0.1 * tyndall_base::math::sin(7.0 * q.x + 5.0 * q.y * q.z)));
            }
        }
        for i in 0..n {
            for j in 0..n {
                let k = first + i * (n + 1) + j;
                patches.push([k, k + n + 1, k + 1, k + n + 2]);
            }
        }
    }
    let faces = patches.iter().flat_map(|q: &[u32; 4]| [[q[0], q[1], q[3]], [q[2], q[0], q[3]]]).collect();
    let edges = TriangleMesh::new(faces, p.clone()).unwrap();
    let a = build(vec![Shape::Bilinear(BilinearMesh::new(patches, p).unwrap()).into()]);
    assert!(a.stats().others > 600, "most patches are curved: {:?}", a.stats());
    assert_eq!(leaks(&a, &edges, 300_000, 7, |r| r.in_cube() * 0.5), 0);
}

#[test]
fn an_instanced_cave_holds_its_rays() {
    let mesh = meshes::cave(4);
    let to_world = Transform::translate(500.0, -200.0, 90.0)
        * Transform::rotate(40.0, [1.0, 2.0, 3.0]).unwrap()
        * Transform::scale(3.0, -0.5, 10.0).unwrap();
    let groups = vec![Shape::Triangles(mesh.clone()).into()];
    let instances = vec![InstanceDesc::at_rest(0, to_world)];
    let a = Accel::build(groups, &[vec![0]], instances, &BuildOptions::default()).unwrap();
    let p = mesh.positions().iter().map(|&q| to_world.point(q)).collect();
    let placed = TriangleMesh::new(mesh.indices().to_vec(), p).unwrap();
    assert_eq!(leaks(&a, &placed, 500_000, 8, |r| to_world.point(r.in_cube() * 0.4)), 0);
}

/// Rays within the planes in which faces lie and boxes touch.
#[test]
fn rays_along_axes_and_faces_are_not_lost() {
    // a cube of 8 corners with its faces split at the origin of coordinates
    let n = 4;
    let (mut p, mut f) = (vec![], vec![]);
    for face in 0..6usize {
        let first = p.len() as u32;
        let s = if face % 2 == 0 { 1.0 } else { -1.0 };
        for i in 0..=n {
            for j in 0..=n {
                let (a, b) = (i as f32 * 0.5 - 1.0, j as f32 * 0.5 - 1.0);
                p.push([vec3(s, a, b), vec3(a, s, b), vec3(a, b, s)][face / 2]);
            }
        }
        for i in 0..n {
            for j in 0..n {
                let k = first + i * (n + 1) + j;
                f.extend([[k, k + n + 1, k + n + 2], [k, k + n + 2, k + 1]]);
            }
        }
    }
    let a = accel(TriangleMesh::new(f, p).unwrap());
    let mut lost = 0;
    let steps = [-1.0f32, -0.5, 0.0, 0.5, 0.999_999_9, 1.0];
    for x in steps.map(|x| x * 0.999_999_9) {
        for y in steps {
            for axis in 0..3 {
                for sign in [1.0f32, -1.0, 0.0] {
                    let pick = |k: usize| {
                        if k == axis {
                            sign
                        } else if sign == 0.0 {
                            1.0
                        } else {
                            0.0
                        }
                    };
                    let d = vec3(pick(0), pick(1), pick(2));
                    let o = [vec3(0.0, x, y), vec3(x, 0.0, y), vec3(x, y, 0.0)][axis];
                    let inside = o.abs().max_component() < 1.0;
                    lost += u32::from(inside && a.intersect(&Ray::new(o, d)).is_none());
                    lost += u32::from(inside && a.intersect(&Ray::new(o, -d)).is_none());
                }
            }
        }
    }
    assert_eq!(lost, 0);
}
