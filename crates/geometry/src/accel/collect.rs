//! From shape groups and instances to the references that a tree is built over.

use super::build::{self, Kind, Ref, widen};
use super::node::Bvh;
use super::slabs::SLACK;
use super::{BuildStats, InstanceDesc};
use crate::Bounds3;
use crate::error::{GeometryError, Place};
use crate::shape::triangle::cross_edges;
use crate::shape::{Shape, ShapeGroup};
use tyndall_base::Vec3;

/// Builds one level and counts it.
pub(super) fn level(
    groups: &[ShapeGroup],
    refs: Vec<Ref>,
    stats: &mut BuildStats,
) -> Result<Bvh, GeometryError> {
    let corners = |r: &Ref| match &groups[r.shape as usize].shape {
        Shape::Triangles(m) => m.corners(r.prim),
        Shape::Bilinear(m) => half(m.corners(r.prim), r.kind == Kind::SecondHalf),
        _ => unreachable!("only meshes are referred to as triangles"),
    };
    let bvh = build::build(refs, &corners, &|shape| groups[shape as usize].mask)?;
    stats.bytes += size_of_val(&*bvh.nodes) + size_of_val(&*bvh.blocks);
    Ok(bvh)
}

/// One triangle of a flat patch; in both the second and third corners carry u and v, or 1-u and 1-v.
fn half([p00, p10, p01, p11]: [Vec3; 4], second: bool) -> [Vec3; 3] {
    if second { [p11, p01, p10] } else { [p00, p10, p01] }
}

/// Collects one level's references.
pub(super) struct References<'a> {
    groups: &'a [ShapeGroup],
    pub refs: Vec<Ref>,
    stats: &'a mut BuildStats,
    in_object: bool,
}

impl<'a> References<'a> {
    pub fn new(groups: &'a [ShapeGroup], stats: &'a mut BuildStats, in_object: bool) -> Self {
        Self { groups, refs: vec![], stats, in_object }
    }

    pub fn add_group(&mut self, shape: u32) {
        let groups = self.groups;
        let geometry = &groups[shape as usize].shape;
        for prim in 0..geometry.prim_count() as u32 {
            match geometry {
                Shape::Triangles(m) => self.add_triangle(m.corners(prim), shape, prim, Kind::Triangle),
                Shape::Bilinear(m) if m.patch(prim).is_flat() => {
                    self.add_triangle(half(m.corners(prim), false), shape, prim, Kind::Triangle);
                    self.add_triangle(half(m.corners(prim), true), shape, prim, Kind::SecondHalf);
                }
                _ => self.add_other(geometry.prim_bounds(prim), shape, prim),
            }
        }
    }

    fn add_triangle(&mut self, corners: [Vec3; 3], shape: u32, prim: u32, kind: Kind) {
        if !(cross_edges(corners).length_squared() > 0.0) {
            self.stats.degenerate += 1;
            return;
        }
        self.stats.triangles += 1;
        let bounds = self.widen(Bounds3::from_points(corners));
        self.refs.push(Ref { bounds, shape, prim, kind });
    }

    fn add_other(&mut self, bounds: Bounds3, shape: u32, prim: u32) {
        if bounds.extent().max_component() == 0.0 {
            self.stats.degenerate += 1;
            return;
        }
        self.stats.others += 1;
        let bounds = self.widen(bounds);
        self.refs.push(Ref { bounds, shape, prim, kind: Kind::Shape });
    }

    pub fn add_instance(
        &mut self,
        index: usize,
        instance: &InstanceDesc,
        objects: &[Bvh],
    ) -> Result<(), GeometryError> {
        let missing =
            GeometryError::NoSuch { what: "instance's object", index: instance.object, count: objects.len() };
        let object = objects.get(instance.object as usize).ok_or(missing)?;
        if object.bounds.is_empty() {
            return Ok(());
        }
        let bounds = self.widen(instance.bounds(object.bounds));
        if let Some(value) = bounds.corners().iter().flat_map(|c| c.to_array()).find(|x| !x.is_finite()) {
            let place = Place { group: None, element: "instance", index };
            return Err(GeometryError::BadCoordinate { place, value });
        }
        self.refs.push(Ref { bounds, shape: index as u32, prim: 0, kind: Kind::Instance });
        Ok(())
    }

    /// In objects the ray's origin was rounded to the grid of the object's coordinates.
    fn widen(&self, b: Bounds3) -> Bounds3 {
        let farthest = b.lo.abs().max(b.hi.abs()).max_component();
        widen(b, if self.in_object { 0.25 * SLACK * farthest } else { 0.0 })
    }
}
