//! A size in pixels as `512x384`.

use std::fmt;

use super::Refusal;

/// Width and height of a picture in pixels, both at least 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Resolution {
    /// Pixels from left to right.
    pub width: u32,
    /// Pixels from top to bottom.
    pub height: u32,
}

impl Resolution {
    /// Reads `512x384`.
    ///
    /// # Errors
    /// If the text is not two positive integers with an `x` between them.
    pub fn parse(text: &str) -> Result<Self, Refusal> {
        let refusal =
            || format!("expected width and height in pixels such as 512x384, both at least 1, got `{text}`");
        let (width, height) = text.split_once(['x', 'X', '×']).ok_or_else(refusal)?;
        let pixels =
            |number: &str| number.parse().ok().filter(|&pixels: &u32| pixels > 0).ok_or_else(refusal);
        Ok(Self { width: pixels(width)?, height: pixels(height)? })
    }
}

impl fmt::Display for Resolution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}x{}", self.width, self.height)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_integers() {
        let size = Resolution { width: 512, height: 384 };
        assert_eq!(Resolution::parse("512x384"), Ok(size));
        assert_eq!(Resolution::parse("512X384"), Ok(size));
        assert_eq!(Resolution::parse(&size.to_string()), Ok(size));
    }

    #[test]
    fn refusals() {
        for text in ["", "512", "x", "0x5", "5x0", "-1x5", "5x5x5", "5.5x5", "4294967296x1"] {
            assert!(Resolution::parse(text).expect_err(text).contains("512x384"), "{text}");
        }
    }
}
