//! Rays, transforms, shapes and the 8-wide BVH.
//!
//! Build an [`Accel`] from [`ShapeGroup`]s, ask it for the nearest [`Hit`] or for occlusion, and work out the
//! [`SurfacePoint`] of a hit when it is needed. Rays leave surfaces by [`SurfacePoint::spawn`].
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "a negated comparison also refuses NaN")]

// tests within share scenes with those of `tests/`
#[cfg(test)]
extern crate self as tyndall_geometry;

pub mod accel;
pub mod bounds;
pub mod dvec;
pub mod error;
pub mod frame;
pub mod motion;
pub mod ray;
pub mod shape;
pub mod surface;
pub mod transform;

pub use accel::{Accel, BuildOptions, BuildStats, Dispatch, Fan, Hit, InstanceDesc, NO_INSTANCE, Notes};
pub use bounds::Bounds3;
pub use error::GeometryError;
pub use frame::Frame;
pub use motion::Motion;
pub use ray::Ray;
pub use shape::{
    BilinearMesh, CurveKind, CurveSegment, Curves, Cylinder, Disk, MASK_ALL, Shape, ShapeGroup, Sphere,
    TriangleMesh,
};
pub use surface::{Rounding, ShapeSample, SurfacePoint, segment, spawn_origin};
pub use transform::Transform;
