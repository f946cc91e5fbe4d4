//! Intervals: `380:780` and bands `400:700:10`.

use std::fmt;

use super::{Refusal, positive};

/// Most bands of one film.
const MOST_BANDS: f64 = 10_000.0;

/// An interval of positive numbers, such as a luminance range in cd/m2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub from: f64,
    /// Upper end, greater than the lower.
    pub to: f64,
}

/// A spectral range in nm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range(pub Interval);

/// Adjacent spectral bands of equal width.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bands {
    /// Outer edges in nm.
    pub range: Interval,
    /// Number of bands, at least 1.
    pub count: u32,
}

impl Interval {
    /// Reads `MIN:MAX`.
    ///
    /// # Errors
    /// If the text is not two positive numbers in ascending order.
    pub fn parse(text: &str) -> Result<Self, Refusal> {
        let refusal = || format!("expected MIN:MAX with 0 < MIN < MAX, such as 0.1:100, got `{text}`");
        let (from, to) = text.split_once(':').ok_or_else(refusal)?;
        let (from, to) = (positive(from).map_err(|_| refusal())?, positive(to).map_err(|_| refusal())?);
        if from < to { Ok(Self { from, to }) } else { Err(refusal()) }
    }
}

impl Range {
    /// Reads `380:780`.
    ///
    /// # Errors
    /// If the text is not two positive wavelengths in ascending order.
    pub fn parse(text: &str) -> Result<Self, Refusal> {
        let refusal = |_| format!("expected a spectral range in nm such as 380:780, got `{text}`");
        Interval::parse(text).map(Self).map_err(refusal)
    }
}

impl Bands {
    /// Reads `FROM:TO:STEP`, the edges and the width of the bands in nm.
    ///
    /// # Errors
    /// If there are not three positive numbers, or the step does not divide the range.
    pub fn parse(text: &str) -> Result<Self, Refusal> {
        let refusal = || format!("expected band edges FROM:TO:STEP in nm such as 400:700:10, got `{text}`");
        let (range, step) = text.rsplit_once(':').ok_or_else(refusal)?;
        let range = Interval::parse(range).map_err(|_| refusal())?;
        let count = (range.to - range.from) / positive(step).map_err(|_| refusal())?;
        let whole = count.round();
        if whole < 1.0 || (count - whole).abs() > 1e-6 * whole {
            return Err(format!("{}: {count:.3} bands fit, and it must be a whole number", refusal()));
        }
        if whole > MOST_BANDS {
            return Err(format!("{}: that makes {whole} bands, at most {MOST_BANDS} are allowed", refusal()));
        }
        Ok(Self { range, count: whole as u32 })
    }

    /// The `count + 1` edges in nm.
    pub fn edges(&self) -> Vec<f64> {
        let (from, width) = (self.range.from, self.range.to - self.range.from);
        (0..=self.count).map(|k| from + width * f64::from(k) / f64::from(self.count)).collect()
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.0.from, self.0.to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges() {
        assert_eq!(Range::parse("380:780"), Ok(Range(Interval { from: 380.0, to: 780.0 })));
        for text in ["", "380", "780:380", "380:380", "0:780", "-1:780", "380:inf", "380:780:5"] {
            assert!(Range::parse(text).expect_err(text).contains("380:780"), "{text}");
        }
    }

    #[test]
    fn bands_have_edges() {
        let bands = Bands::parse("400:700:10").expect("valid");
        assert_eq!(bands.count, 30);
        let edges = bands.edges();
        assert_eq!((edges.len(), edges[0], edges[1], edges[30]), (31, 400.0, 410.0, 700.0));
        assert_eq!(Bands::parse("400:700:0.1").map(|bands| bands.count), Ok(3000));
        assert_eq!(Bands::parse("400:700:300").map(|bands| bands.count), Ok(1));
    }

    #[test]
    fn bands_are_whole() {
        for text in [
            "",
            "400:700",
            "400:700:7",
            "400:700:0",
            "400:700:-10",
            "700:400:10",
            "400:700:301",
            "400:700:1e-9",
        ] {
            assert!(Bands::parse(text).expect_err(text).contains("400:700:10"), "{text}");
        }
    }
}
