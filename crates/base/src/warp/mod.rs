//! Maps from the unit square to disks, directions, surfaces and distances, each with its density.
//!
//! `sample_x(u)` takes numbers in `[0, 1)`; `pdf_x` is the density in the measure named there. Directions are unit
//! vectors about `+z`. All maps are pure and continuous where the shape allows, so stratification survives.

mod direction;
mod disk;
mod distance;
mod planar;
mod spherical_rectangle;
mod spherical_triangle;
mod vec64;

pub use direction::{
    pdf_chord, pdf_cosine_hemisphere, pdf_uniform_cone, pdf_uniform_hemisphere, pdf_uniform_sphere,
    sample_chord, sample_cosine_hemisphere, sample_uniform_cone, sample_uniform_hemisphere,
    sample_uniform_sphere,
};
pub use disk::{invert_concentric_disk, pdf_uniform_disk, sample_concentric_disk, sample_polar_disk};
pub use distance::{
    Equiangular, pdf_exponential, pdf_truncated_exponential, sample_exponential, sample_truncated_exponential,
};
pub use planar::{
    invert_bilinear, invert_linear, pdf_bilinear, pdf_linear, sample_bilinear, sample_linear,
    sample_uniform_triangle,
};
pub use spherical_rectangle::SphericalRectangle;
pub use spherical_triangle::SphericalTriangle;

#[cfg(test)]
mod spherical_tests;
#[cfg(test)]
mod tests;
