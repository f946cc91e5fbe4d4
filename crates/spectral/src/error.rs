//! What can be wrong with a spectrum, a density or a colour.

use crate::range::RangeGap;

/// A refused spectrum, density, name or colour.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SpectralError {
    /// Fewer entries than the form needs.
    #[error("{what}: expected at least {needed} entries, got {got}")]
    TooFew {
        /// What the entries are.
        what: &'static str,
        /// The least number that makes sense.
        needed: usize,
        /// The number given.
        got: usize,
    },
    /// Wavelengths and values differ in number.
    #[error("expected {expected} values for these wavelengths, got {got}")]
    Length {
        /// Values that the wavelengths ask for.
        expected: usize,
        /// Values given.
        got: usize,
    },
    /// Wavelengths that do not ascend.
    #[error("wavelengths must ascend, but entry {index} is {got} nm after {previous} nm")]
    Unsorted {
        /// Position in the list, from 0.
        index: usize,
        /// The wavelength before it \[nm\].
        previous: f32,
        /// The wavelength itself \[nm\].
        got: f32,
    },
    /// A number outside what is physical.
    #[error("{what}: expected {expected}, got {got}")]
    Value {
        /// The quantity and its unit.
        what: &'static str,
        /// What is allowed.
        expected: &'static str,
        /// The number given.
        got: f64,
    },
    /// A table that does not reach over the range asked, where extrapolation is not allowed.
    #[error(transparent)]
    Range(#[from] RangeGap),
    /// A name without a spectrum, medium or colour space.
    #[error("no {what} is named \"{name}\"")]
    Unknown {
        /// The kind of thing looked for.
        what: &'static str,
        /// The name given.
        name: String,
    },
    /// A density that is zero everywhere.
    #[error("{0} has no power between {1} and {2} nm")]
    NoPower(&'static str, f32, f32),
}

/// `Ok` when `ok` holds, else the error that names the quantity, what was expected and what was got.
pub(crate) fn require(
    ok: bool,
    what: &'static str,
    expected: &'static str,
    got: f64,
) -> Result<(), SpectralError> {
    if ok { Ok(()) } else { Err(SpectralError::Value { what, expected, got }) }
}
