//! File formats: EXR (RGB and spectral), PNG, PFM and other textures, PLY meshes, NanoVDB volumes, lenses.
//!
//! Every reader is bounded in memory by what the file can justify, and answers a malformed file with a
//! [`FileError`] that says what was expected, what was found and what to do. Every writer goes through
//! [`atomic::write_atomic`]: a result appears whole under its name, or not at all.
#![deny(unsafe_code)]

pub mod atomic;
pub mod error;
pub mod image;
pub mod lens;
mod limits;
pub mod mesh;
pub mod netcdf;
pub mod photometry;
pub mod tensor;
pub mod volume;

pub use error::{FileError, Place, Result};
