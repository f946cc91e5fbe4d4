//! Errors of the film.

use crate::PixelBounds;

/// What can be wrong with a film's description, or with films that are to be added.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FilmError {
    /// The image has no pixels.
    #[error("film: expected at least one pixel, got {width} x {height}")]
    Empty {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// The sums would need more memory than allowed.
    #[error(
        "film: {width} x {height} pixels with {channels} channels need {needed} bytes of sums, more than the {limit} allowed\n\
         hint: lower the resolution, crop, use fewer bands, or raise the memory limit"
    )]
    TooLarge {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// Channels of all groups.
        channels: usize,
        /// Bytes needed.
        needed: u128,
        /// Bytes allowed.
        limit: u64,
    },
    /// The allocator refused.
    #[error("film: the system refused {bytes} bytes for the film's sums")]
    OutOfMemory {
        /// Bytes asked for.
        bytes: u128,
    },
    /// A field of the description is out of range.
    #[error("film: {field}: expected {expected}, got {got}")]
    Invalid {
        /// Field.
        field: &'static str,
        /// What it must be.
        expected: &'static str,
        /// What it is.
        got: String,
    },
    /// Two films or a film and a patch differ in what they hold.
    #[error("film: cannot add films of different kinds: {what}")]
    Mismatch {
        /// What differs.
        what: String,
    },
    /// A patch lies outside the film.
    #[error("film: a patch over {patch:?} lies outside the film {film:?}")]
    Outside {
        /// The patch's window.
        patch: PixelBounds,
        /// The film's window.
        film: PixelBounds,
    },
    /// Bytes that are no guide.
    #[error("guide: {what}")]
    Guide {
        /// What is wrong.
        what: String,
    },
    /// A response curve, sensor or band table that cannot be used.
    #[error("film channels: {what}")]
    Channels {
        /// What is wrong.
        what: String,
    },
    /// A pixel filter's parameter is out of range.
    #[error("{filter} filter: {parameter}: expected {expected}, got {got}")]
    Filter {
        /// Name of the filter.
        filter: &'static str,
        /// Parameter.
        parameter: &'static str,
        /// What it must be.
        expected: &'static str,
        /// What it is.
        got: f32,
    },
}
