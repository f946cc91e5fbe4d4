//! What was learned in earlier rounds and steers a round: frozen while the round runs, serialisable, hashed.

use std::ops::Range;

use crate::{FilmError, PixelBounds};

const MAGIC: &[u8; 8] = b"TYGUIDE1";
const SECTION_COUNTS: u32 = 1;

/// Sample counts per pixel: pixel `p` takes the samples `first[p] .. end[p]`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SampleCounts {
    bounds: PixelBounds,
    first: Vec<u32>,
    end: Vec<u32>,
}

impl SampleCounts {
    /// Row-major ranges over `bounds`.
    ///
    /// # Errors
    /// When the lengths do not fit the bounds, or a range is inverted.
    pub fn new(bounds: PixelBounds, first: Vec<u32>, end: Vec<u32>) -> Result<Self, FilmError> {
        let pixels = bounds.area();
        if first.len() as u64 != pixels || end.len() as u64 != pixels {
            let got = format!("expected {pixels} sample counts, got {} and {}", first.len(), end.len());
            return Err(FilmError::Guide { what: got });
        }
        match first.iter().zip(&end).position(|(a, b)| a > b) {
            Some(p) => Err(FilmError::Guide { what: format!("pixel {p} ends before it begins") }),
            None => Ok(Self { bounds, first, end }),
        }
    }

    /// Window.
    pub fn bounds(&self) -> PixelBounds {
        self.bounds
    }

    /// First sample of each pixel, row-major.
    pub fn first(&self) -> &[u32] {
        &self.first
    }

    /// One past the last sample of each pixel, row-major.
    pub fn end(&self) -> &[u32] {
        &self.end
    }

    /// The samples that any pixel of the window takes.
    pub fn span(&self, window: &PixelBounds) -> Range<u32> {
        let (mut low, mut high) = (u32::MAX, 0);
        for (x, y) in window.pixels() {
            let p = self.bounds.index(x, y);
            if self.first[p] < self.end[p] {
                low = low.min(self.first[p]);
                high = high.max(self.end[p]);
            }
        }
        if low < high { low..high } else { 0..0 }
    }
}

/// Everything learned that a pass may use. An empty guide means: every pixel takes every sample of its unit.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Guide {
    /// Adaptive sample counts.
    pub counts: Option<SampleCounts>,
}

impl Guide {
    /// A guide with sample counts.
    pub fn with_counts(counts: SampleCounts) -> Self {
        Self { counts: Some(counts) }
    }

    /// Which of the unit's samples the pixel takes.
    #[inline]
    pub fn samples_for(&self, x: u32, y: u32, unit: &Range<u32>) -> Range<u32> {
        match &self.counts {
            None => unit.clone(),
            Some(c) => {
                let p = c.bounds.index(x, y);
                let start = unit.start.max(c.first[p]);
                start..unit.end.min(c.end[p]).max(start)
            }
        }
    }

    /// Bytes that [`Guide::from_bytes`] reads; equal guides give equal bytes, so that these can be hashed.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut out = MAGIC.to_vec();
        if let Some(c) = &self.counts {
            let b = c.bounds;
            out.extend(SECTION_COUNTS.to_le_bytes());
            out.extend((16 + 8 * b.area()).to_le_bytes());
            let words = [b.x0, b.y0, b.x1, b.y1];
            out.extend(words.iter().chain(&c.first).chain(&c.end).flat_map(|w| w.to_le_bytes()));
        }
        out
    }

    /// Reads a guide.
    ///
    /// # Errors
    /// When the bytes are cut short, hold an unknown section or contradict themselves.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, FilmError> {
        let refuse = |what: &str| FilmError::Guide { what: what.into() };
        let mut rest = bytes.strip_prefix(MAGIC.as_slice()).ok_or_else(|| refuse("not a guide"))?;
        let mut guide = Self::default();
        while !rest.is_empty() {
            let (tag, after) = rest.split_first_chunk::<4>().ok_or_else(|| refuse("cut short"))?;
            let (len, after) = after.split_first_chunk::<8>().ok_or_else(|| refuse("cut short"))?;
            let len = usize::try_from(u64::from_le_bytes(*len)).map_err(|_| refuse("cut short"))?;
            let body = after.get(..len).ok_or_else(|| refuse("cut short"))?;
            match u32::from_le_bytes(*tag) {
                SECTION_COUNTS if guide.counts.is_none() => guide.counts = Some(read_counts(body)?),
                other => return Err(refuse(&format!("unknown or repeated section {other}"))),
            }
            rest = &after[len..];
        }
        Ok(guide)
    }
}

fn read_counts(body: &[u8]) -> Result<SampleCounts, FilmError> {
    let refuse = || FilmError::Guide { what: "sample counts of a wrong length".into() };
    let (words, tail) = body.as_chunks::<4>();
    if words.len() < 4 || !tail.is_empty() {
        return Err(refuse());
    }
    let word = |i: usize| u32::from_le_bytes(words[i]);
    let bounds = PixelBounds::new(word(0), word(1), word(2), word(3));
    let pixels = usize::try_from(bounds.area()).map_err(|_| refuse())?;
    if Some(words.len() - 4) != pixels.checked_mul(2) {
        return Err(refuse());
    }
    let plane = |at: usize| words[at..at + pixels].iter().map(|w| u32::from_le_bytes(*w)).collect();
    SampleCounts::new(bounds, plane(4), plane(4 + pixels))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn guide() -> Guide {
        let b = PixelBounds::new(2, 3, 5, 5);
        Guide::with_counts(SampleCounts::new(b, vec![4; 6], vec![4, 8, 16, 5, 4, 9]).unwrap())
    }

    #[test]
    fn pixels_take_the_part_of_a_unit_that_is_theirs() {
        let g = guide();
        assert_eq!(g.samples_for(3, 3, &(0..64)), 4..8);
        assert_eq!(g.samples_for(4, 3, &(6..10)), 6..10);
        assert!(g.samples_for(2, 3, &(0..64)).is_empty());
        assert!(g.samples_for(3, 3, &(32..64)).is_empty());
        assert_eq!(Guide::default().samples_for(900, 900, &(3..7)), 3..7);
    }

    #[test]
    fn a_window_spans_its_pixels() {
        let g = guide();
        let c = g.counts.as_ref().unwrap();
        assert_eq!(c.span(&PixelBounds::new(2, 3, 5, 5)), 4..16);
        assert_eq!(c.span(&PixelBounds::new(2, 4, 4, 5)), 4..5);
        assert!(c.span(&PixelBounds::new(2, 3, 3, 4)).is_empty());
    }

    #[test]
    fn bytes_round_trip() {
        for g in [guide(), Guide::default()] {
            assert_eq!(Guide::from_bytes(&g.to_bytes()).unwrap(), g);
        }
    }

    proptest! {
        #[test]
        fn mutated_bytes_never_panic(at in 0usize..100, value: u8, cut in 0usize..100) {
            let mut bytes = guide().to_bytes();
            let n = bytes.len();
            bytes[at % n] = value;
            bytes.truncate(n - cut % n);
            let _ = Guide::from_bytes(&bytes);
        }
    }
}
