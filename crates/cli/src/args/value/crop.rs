//! A part of the picture in fractions, in pbrt's order: `x0,x1,y0,y1`.

use super::{Refusal, finite};

/// A part of the picture in fractions of its width and height, from the upper left corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crop {
    /// Left and right edge, in [0, 1].
    pub x: [f64; 2],
    /// Upper and lower edge, in [0, 1].
    pub y: [f64; 2],
}

const EXPECTED: &str =
    "expected fractions x0,x1,y0,y1 with 0 <= x0 < x1 <= 1 and 0 <= y0 < y1 <= 1, such as 0.25,0.75,0,1";

impl Crop {
    /// Reads `x0,x1,y0,y1`.
    ///
    /// # Errors
    /// If there are not four numbers, or they do not enclose a part of the picture.
    pub fn parse(text: &str) -> Result<Self, Refusal> {
        let numbers: Result<Vec<f64>, _> = text.split(',').map(finite).collect();
        let refusal = || format!("{EXPECTED}, got `{text}`");
        let [x0, x1, y0, y1] = numbers.map_err(|_| refusal())?[..] else { return Err(refusal()) };
        let ordered = |low: f64, high: f64| 0.0 <= low && low < high && high <= 1.0;
        if ordered(x0, x1) && ordered(y0, y1) {
            Ok(Self { x: [x0, x1], y: [y0, y1] })
        } else {
            Err(refusal())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_fractions() {
        assert_eq!(Crop::parse("0.25,0.75,0,1"), Ok(Crop { x: [0.25, 0.75], y: [0.0, 1.0] }));
    }

    #[test]
    fn refusals() {
        for text in [
            "",
            "0,1,0",
            "0,1,0,1,0",
            "0.5,0.5,0,1",
            "1,0,0,1",
            "-0.1,1,0,1",
            "0,1,0,1.1",
            "0,1,nan,1",
            "a,b,c,d",
        ] {
            assert!(Crop::parse(text).expect_err(text).contains("0.25,0.75,0,1"), "{text}");
        }
    }
}
