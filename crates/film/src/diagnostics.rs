//! What was wrong with samples, and what was done about it. Nothing is dropped in silence.

use serde::{Deserialize, Serialize};

use crate::fixed;

/// How many bad samples are remembered one by one.
pub const REMEMBERED: usize = 16;

/// A sample that was dropped, with all that is needed to replay it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct BadSample {
    /// Index of the sample in its pixel.
    pub sample: u32,
    /// Row.
    pub y: u32,
    /// Column.
    pub x: u32,
    /// The job's seed.
    pub seed: u64,
}

/// Counts of samples that were dropped or clamped.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Diagnostics {
    /// Samples dropped because a channel was infinite or not a number.
    pub non_finite: u64,
    /// Samples dropped because a channel was 2^31 or more in magnitude, beyond what the sums can hold.
    pub out_of_range: u64,
    /// Samples that the firefly clamp scaled down.
    pub clamped: u64,
    /// Sums of squares that overflowed: errors of such pixels are meaningless.
    pub overflows: u64,
    /// Fixed point, as text in files: few formats hold integers of 128 bits.
    #[serde(with = "text")]
    pub(crate) removed: i128,
    pub(crate) first: Vec<BadSample>,
}

impl Diagnostics {
    /// Sum of Y over all samples that the clamp took away.
    pub fn clamp_removed(&self) -> f64 {
        fixed::to_f64(self.removed)
    }

    /// The dropped samples of least index, at most [`REMEMBERED`].
    pub fn first_bad(&self) -> &[BadSample] {
        &self.first
    }

    /// True when no sample was dropped, clamped or lost.
    pub fn is_clean(&self) -> bool {
        *self == Self::default()
    }

    /// Remembers the samples of least index: a rule that does not depend on the order of arrival.
    pub(crate) fn remember(&mut self, bad: BadSample) {
        let at = self.first.partition_point(|b| *b < bad);
        self.first.insert(at, bad);
        self.first.truncate(REMEMBERED);
    }

    pub(crate) fn merge(&mut self, other: &Self) {
        self.non_finite += other.non_finite;
        self.out_of_range += other.out_of_range;
        self.clamped += other.clamped;
        self.overflows += other.overflows;
        fixed::merge(&mut self.removed, other.removed);
        other.first.iter().for_each(|&b| self.remember(b));
    }

    pub(crate) fn clear(&mut self) {
        let mut first = std::mem::take(&mut self.first);
        first.clear();
        *self = Self { first, ..Self::default() };
    }
}

mod text {
    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    pub fn serialize<S: Serializer>(v: &i128, s: S) -> Result<S::Ok, S::Error> {
        s.serialize_str(&v.to_string())
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(d: D) -> Result<i128, D::Error> {
        String::deserialize(d)?.parse().map_err(D::Error::custom)
    }
}
