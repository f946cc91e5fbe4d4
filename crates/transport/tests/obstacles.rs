//! What lies on a fan of shadow rays is what lies on each of them.

use tyndall_base::vec::{Vec3, vec3};
use tyndall_geometry::{Accel, BuildOptions, Shape, ShapeGroup, TriangleMesh, segment};
use tyndall_transport::scene::{BOUNDARY, OPAQUE, Obstacles, ShapeBinding};
use tyndall_transport::texture::FloatTexture;
use tyndall_transport::{MaterialId, Scene};

/// Fractional parts of multiples of irrationals, from -1 to 1.
fn point(i: u32) -> Vec3 {
    let at = |irrational: f64| ((f64::from(i) * irrational).fract() * 2.0 - 1.0) as f32;
    vec3(at(0.819_172_513_396_164_4), at(0.671_043_606_703_789_2), at(0.549_700_477_901_970_3))
}

fn triangles(first: u32) -> Shape {
    let p = (0..40).flat_map(|i| [0, 1, 2].map(|k| point(first + i) + point(first + 3 * i + k) * 0.4));
    let indices = (0..40).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Shape::Triangles(TriangleMesh::new(indices, p.collect()).expect("finite vertices"))
}

fn scene(has_boundaries: bool, alpha: Option<f32>) -> Scene {
    let masks: &[u8] = if has_boundaries { &[OPAQUE, BOUNDARY] } else { &[OPAQUE] };
    let group = |(i, &mask): (usize, &u8)| ShapeGroup { mask, ..triangles(500 * i as u32).into() };
    let groups = masks.iter().enumerate().map(group).collect();
    let binding = |&mask: &u8| ShapeBinding {
        material: if mask == OPAQUE { MaterialId(0) } else { MaterialId::INTERFACE },
        boundary: None,
        first_light: None,
        alpha: alpha.map(FloatTexture::Constant),
    };
    Scene {
        accel: Accel::build(groups, &[], vec![], &BuildOptions::default()).expect("valid groups"),
        shapes: masks.iter().map(binding).collect(),
        has_boundaries,
        has_alpha: alpha.is_some(),
        ..Scene::empty()
    }
}

#[test]
fn a_fan_meets_what_its_rays_meet() {
    for (has_boundaries, alpha) in [(false, None), (true, None), (true, Some(0.5))] {
        let scene = scene(has_boundaries, alpha);
        let mut seen = [0; 4];
        for i in 0..2000 {
            let (x, y) = (point(i), point(7 * i + 3));
            let rays: Vec<_> = (0..=i % 16).filter_map(|k| segment(x + point(k) * 0.1, y, 0.0)).collect();
            let mut fan = [Obstacles::BLOCKED; 16];
            scene.obstacles_fan(&rays, &mut fan);
            for (ray, got) in rays.iter().zip(fan) {
                let want = scene.obstacles(ray);
                assert_eq!(got.blocked, want.blocked);
                let (mut ours, mut theirs) = (got.boundaries, want.boundaries);
                let distances = |hits: &[tyndall_geometry::Hit]| hits.iter().map(|h| h.t).collect::<Vec<_>>();
                assert!(
                    want.blocked || ours.in_order().map(distances) == theirs.in_order().map(distances),
                    "{got:?} {want:?}"
                );
                seen[usize::from(want.blocked) + 2 * usize::from(!want.boundaries.is_empty())] += 1;
            }
        }
        assert!(seen[0] > 500 && seen[1] > 500 && (!has_boundaries || seen[2] > 500), "{seen:?} say little");
    }
}
