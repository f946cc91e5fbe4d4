//! Rays, transforms, shapes and the 8-wide BVH.

pub mod ray;

pub use ray::Ray;
