//! What a constructor of this crate can refuse.

/// A parameter that physics or algebra does not allow.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TransportError {
    /// A number outside its range.
    #[error("{what}: expected {expected}, got {got}")]
    OutOfRange {
        /// The parameter.
        what: &'static str,
        /// What is allowed.
        expected: &'static str,
        /// What was given.
        got: f64,
    },
    /// A table or image that cannot be used.
    #[error("{what}: {why}")]
    Unusable {
        /// The parameter.
        what: &'static str,
        /// Why not.
        why: String,
    },
}

/// `Ok(())` when `ok`, else the range error for `what`.
pub(crate) fn check(
    ok: bool,
    what: &'static str,
    expected: &'static str,
    got: f64,
) -> Result<(), TransportError> {
    if ok { Ok(()) } else { Err(TransportError::OutOfRange { what, expected, got }) }
}
