//! A pixel as `x,y`.

use std::fmt;

use super::Refusal;

/// A pixel, counted from the upper left corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pixel {
    /// From the left, from 0.
    pub x: u32,
    /// From the top, from 0.
    pub y: u32,
}

impl Pixel {
    /// Reads `x,y`.
    ///
    /// # Errors
    /// If the text is not two non-negative integers.
    pub fn parse(text: &str) -> Result<Self, Refusal> {
        let refusal =
            || format!("expected a pixel x,y counted from 0 at the upper left, such as 10,20, got `{text}`");
        let (x, y) = text.split_once(',').ok_or_else(refusal)?;
        match (x.trim().parse(), y.trim().parse()) {
            (Ok(x), Ok(y)) => Ok(Self { x, y }),
            _ => Err(refusal()),
        }
    }
}

impl fmt::Display for Pixel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},{}", self.x, self.y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_integers() {
        assert_eq!(Pixel::parse("10,20"), Ok(Pixel { x: 10, y: 20 }));
        for text in ["", "10", "10,", ",20", "-1,0", "1.5,2", "1,2,3", "10x20"] {
            assert!(Pixel::parse(text).expect_err(text).contains("10,20"), "{text}");
        }
    }
}
