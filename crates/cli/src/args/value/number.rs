//! Numbers that must be finite, positive, or a probability.

use super::Refusal;

/// A finite number.
///
/// # Errors
/// If the text is no number, or not a finite one.
pub fn finite(text: &str) -> Result<f64, Refusal> {
    let number: f64 = text.trim().parse().map_err(|_| format!("expected a number, got `{text}`"))?;
    if number.is_finite() { Ok(number) } else { Err(format!("expected a finite number, got `{text}`")) }
}

/// A finite number greater than zero.
///
/// # Errors
/// If the text is anything else.
pub fn positive(text: &str) -> Result<f64, Refusal> {
    let number = finite(text)?;
    if number > 0.0 { Ok(number) } else { Err(format!("expected a number greater than 0, got `{text}`")) }
}

/// A number between 0 and 1, both excluded.
///
/// # Errors
/// If the text is anything else.
pub fn fraction(text: &str) -> Result<f64, Refusal> {
    let number = positive(text)?;
    if number < 1.0 { Ok(number) } else { Err(format!("expected a number between 0 and 1, got `{text}`")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds() {
        assert_eq!(finite("-1.5e3"), Ok(-1500.0));
        assert!(["", "x", "nan", "inf", "-inf", "1e999", "1,5"].iter().all(|text| finite(text).is_err()));
        assert!(["0", "-0", "-1"].iter().all(|text| positive(text).is_err()));
        assert_eq!(fraction("0.01"), Ok(0.01));
        assert!(["0", "1", "2"].iter().all(|text| fraction(text).is_err()));
    }
}
