//! Boundaries that share a face, as boxes of media side by side do, or a box in the corner of another.
//!
//! A ray meets one of the faces that coincide, by chance of rounding and order. What lies behind them follows from all of
//! them: passed in such an order that each is met from the medium that the one before leads to, and where that leaves a
//! choice, out of one body before into the next.

use crate::{
    ids::MediumId,
    scene::{BOUNDARY, Boundary, Scene, ShapeBinding},
};
use tyndall_base::Vec3;
use tyndall_geometry::{Accel, Bounds3, Hit, Ray, Shape, SurfacePoint};

/// Faces at one place that are looked at; more say nothing new.
const MOST: usize = 16;
/// Coordinates that differ by this much of their size may be meant to be the same: eight roundings of an `f32`.
const SLACK: f32 = 8.0 / (1 << 24) as f32;
/// More boundaries than this are not compared with each other.
const MANY: usize = 4000;
/// Bodies of up to this many faces are compared face by face.
const FEW: u32 = 64;

/// A face as a ray passes it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Face {
    near: MediumId,
    far: MediumId,
    leaves: bool,
}

impl Scene {
    /// The media on the two sides of all boundaries without material that coincide with the one that `ray` meets at `hit`, told
    /// as if they were one.
    #[inline(never)]
    pub(crate) fn joint_boundary(&self, ray: &Ray, hit: &Hit, s: &SurfacePoint, own: Boundary) -> Boundary {
        let across = ray.d.dot(s.ng);
        let leaves = across > 0.0;
        let met = face(own, leaves);
        let mut faces = [met; MOST];
        let mut n = 1;
        // a short way through the point, by far enough to reach faces that rounding keeps apart
        let shape = &self.accel.group(hit.shape).shape;
        let size = reach(&shape.prim_bounds(hit.prim)).max(s.p.abs().max_component());
        let half = size * SLACK / across.abs().max(1e-3 * ray.d.length());
        let probe = Ray { o: s.p - ray.d * half, d: ray.d, t_max: 2.0 * half, time: ray.time };
        self.accel.intersect_filtered(&probe, BOUNDARY, |other| {
            let binding = &self.shapes[other.shape as usize];
            if let (Some(boundary), None, true) = (binding.boundary, &binding.alpha, n < MOST) {
                let ng = self.accel.surface(&probe, other).ng;
                // not another side of the same edge
                if ng.abs_dot(s.ng) > 0.999_99 {
                    faces[n] = face(boundary, ray.d.dot(ng) > 0.0);
                    n += 1;
                }
            }
            false
        });
        let far = last(met, &faces[..n]).far;
        // seen from behind the last one is the first
        let turned = faces.map(turned);
        let near = last(turned[0], &turned[..n]).far;
        if leaves { Boundary { inside: near, outside: far } } else { Boundary { inside: far, outside: near } }
    }
}

fn face(b: Boundary, leaves: bool) -> Face {
    if leaves {
        Face { near: b.inside, far: b.outside, leaves }
    } else {
        Face { near: b.outside, far: b.inside, leaves }
    }
}

/// The same passed the other way.
fn turned(f: Face) -> Face {
    Face { near: f.far, far: f.near, leaves: !f.leaves }
}

/// The one of `faces`, or `met` among them, that a ray passes last: none of the others leads on from it, else one that enters
/// a body; beyond that a choice without meaning, the same for every order of shapes.
fn last(met: Face, faces: &[Face]) -> Face {
    let rank = |f: &Face| {
        let leads_on = faces.iter().any(|other| other != f && other.near == f.far);
        (!leads_on, !f.leaves, !f.far.is_vacuum(), f.far.0)
    };
    faces.iter().copied().max_by_key(rank).unwrap_or(met)
}

/// Greatest size of a coordinate in a box.
fn reach(b: &Bounds3) -> f32 {
    b.lo.abs().max(b.hi.abs()).max_component()
}

/// Whether boundaries without material may share faces. Those of objects, from the shape `world` on, are taken to do so.
pub fn may_touch(accel: &Accel, shapes: &[ShapeBinding], world: usize) -> bool {
    let is_boundary = |s: &ShapeBinding| s.material.is_interface() && s.boundary.is_some();
    let indices: Vec<usize> = (0..shapes.len()).filter(|&i| is_boundary(&shapes[i])).collect();
    if indices.len() < 2 && accel.instances().len() < 2 {
        return false;
    }
    if indices.len() > MANY || indices.iter().any(|&i| i >= world) {
        return true;
    }
    let boxed = |&i: &usize| (&accel.groups()[i].shape, accel.groups()[i].shape.bounds());
    let bodies: Vec<(&Shape, Bounds3)> = indices.iter().map(boxed).collect();
    bodies.iter().enumerate().any(|(i, a)| bodies[..i].iter().any(|b| may_share(a, b)))
}

/// Whether two bodies may share a face: boxes and the like by their faces, others where neither is apart from the other's box
/// nor well within it.
fn may_share((a, in_a): &(&Shape, Bounds3), (b, in_b): &(&Shape, Bounds3)) -> bool {
    let slack = 4.0 * SLACK * reach(in_a).max(reach(in_b));
    if is_apart(in_a, in_b, slack) {
        return false;
    }
    match (faces_of(a), faces_of(b)) {
        (Some(a), Some(b)) => a.iter().any(|a| b.iter().any(|b| is_coplanar(a, b, slack))),
        _ => !(is_within(in_a, in_b, slack) || is_within(in_b, in_a, slack)),
    }
}

/// Corners of the faces of a body that has but a few; the last one twice where there are three.
fn faces_of(shape: &Shape) -> Option<Vec<[Vec3; 4]>> {
    let few = shape.prim_count() as u32;
    if few > FEW {
        return None;
    }
    match shape {
        Shape::Triangles(m) => Some((0..few).map(|i| m.corners(i)).map(|[a, b, c]| [a, b, c, c]).collect()),
        Shape::Bilinear(m) => Some((0..few).map(|i| m.corners(i)).collect()),
        _ => None,
    }
}

/// Whether one face lies in the plane of the other, and their boxes meet.
fn is_coplanar(a: &[Vec3; 4], b: &[Vec3; 4], slack: f32) -> bool {
    let n = (a[1] - a[0]).cross(a[2] - a[0]).normalize();
    let in_plane = b.iter().all(|&p| n.dot(p - a[0]).abs() <= slack);
    in_plane && !is_apart(&Bounds3::from_points(*a), &Bounds3::from_points(*b), slack)
}

fn is_apart(a: &Bounds3, b: &Bounds3, slack: f32) -> bool {
    (0..3).any(|k| a.lo[k] > b.hi[k] + slack || b.lo[k] > a.hi[k] + slack)
}

fn is_within(a: &Bounds3, b: &Bounds3, slack: f32) -> bool {
    (0..3).all(|k| a.lo[k] > b.lo[k] + slack && a.hi[k] < b.hi[k] - slack)
}

#[cfg(test)]
mod tests {
    use super::*;

    const AIR: MediumId = MediumId::VACUUM;
    const A: MediumId = MediumId(1);
    const B: MediumId = MediumId(2);

    fn leave(near: MediumId, far: MediumId) -> Face {
        Face { near, far, leaves: true }
    }

    fn enter(near: MediumId, far: MediumId) -> Face {
        Face { near, far, leaves: false }
    }

    #[test]
    fn what_is_behind_follows_from_all_faces_in_any_order() {
        let cases: [(&[Face], MediumId); 6] = [
            // from one box into the next, of another medium or of the same
            (&[leave(A, AIR), enter(AIR, B)], B),
            (&[leave(A, AIR), enter(AIR, A)], A),
            // a box in a corner of another, from without, from within, and into a third beyond
            (&[enter(AIR, A), enter(A, B)], B),
            (&[leave(B, A), leave(A, AIR)], AIR),
            (&[leave(B, A), leave(A, AIR), enter(AIR, B)], B),
            // two triangles of one face
            (&[leave(A, AIR), leave(A, AIR)], AIR),
        ];
        for (faces, want) in cases {
            let mut other = faces.to_vec();
            other.reverse();
            assert_eq!([last(faces[0], faces).far, last(other[0], &other).far], [want; 2], "{faces:?}");
        }
    }
}
