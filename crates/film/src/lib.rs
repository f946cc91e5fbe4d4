//! Film: order-free accumulators, replicates, standard errors, filters, sensors.
//!
//! A [`Pass`] turns a [`WorkUnit`] into a [`Patch`]; patches add up to a [`Film`]. Every sum is an integer in fixed point,
//! so that the film's bits depend only on *which* samples were added, never on their order, on the number of threads,
//! or on how the work was cut into units.
//!
//! ```
//! use std::sync::Arc;
//! use tyndall_film::{ErrorMode, Film, FilmSpec, Patch, PixelBounds, WorkUnit};
//!
//! # fn main() -> Result<(), tyndall_film::FilmError> {
//! let spec = Arc::new(FilmSpec::xyz([2, 1], ErrorMode::Conservative));
//! let unit = WorkUnit { window: PixelBounds::new(0, 0, 2, 1), samples: 0..2, round: 0 };
//! let mut patch = Patch::new(&spec, unit);
//! for sample in 0..2 {
//!     patch.add_sample(0, 0, sample, 1.0, &[0.9, 1.0 + sample as f32, 1.1]);
//! }
//! let mut film = Film::new(&spec)?;
//! film.merge(&patch)?;
//! assert_eq!(film.develop().pixel(0, 0)[1].value, 1.5);
//! # Ok(())
//! # }
//! ```
#![forbid(unsafe_code)]

#[cfg(target_endian = "big")]
compile_error!("films are stored as little-endian planes without conversion");

pub mod channels;
pub mod develop;
pub mod diagnostics;
mod error;
pub mod film;
pub mod filter;
mod fixed;
pub mod guide;
pub mod patch;
mod planes;
pub mod spec;
pub mod stats;
pub mod work;

pub use channels::{Channels, Sensor, WavelengthWeights};
pub use develop::{Developed, Estimate};
pub use diagnostics::{BadSample, Diagnostics};
pub use error::FilmError;
pub use film::Film;
pub use filter::PixelFilter;
pub use guide::{Guide, SampleCounts};
pub use patch::Patch;
pub use spec::{ChannelGroup, ErrorMode, FilmSpec, Statistics, Weights};
pub use stats::{ErrorSummary, Pooled, Squares, SumError};
pub use work::{Pass, PixelBounds, WorkUnit};
