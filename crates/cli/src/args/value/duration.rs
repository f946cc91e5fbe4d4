//! A time span as `90s`, `5m` or `1h30m`.

use std::time;

use super::{Refusal, finite};

/// A time span.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Duration(pub time::Duration);

/// Units and their seconds. `ms` stands before `m` so that it is read whole.
const UNITS: [(&str, f64); 5] = [("ms", 1e-3), ("s", 1.0), ("m", 60.0), ("h", 3600.0), ("d", 86400.0)];
const EXPECTED: &str = "expected a time with units (ms, s, m, h, d) such as 90s, 5m or 1h30m";

impl Duration {
    /// Reads a time as [`Duration::parse`] does, or none at all as `0s`.
    ///
    /// # Errors
    /// Those of [`Duration::parse`], but for zero.
    pub fn parse_or_none(text: &str) -> Result<Self, Refusal> {
        if text.trim() == "0s" { Ok(Self(time::Duration::ZERO)) } else { Self::parse(text) }
    }

    /// Reads a sum of numbers with units, largest unit first: `1h30m`, `2.5s`.
    ///
    /// # Errors
    /// If a unit is missing, unknown or out of order, or the sum is zero or beyond all measure.
    pub fn parse(text: &str) -> Result<Self, Refusal> {
        let mut rest = text.trim();
        let (mut seconds, mut last_unit) = (0.0, f64::INFINITY);
        while !rest.is_empty() {
            let digits =
                rest.find(|letter: char| !letter.is_ascii_digit() && letter != '.').unwrap_or(rest.len());
            let (number, tail) = rest.split_at(digits);
            let (unit, per_unit) = UNITS
                .into_iter()
                .find(|(unit, _)| tail.starts_with(unit))
                .ok_or_else(|| missing_unit(text, tail))?;
            if per_unit >= last_unit {
                return Err(format!("{EXPECTED}; in `{text}` the units do not fall"));
            }
            seconds += finite(number).map_err(|_| format!("{EXPECTED}, got `{text}`"))? * per_unit;
            (rest, last_unit) = (&tail[unit.len()..], per_unit);
        }
        match time::Duration::try_from_secs_f64(seconds) {
            Ok(span) if !span.is_zero() => Ok(Self(span)),
            Ok(_) => Err(format!("{EXPECTED}, and longer than nothing, got `{text}`")),
            Err(_) => Err(format!("{EXPECTED}; `{text}` is beyond all measure")),
        }
    }
}

fn missing_unit(text: &str, tail: &str) -> Refusal {
    if tail.is_empty() {
        format!("{EXPECTED}, got `{text}` without a unit")
    } else {
        format!("{EXPECTED}, got `{text}`")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn milliseconds(text: &str) -> u128 {
        Duration::parse(text).expect("valid").0.as_millis()
    }

    #[test]
    fn sums_of_units() {
        assert_eq!(milliseconds("90s"), 90_000);
        assert_eq!(milliseconds("5m"), 300_000);
        assert_eq!(milliseconds("1h30m"), 5_400_000);
        assert_eq!(milliseconds("1h1m1s1ms"), 3_661_001);
        assert_eq!(milliseconds("2.5s"), 2500);
        assert_eq!(milliseconds("500ms"), 500);
        assert_eq!(milliseconds("1d"), 86_400_000);
    }

    #[test]
    fn refusals() {
        for text in [
            "",
            "0s",
            "90",
            "s",
            "-5s",
            "5x",
            "30m1h",
            "5s5s",
            "1h 30m",
            "1..5s",
            "1e9d",
            "99999999999999999999d",
        ] {
            assert!(Duration::parse(text).expect_err(text).contains("90s, 5m or 1h30m"), "{text}");
        }
        assert_eq!(Duration::parse_or_none("0s"), Ok(Duration(time::Duration::ZERO)));
        assert!(Duration::parse_or_none("0").is_err());
        assert!(Duration::parse("90").expect_err("refused").contains("without a unit"));
    }
}
