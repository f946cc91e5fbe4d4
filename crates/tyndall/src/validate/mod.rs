//! The renderer against radiative transfer: scenes whose answers are known without a renderer, rendered in every way that has
//! no bias, and judged by the errors that replicates show.
//!
//! Media and surfaces are swept in wavelength: each band of a scene is a row of a table, so that one render asks many
//! questions and multiple importance sampling over wavelengths is asked with each of them. A family is a file in
//! [`family`]; [`way`] lists integrators and spectral strategies; [`judge`] tells how rows are judged.

pub mod bands;
pub mod case;
pub mod family;
pub mod files;
pub mod judge;
pub mod measure;
mod page;
pub mod report;
pub mod run;
pub mod scene;
pub mod scenes;
pub mod table;
pub mod way;

pub use bands::{Bands, Dialect};
pub use case::Case;
pub use family::{FAMILIES, Family};
pub use report::Report;
pub use run::{Depth, Outcome, Plan, Watch, run};
pub use way::{WAYS, Way};
