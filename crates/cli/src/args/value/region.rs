//! A region of pixels, in the order of `--crop`: `x0,x1,y0,y1`.

use super::Refusal;

/// Pixels from (x0, y0) up to but not including (x1, y1).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// Left and right edge.
    pub x: [u32; 2],
    /// Upper and lower edge.
    pub y: [u32; 2],
}

impl Region {
    /// Reads `x0,x1,y0,y1`.
    ///
    /// # Errors
    /// If there are not four numbers, or they enclose no pixel.
    pub fn parse(text: &str) -> Result<Self, Refusal> {
        let refusal = || {
            format!("expected pixels x0,x1,y0,y1 with x0 < x1 and y0 < y1, such as 0,16,8,24, got `{text}`")
        };
        let numbers: Result<Vec<u32>, _> = text.split(',').map(str::parse).collect();
        let [x0, x1, y0, y1] = numbers.map_err(|_| refusal())?[..] else { return Err(refusal()) };
        if x0 < x1 && y0 < y1 { Ok(Self { x: [x0, x1], y: [y0, y1] }) } else { Err(refusal()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_numbers() {
        assert_eq!(Region::parse("0,16,8,24"), Ok(Region { x: [0, 16], y: [8, 24] }));
    }

    #[test]
    fn refusals() {
        for text in ["", "0,1,0", "0,1,0,1,2", "1,1,0,1", "2,1,0,1", "-1,1,0,1", "0,1,0.5,1", "a,b,c,d"] {
            assert!(Region::parse(text).expect_err(text).contains("0,16,8,24"), "{text}");
        }
    }
}
