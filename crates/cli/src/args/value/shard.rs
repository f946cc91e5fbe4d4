//! One of several parts of a job as `2/8`.

use std::fmt;

use super::Refusal;

/// The K-th of N parts of a job, K from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Which part, from 1.
    pub index: u32,
    /// How many parts there are.
    pub count: u32,
}

impl Shard {
    /// Reads `K/N`.
    ///
    /// # Errors
    /// If the text is not two integers with 1 <= K <= N.
    pub fn parse(text: &str) -> Result<Self, Refusal> {
        let refusal = || format!("expected K/N with 1 <= K <= N, such as 2/8, got `{text}`");
        let (index, count) = text.split_once('/').ok_or_else(refusal)?;
        let (Ok(index), Ok(count)) = (index.parse(), count.parse()) else { return Err(refusal()) };
        if 1 <= index && index <= count { Ok(Self { index, count }) } else { Err(refusal()) }
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn from_one() {
        let shard = Shard { index: 2, count: 8 };
        assert_eq!(Shard::parse("2/8"), Ok(shard));
        assert_eq!(Shard::parse(&shard.to_string()), Ok(shard));
        assert!(Shard::parse("1/1").is_ok() && Shard::parse("8/8").is_ok());
    }

    #[test]
    fn refusals() {
        for text in ["", "2", "0/8", "9/8", "0/0", "-1/8", "2/8/1", "a/b", "1.5/8"] {
            assert!(Shard::parse(text).expect_err(text).contains("2/8"), "{text}");
        }
    }
}
