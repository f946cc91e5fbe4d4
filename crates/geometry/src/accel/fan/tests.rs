//! Fans against single queries: every answer must be the same, by every instruction set.

#[path = "../../../tests/common/mod.rs"]
mod common;

use super::*;
use crate::{
    BilinearMesh, BuildOptions, CurveKind, CurveSegment, Curves, Disk, Dispatch, InstanceDesc, Motion, Shape,
    ShapeGroup, Sphere, Transform, TriangleMesh, segment,
};
use common::{Rng, meshes, soup};
use tyndall_base::Vec3;
use tyndall_base::vec::vec3;

const MASKS: [[u8; 2]; 5] = [[1, 2], [1, 0], [0, 2], [3, 4], [2, 3]];

/// The walk itself, whatever the entry would choose.
fn walked(ask: &Ask<'_>, portable: bool) -> Fan {
    let mut fan = Fan::default();
    let open = match ask.accel.isa {
        #[cfg(target_arch = "x86_64")]
        // SAFETY: the value exists only where the processor has these instructions.
        Isa::Avx2(l) if !portable => unsafe { walk_avx2(l, ask, &mut fan) },
        #[cfg(target_arch = "x86_64")]
        // SAFETY: as above.
        Isa::Avx512(l) if !portable => unsafe { walk_avx2(l.narrow(), ask, &mut fan) },
        _ => walk_portable(ask, &mut fan),
    };
    ask.alone(open, &mut fan);
    fan
}

/// Distance, shape and primitive.
type Place = (f32, u32, u32);

/// Whether there are any, and where, if their order is certain.
fn place(mut notes: Notes) -> (bool, Option<Vec<Place>>) {
    let any = !notes.is_empty();
    (any, notes.in_order().map(|hits| hits.iter().map(|h| (h.t, h.shape, h.prim)).collect()))
}

/// All ways against single queries; returns how many rays are blocked or noted.
fn check(accel: &Accel, rays: &[Ray], [blocking, noted]: [u8; 2]) -> u32 {
    if rays.is_empty() {
        return 0;
    }
    let ask = Ask { accel, rays, blocking, noted };
    let fan = accel.occluded_fan(rays, blocking, noted);
    for fan in [fan, walked(&ask, false), walked(&ask, true)] {
        for (i, ray) in rays.iter().enumerate() {
            let blocked = accel.occluded_masked(ray, blocking);
            assert_eq!(fan.blocked >> i & 1 != 0, blocked, "{i} of {rays:?}");
            let mut want = Notes::NONE;
            accel.occluded_filtered(ray, noted, |hit| {
                want.push(*hit);
                false
            });
            let (note, want) = (place(fan.noted[i]), place(want));
            assert!(blocked || note == want, "{i} of {rays:?}: {note:?} {want:?}");
        }
        let beyond = !0u32 << rays.len();
        assert_eq!(u32::from(fan.blocked) & beyond, 0);
        assert!(fan.noted[rays.len()..].iter().all(Notes::is_empty));
    }
    let noted = (0..MOST).filter(|&i| !fan.noted[i].is_empty()).fold(0, |bits, i| bits | 1 << i);
    (fan.blocked | noted).count_ones()
}

/// Up to 16 rays from within `spread` of `x` to `y`; some stray.
fn fan_of(rng: &mut Rng, x: Vec3, y: Vec3, spread: f32, n: usize) -> Vec<Ray> {
    let mut rays = Vec::new();
    while rays.len() < n {
        let near = x + rng.in_cube() * spread;
        let end = y + rng.in_cube() * (spread * 1e-3);
        let Some(mut ray) = segment(near, end, 0.3) else { return rays };
        match rng.below(200) {
            0 => ray.t_max = f32::INFINITY,
            1 => ray.t_max *= 1e-4,
            2 => ray.d = rng.direction(),
            3 => ray.d.x = -0.0,
            _ => {}
        }
        rays.push(ray);
    }
    rays
}

fn masked(shape: impl Into<ShapeGroup>, mask: u8) -> ShapeGroup {
    ShapeGroup { mask, ..shape.into() }
}

fn built(groups: Vec<ShapeGroup>, objects: &[Vec<u32>], instances: Vec<InstanceDesc>) -> Accel {
    Accel::build(groups, objects, instances, &BuildOptions { dispatch: Dispatch::Detect }).unwrap()
}

/// Patches, some of them curved.
fn patches() -> BilinearMesh {
    let mut rng = Rng::new(77);
    let mut p = vec![];
    for i in 0..60 {
        let (at, u, v) = (rng.in_cube(), rng.in_cube() * 0.3, rng.in_cube() * 0.3);
        let bend = if i % 3 == 0 { rng.in_cube() * 0.2 } else { Vec3::ZERO };
        p.extend([at, at + u, at + v, at + u + v + bend]);
    }
    BilinearMesh::new((0..60).map(|i| [4 * i, 4 * i + 1, 4 * i + 2, 4 * i + 3]).collect(), p).unwrap()
}

/// Everything that there is, under several masks.
fn menagerie() -> Accel {
    let points = [0.0, 0.3, 0.5, 0.9].map(|x| vec3(x, 0.2 - x, 0.1));
    let normals = [vec3(0.0, 0.0, 1.0), vec3(0.0, 0.6, 0.8)];
    let curve = CurveSegment { points, width: [0.1, 0.05], normals };
    let groups = vec![
        masked(Shape::Triangles(soup(60, 0.4, 1)), 1),
        masked(Shape::Triangles(soup(60, 0.4, 2)), 2),
        masked(Shape::Triangles(soup(20, 0.4, 3)), 3),
        masked(Shape::Bilinear(patches()), 1),
        masked(Shape::Sphere(Sphere::whole([0.2, 0.1, 0.0], 0.3).unwrap()), 1),
        masked(Shape::Sphere(Sphere::whole([-0.5, 0.1, 0.3], 0.4).unwrap()), 2),
        masked(Shape::Disk(Disk::new(Transform::translate(0.0, 0.0, 0.5), 0.0, 0.7, 0.0, 360.0).unwrap()), 2),
        masked(
            Shape::Curves(Curves::new(Transform::IDENTITY, CurveKind::Cylinder, vec![curve], 3).unwrap()),
            1,
        ),
        masked(Shape::Triangles(soup(50, 0.5, 4)), 1),
        masked(Shape::Sphere(Sphere::whole([0.0, 0.0, 0.0], 0.2).unwrap()), 2),
    ];
    let turn = Transform::rotate(50.0, [1.0, 0.4, 0.2]).unwrap();
    let place = Transform::translate(0.4, -0.6, 0.2) * turn;
    let motion = Motion::new(Transform::IDENTITY, place, [0.0, 1.0]).unwrap();
    let moving = InstanceDesc { object: 0, to_world: Transform::IDENTITY, motion: Some(Box::new(motion)) };
    built(groups, &[vec![8, 9]], vec![InstanceDesc::at_rest(0, place), moving])
}

#[test]
fn fans_in_a_box_answer_as_single_rays_do() {
    let mesh = meshes::cornell_box();
    let (centre, half) = (Vec3::splat(280.0), Vec3::splat(290.0));
    let mut pane = soup(30, 0.5, 9).positions().to_vec();
    pane.iter_mut().for_each(|p| *p = *p * 280.0 + centre);
    let pane = TriangleMesh::new((0..30).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(), pane).unwrap();
    let accel =
        built(vec![masked(Shape::Triangles(mesh), 1), masked(Shape::Triangles(pane), 2)], &[], vec![]);
    let (mut rng, mut met) = (Rng::new(1), 0);
    for i in 0..6000 {
        let at = |rng: &mut Rng| centre + rng.in_cube() * half.x;
        let (mut x, mut y) = (at(&mut rng), at(&mut rng));
        // on the floor, the back, the floor's edge
        match i % 4 {
            0 => (x.y, y.z) = (0.0, 559.0),
            1 => (x.y, y.y) = (0.0, 0.0),
            2 => (x.y, x.z, y.x) = (0.0, 559.0, 556.0),
            _ => {}
        }
        let spread = [0.0, 1e-3, 1.0, 20.0, 300.0][i % 5];
        let n = 1 + rng.below(16) as usize;
        let rays = fan_of(&mut rng, x, y, spread, n);
        met += check(&accel, &rays, MASKS[i % 3]);
    }
    assert!(met > 10_000, "{met} met say little");
}

#[test]
fn fans_through_all_kinds_of_shapes_answer_as_single_rays_do() {
    let accel = menagerie();
    let (mut rng, mut met) = (Rng::new(2), 0);
    for i in 0..12_000 {
        let (x, y) = (rng.in_cube() * 1.2, rng.in_cube() * 1.2);
        let spread = [1e-4, 0.02, 0.1, 0.5, 1.0][i % 5];
        let n = 1 + rng.below(16) as usize;
        let rays = fan_of(&mut rng, x, y, spread, n);
        met += check(&accel, &rays, MASKS[i % 5]);
    }
    assert!(met > 40_000, "{met} met say little");
}

/// Rays through corners and edges, within planes, along axes, and that end at a hit to the last bit.
#[test]
fn fans_that_graze_answer_as_single_rays_do() {
    let sphere = meshes::cave(4);
    let grid = meshes::cornell_box();
    for (seed, mesh) in [(3, sphere), (4, grid), (5, soup(4000, 0.1, 6)), (6, soup(200, 1.0, 7))] {
        let (p, indices) = (mesh.positions().to_vec(), mesh.indices().to_vec());
        let accel = built(vec![masked(Shape::Triangles(mesh), 1)], &[], vec![]);
        let size = accel.bounds().extent().max_component();
        let (mut rng, mut met) = (Rng::new(seed), 0);
        for i in 0..2500 {
            let on = |rng: &mut Rng| {
                let [a, b, c] = indices[rng.below(indices.len() as u64) as usize].map(|k| p[k as usize]);
                let w = [0.0, 1.0, 0.5, rng.unit()][rng.below(4) as usize];
                let edge = a + (b - a) * w;
                if rng.below(3) == 0 { edge + (c - edge) * rng.signed() } else { edge }
            };
            let (x, mut y) = (on(&mut rng), on(&mut rng));
            match i % 8 {
                0 => y = vec3(y.x, x.y, x.z),
                1 => y = vec3(x.x, y.y, x.z),
                2 => y = vec3(y.x, y.y, x.z),
                _ => {}
            }
            let spread = size * [0.0, 1e-7, 1e-3, 0.05][i % 4];
            let n = 1 + rng.below(16) as usize;
            let mut rays = fan_of(&mut rng, x, y, spread, n);
            for ray in &mut rays {
                let far = Ray { t_max: f32::INFINITY, ..*ray };
                if let (true, Some(hit)) = (rng.below(2) == 0, accel.intersect(&far)) {
                    ray.t_max = [hit.t, hit.t.next_down(), hit.t.next_up()][rng.below(3) as usize];
                }
            }
            met += check(&accel, &rays, [1, 0]);
        }
        assert!(met > 2000, "{met} met say little");
    }
}

#[test]
fn nothing_lies_on_no_rays() {
    assert_eq!(menagerie().occluded_fan(&[], 1, 2), Fan::default());
    let empty = built(vec![], &[], vec![]);
    let ray = Ray { t_max: 2.0, ..Ray::new(Vec3::ZERO, vec3(0.0, 0.6, 0.8)) };
    assert_eq!(empty.occluded_fan(&[ray; 16], 1, 2), Fan::default());
}
