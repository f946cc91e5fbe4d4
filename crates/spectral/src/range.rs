//! Ranges of wavelength, and what happens outside a table.

use crate::error::{SpectralError, require};

/// A closed interval of wavelengths \[nm\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LambdaRange {
    /// Shortest wavelength \[nm\].
    pub min: f32,
    /// Longest wavelength \[nm\].
    pub max: f32,
}

impl LambdaRange {
    /// 360 to 830 nm: the range of the CIE 1931 tables and the default everywhere.
    pub const VISIBLE: Self = Self { min: 360.0, max: 830.0 };

    /// `min < max`, both positive and finite, in nm.
    pub fn new(min: f32, max: f32) -> Result<Self, SpectralError> {
        require(min > 0.0 && min.is_finite(), "start of the spectral range [nm]", "> 0", f64::from(min))?;
        require(
            max > min && max.is_finite(),
            "end of the spectral range [nm]",
            "> its start",
            f64::from(max),
        )?;
        Ok(Self { min, max })
    }

    /// Length \[nm\].
    pub fn width(&self) -> f32 {
        self.max - self.min
    }

    /// True for wavelengths in the closed interval.
    #[inline]
    pub fn contains(&self, lambda: f32) -> bool {
        lambda >= self.min && lambda <= self.max
    }

    /// True when all of `other` lies inside.
    pub fn covers(&self, other: &Self) -> bool {
        self.min <= other.min && self.max >= other.max
    }
}

impl std::fmt::Display for LambdaRange {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} to {} nm", self.min, self.max)
    }
}

/// What a table gives outside its wavelengths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outside {
    /// The nearest end value.
    Hold,
    /// Zero.
    Zero,
    /// Nothing may be asked there: loading must refuse the range, and evaluation gives NaN so that no picture hides it.
    Error,
}

impl Outside {
    /// The value beyond an end whose last value is `end`.
    pub(crate) fn beyond(self, end: f32) -> f32 {
        match self {
            Self::Hold => end,
            Self::Zero => 0.0,
            Self::Error => f32::NAN,
        }
    }
}

/// A table that does not reach over the range asked; a warning under [`Outside::Hold`] and [`Outside::Zero`], an
/// error under [`Outside::Error`].
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("the table covers {table}, but {asked} is asked; outside it the value is {}", self.rule_name())]
pub struct RangeGap {
    /// The range of the film or of the integral.
    pub asked: LambdaRange,
    /// The range of the table.
    pub table: LambdaRange,
    /// What the table gives outside.
    pub outside: Outside,
}

impl RangeGap {
    fn rule_name(&self) -> &'static str {
        match self.outside {
            Outside::Hold => "held at its ends",
            Outside::Zero => "zero",
            Outside::Error => "not defined",
        }
    }
}
