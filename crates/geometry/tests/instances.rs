//! An instance is its object baked into the world.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod common;

use common::{Rng, build, meshes, soup};
use tyndall_base::vec::vec3;
use tyndall_geometry::{
    Accel, BuildOptions, Disk, Dispatch, GeometryError, InstanceDesc, NO_INSTANCE, Ray, Shape, ShapeGroup,
    Sphere, Transform, TriangleMesh,
};

fn placements() -> Vec<Transform> {
    let turn = |angle: f64| Transform::rotate(angle, [1.0, 0.5, -0.3]).unwrap();
    vec![
        Transform::translate(0.3, 0.2, -0.1) * turn(20.0),
        Transform::translate(-0.8, 0.1, 0.4) * turn(-75.0) * Transform::scale(0.5, 0.5, 0.5).unwrap(),
        Transform::translate(0.2, -0.9, 0.0) * Transform::scale(0.4, -0.7, 1.1).unwrap() * turn(200.0),
    ]
}

fn bake(mesh: &TriangleMesh, t: &Transform) -> TriangleMesh {
    let p = mesh.positions().iter().map(|&p| t.point(p)).collect();
    TriangleMesh::new(mesh.indices().to_vec(), p).unwrap()
}

fn instanced(dispatch: Dispatch) -> Accel {
    let groups: Vec<ShapeGroup> = vec![
        Shape::Triangles(soup(400, 0.3, 1)).into(),
        Shape::Sphere(Sphere::whole([0.2, 0.1, 0.0], 0.4).unwrap()).into(),
        Shape::Triangles(soup(200, 0.2, 2)).into(),
    ];
    let instances = placements().into_iter().map(|to_world| InstanceDesc::at_rest(0, to_world)).collect();
    Accel::build(groups, &[vec![0, 1]], instances, &BuildOptions { dispatch }).unwrap()
}

/// Group 3 i: triangles of placement i; 3 i + 1: its sphere; the last: the world's own triangles.
fn baked() -> Accel {
    let mut groups: Vec<ShapeGroup> = vec![];
    for t in placements() {
        groups.push(Shape::Triangles(bake(&soup(400, 0.3, 1), &t)).into());
        let sphere = Sphere::new(t * Transform::translate(0.2, 0.1, 0.0), 0.4, -0.4, 0.4, 360.0).unwrap();
        groups.push(Shape::Sphere(sphere).into());
    }
    groups.push(Shape::Triangles(soup(200, 0.2, 2)).into());
    build(groups)
}

#[test]
fn instances_equal_baked_geometry() {
    let (a, b) = (instanced(Dispatch::Detect), baked());
    let mut rng = Rng::new(3);
    let (mut met, mut differ) = (0, 0);
    for _ in 0..20_000 {
        let ray = rng.ray();
        let (Some(h), Some(g)) = (a.intersect(&ray), b.intersect(&ray)) else {
            differ += u32::from(a.intersect(&ray).is_some() != b.intersect(&ray).is_some());
            continue;
        };
        met += 1;
        let shape = if h.instance == NO_INSTANCE { 6 } else { 2 * h.instance + h.shape };
        if (shape, h.prim) != (g.shape, g.prim) {
            differ += 1;
            continue;
        }
        let (s, t) = (a.surface(&ray, &h), b.surface(&ray, &g));
        assert!((s.p - t.p).length() < 3e-6, "{s:?} {t:?}");
        // an instance's normal is not turned by a mirroring placement; a baked mesh's winding is
        assert!(s.ng.abs_dot(t.ng) > 1.0 - 1e-4, "{s:?} {t:?}");
        assert!((s.uv.x - t.uv.x).abs() < 1e-3 || h.shape == 1);
        // no ray meets again what it leaves
        let away = a.intersect(&s.spawn(ray.d));
        assert!(
            away.is_none_or(
                |n| (n.instance, n.shape, n.prim) != (h.instance, h.shape, h.prim) || h.shape == 1
            )
        );
    }
    // baking rounds corners, which moves a silhouette by an ulp
    assert!(met > 5_000 && differ <= 3, "{met} {differ}");
}

#[test]
fn instances_give_the_same_bits_on_both_paths() {
    let (a, b) = (instanced(Dispatch::Detect), instanced(Dispatch::Portable));
    let mut rng = Rng::new(5);
    for _ in 0..20_000 {
        let ray = rng.ray();
        assert_eq!(a.intersect(&ray), b.intersect(&ray));
        assert_eq!(a.occluded(&ray), b.occluded(&ray));
    }
}

#[test]
fn nothing_is_met_where_the_mask_says_so() {
    let plane = |z: f32, mask: u8| {
        let p = [(-1.0, -1.0), (1.0, -1.0), (0.0, 1.0)].map(|(x, y)| vec3(x, y, z)).to_vec();
        ShapeGroup { mask, ..Shape::Triangles(TriangleMesh::new(vec![[0, 1, 2]], p).unwrap()).into() }
    };
    let ball = ShapeGroup { mask: 4, ..Shape::Sphere(Sphere::whole([0.0, 0.0, 3.0], 0.2).unwrap()).into() };
    let a = build(vec![plane(1.0, 1), plane(2.0, 2), ball]);
    let ray = Ray::new(vec3(0.0, 0.0, 0.0), vec3(0.0, 0.0, 1.0));
    let shape = |mask| a.intersect_masked(&ray, mask).map(|h| h.shape);
    assert_eq!(
        [shape(1), shape(2), shape(3), shape(4), shape(6), shape(8)],
        [Some(0), Some(1), Some(0), Some(2), Some(1), None]
    );
    assert!(a.occluded_masked(&ray, 4) && !a.occluded_masked(&ray, 8));
    let other = a.intersect_filtered(&ray, 0xff, |h| h.shape != 0);
    assert_eq!(other.map(|h| h.shape), Some(1));
    assert!(!a.occluded_filtered(&ray, 1, |h| h.shape != 0));
}

#[test]
fn references_to_nothing_are_refused() {
    let group = || -> ShapeGroup {
        Shape::Disk(Disk::new(Transform::IDENTITY, 0.0, 1.0, 0.0, 360.0).unwrap()).into()
    };
    let options = BuildOptions::default();
    let no_shape = Accel::build(vec![group()], &[vec![1]], vec![], &options);
    assert!(matches!(no_shape, Err(GeometryError::NoSuch { index: 1, count: 1, .. })));
    let lost = InstanceDesc::at_rest(2, Transform::IDENTITY);
    let no_object = Accel::build(vec![group()], &[vec![0]], vec![lost], &options);
    assert!(matches!(no_object, Err(GeometryError::NoSuch { index: 2, count: 1, .. })));
}

#[test]
fn empty_scenes_and_empty_objects_are_met_by_nothing() {
    let ray = Ray::new(vec3(0.0, 0.0, 0.0), vec3(0.0, 0.0, 1.0));
    let empty = build(vec![]);
    assert!(empty.intersect(&ray).is_none() && !empty.occluded(&ray) && empty.bounds().is_empty());
    let nothing = InstanceDesc::at_rest(0, Transform::IDENTITY);
    let a = Accel::build(vec![], &[vec![]], vec![nothing], &BuildOptions::default()).unwrap();
    assert!(a.intersect(&ray).is_none());
}

/// The tree, and so every hit, is the same for one thread and for many.
#[test]
fn the_build_does_not_depend_on_threads() {
    let mesh = meshes::cave(6);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| common::accel(mesh.clone()))
    };
    let (one, many) = (on(1), on(7));
    assert_eq!(one.fingerprint(), many.fingerprint());
    assert_ne!(one.fingerprint(), common::accel(meshes::cave(5)).fingerprint());
}
