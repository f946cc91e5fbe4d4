//! Doubts about standard errors.

use tyndall::film::ErrorSummary;

/// Errors that are not what they seem are never passed over in silence.
pub fn tell(s: &ErrorSummary) {
    let (dominated, pooled, unknown, pixels) = (s.flagged, s.pooled, s.unknown, s.pixels);
    if dominated > 0 {
        tracing::info!(
            dominated,
            pixels,
            "{dominated} of {pixels} pixels are flagged: one sample makes half of their variance or more, and their errors may \
             be too small"
        );
    }
    if pooled > 0 {
        tracing::info!(
            pooled,
            pixels,
            "{pooled} of {pixels} pixels have too few samples for errors of their own: theirs are pooled over tiles"
        );
    }
    if unknown > 0 {
        tracing::info!(unknown, pixels, "{unknown} of {pixels} pixels have too few samples for an error");
    }
}
