//! The error to reach: `rel=1%`.

use std::fmt;

use super::{Refusal, positive};

/// A relative standard error to reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// Largest relative standard error: 0.01 for 1 %.
    pub relative: f64,
    /// Ask it of every spectral band rather than of luminance.
    pub bands: bool,
}

const EXPECTED: &str = "expected a relative error such as rel=1%, rel=0.01 or rel=1%,bands";

impl Target {
    /// Reads `rel=1%`, `rel=0.01`, `rel=1%,bands`.
    ///
    /// # Errors
    /// If the text has another form, or the error is not between 0 and 100 %.
    pub fn parse(text: &str) -> Result<Self, Refusal> {
        let refusal = || format!("{EXPECTED}, got `{text}`");
        let (number, bands) = match text.strip_suffix(",bands") {
            Some(number) => (number, true),
            None => (text, false),
        };
        let number = number.strip_prefix("rel=").ok_or_else(refusal)?;
        let relative = match number.strip_suffix('%') {
            Some(per_cent) => positive(per_cent).map_err(|_| refusal())? / 100.0,
            None => positive(number).map_err(|_| refusal())?,
        };
        if relative < 1.0 {
            Ok(Self { relative, bands })
        } else {
            Err(format!(
                "{EXPECTED}; `{text}` is 100 % or more (`1` is 100 %: for one per cent write rel=1%)"
            ))
        }
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "rel={}{}", self.relative, if self.bands { ",bands" } else { "" })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn per_cent_and_fraction() {
        assert_eq!(Target::parse("rel=1%"), Ok(Target { relative: 0.01, bands: false }));
        assert_eq!(Target::parse("rel=0.5%,bands"), Ok(Target { relative: 0.005, bands: true }));
        let target = Target { relative: 0.02, bands: true };
        assert_eq!(Target::parse(&target.to_string()), Ok(target));
    }

    #[test]
    fn refusals() {
        for text in [
            "",
            "1%",
            "rel",
            "rel=",
            "rel=%",
            "rel=0",
            "rel=-1%",
            "rel=1",
            "rel=100%",
            "abs=1",
            "rel=1%,band",
        ] {
            assert!(Target::parse(text).expect_err(text).contains("rel=1%"), "{text}");
        }
    }
}
