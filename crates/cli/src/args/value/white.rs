//! A white point by name, temperature or chromaticity.

use super::{Refusal, positive};

/// What shall look white.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum WhitePoint {
    /// A standard illuminant by its name.
    Illuminant(&'static str),
    /// A correlated colour temperature in K.
    Temperature(f64),
    /// CIE 1931 chromaticity.
    Chromaticity(f64, f64),
}

const ILLUMINANTS: [&str; 7] = ["A", "D50", "D55", "D60", "D65", "D75", "E"];

impl WhitePoint {
    /// Reads `D65`, `3200K` or `x,y`.
    ///
    /// # Errors
    /// If it is none of these, or the temperature or chromaticity is not that of a light.
    pub fn parse(text: &str) -> Result<Self, Refusal> {
        let refusal = || {
            format!(
                "expected one of {}, a temperature such as 3200K, or x,y; got `{text}`",
                ILLUMINANTS.join(", ")
            )
        };
        if let Some(name) = ILLUMINANTS.iter().find(|name| name.eq_ignore_ascii_case(text)) {
            return Ok(Self::Illuminant(name));
        }
        if let Some(kelvin) = text.strip_suffix(['K', 'k']) {
            let kelvin = positive(kelvin).map_err(|_| refusal())?;
            let seen = (1000.0..=25000.0).contains(&kelvin);
            return seen
                .then_some(Self::Temperature(kelvin))
                .ok_or_else(|| format!("{}: a temperature must lie between 1000 and 25000 K", refusal()));
        }
        let (x, y) = text.split_once(',').ok_or_else(refusal)?;
        let (x, y) = (positive(x).map_err(|_| refusal())?, positive(y).map_err(|_| refusal())?);
        if x + y <= 1.0 {
            Ok(Self::Chromaticity(x, y))
        } else {
            Err(format!("{}: x + y must not exceed 1", refusal()))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_ways() {
        assert_eq!(WhitePoint::parse("d65"), Ok(WhitePoint::Illuminant("D65")));
        assert_eq!(WhitePoint::parse("3200K"), Ok(WhitePoint::Temperature(3200.0)));
        assert_eq!(WhitePoint::parse("0.31,0.33"), Ok(WhitePoint::Chromaticity(0.31, 0.33)));
    }

    #[test]
    fn refusals() {
        for text in ["", "D99", "3200", "10K", "1e6K", "0.9,0.9", "0,0.3", "a,b", "K"] {
            assert!(WhitePoint::parse(text).expect_err(text).contains("3200K"), "{text}");
        }
    }
}
