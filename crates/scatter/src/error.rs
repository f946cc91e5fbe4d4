//! What can be wrong with the parameters of a scattering model.

use tyndall_spectral::SpectralError;
use tyndall_spectral::curve::Curve;
use tyndall_spectral::range::LambdaRange;

/// A refused phase function or surface.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ScatterError {
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
    /// A table of the wrong shape.
    #[error("phase table: expected {expected} {what}, got {got}")]
    Shape {
        /// What is counted.
        what: &'static str,
        /// The number that makes sense.
        expected: usize,
        /// The number given.
        got: usize,
    },
    /// Entries that do not ascend.
    #[error("phase table: {what} must ascend, but entry {index} is {got} after {previous}")]
    Unsorted {
        /// The axis and its unit.
        what: &'static str,
        /// Position in the list, from 0.
        index: usize,
        /// The entry before it.
        previous: f64,
        /// The entry itself.
        got: f64,
    },
    /// A phase function that is not normalised.
    #[error(
        "phase table at {lambda} nm: expected an integral over the sphere of 1 or 4 pi (within 1 %), got {got:.6}"
    )]
    Norm {
        /// Wavelength \[nm\].
        lambda: f32,
        /// The integral found.
        got: f64,
    },
    /// Tables that make no sense together.
    #[error("{what}: {why}")]
    Unusable {
        /// What they are for.
        what: &'static str,
        /// Why not.
        why: String,
    },
    /// A wrong spectrum.
    #[error(transparent)]
    Spectral(#[from] SpectralError),
}

/// `Err` unless `ok`.
pub(crate) fn require(
    ok: bool,
    what: &'static str,
    expected: &'static str,
    got: f64,
) -> Result<(), ScatterError> {
    if ok { Ok(()) } else { Err(ScatterError::Value { what, expected, got }) }
}

/// `Err` unless `ok` holds at both bounds of the curve, wherever it is defined.
pub(crate) fn require_curve(
    curve: &Curve,
    what: &'static str,
    expected: &'static str,
    ok: impl Fn(f32) -> bool,
) -> Result<(), ScatterError> {
    let range = curve.range().unwrap_or(LambdaRange { min: 10.0, max: 100_000.0 });
    for v in curve.bounds(range) {
        require(ok(v), what, expected, f64::from(v))?;
    }
    Ok(())
}
