//! Tyndall as a library: load a scene, render it, write the result.
#![forbid(unsafe_code)]

pub mod error;
pub mod options;
pub mod plan;
pub mod units;

pub use error::Error;
pub use options::{Options, Spectral, WavelengthPdf};
pub use plan::{Plan, Source, load, plan};
