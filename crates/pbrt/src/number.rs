//! Numbers from text: one pass, correctly rounded, finite.
//!
//! Short decimals (mantissa below 2^53, power of ten within +-22) are exact by one multiplication or division
//! (Clinger, *How to read floating point numbers accurately*, 1990); the rest go through the standard library.
//! `f64` results are such that `value as f32` is the `f32` nearest to the *text*: where the nearest `f64` would fall
//! on the midpoint of two `f32` that the text is not on, it is moved by one unit in its last place.

/// Powers of ten that `f64` holds exactly.
const POW10: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18,
    1e19, 1e20, 1e21, 1e22,
];

/// Why a word is no usable number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NumberError {
    /// Not a number at all.
    Malformed,
    /// `nan`, `inf` and their kin.
    NotFinite,
    /// Beyond the range of `f32` (or `i32`).
    OutOfRange,
    /// A fraction where an integer belongs.
    Fraction,
}

/// Whether a byte ends a bare word.
#[inline(always)]
pub(crate) fn is_delimiter(byte: u8) -> bool {
    byte <= b' ' || matches!(byte, b'"' | b'[' | b']' | b'#')
}

/// A decimal read so far: `mantissa * 10^exponent`, exact if `digits <= 19`.
struct Decimal {
    negative: bool,
    mantissa: u64,
    exponent: i32,
    digits: usize,
    end: usize,
}

/// Reads sign, digits, point and exponent from `pos`; none if there is no digit or the exponent is malformed.
#[inline(always)]
fn scan_decimal(bytes: &[u8], pos: usize) -> Option<Decimal> {
    let mut i = pos;
    let negative = bytes.get(i) == Some(&b'-');
    i += usize::from(matches!(bytes.get(i), Some(b'-' | b'+')));
    let mut mantissa = 0u64;
    let start = i;
    i = scan_digits(bytes, i, &mut mantissa);
    let mut digits = i - start;
    let mut exponent = 0;
    if bytes.get(i) == Some(&b'.') {
        let fraction = i + 1;
        i = scan_digits(bytes, fraction, &mut mantissa);
        digits += i - fraction;
        exponent = -i32::try_from(i - fraction).ok()?;
    }
    if digits == 0 {
        return None;
    }
    if matches!(bytes.get(i), Some(b'e' | b'E')) {
        let (value, end) = scan_exponent(bytes, i + 1)?;
        exponent = exponent.saturating_add(value);
        i = end;
    }
    Some(Decimal { negative, mantissa, exponent, digits, end: i })
}

/// Reads digits into the mantissa (which wraps after 19 of them; the caller counts).
#[inline(always)]
fn scan_digits(bytes: &[u8], mut i: usize, mantissa: &mut u64) -> usize {
    while let Some(&b) = bytes.get(i) {
        let digit = b.wrapping_sub(b'0');
        if digit > 9 {
            break;
        }
        *mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(digit));
        i += 1;
    }
    i
}

/// Reads the exponent after `e`: optional sign, at least one digit.
#[inline]
fn scan_exponent(bytes: &[u8], mut i: usize) -> Option<(i32, usize)> {
    let negative = bytes.get(i) == Some(&b'-');
    i += usize::from(matches!(bytes.get(i), Some(b'-' | b'+')));
    let start = i;
    let mut value = 0i32;
    while let Some(b @ b'0'..=b'9') = bytes.get(i) {
        value = value.saturating_mul(10).saturating_add(i32::from(b - b'0'));
        i += 1;
    }
    (i > start).then_some((if negative { -value } else { value }, i))
}

/// The `f64` nearest to the decimal, by the exact fast path.
#[inline(always)]
fn fast_f64(d: &Decimal) -> Option<f64> {
    let exact = d.digits <= 19 && d.mantissa <= 1 << 53 && d.exponent.unsigned_abs() <= 22;
    exact.then(|| scaled(d))
}

/// `mantissa * 10^exponent` for exponents within +-22, by one rounding of the mantissa and one of the result.
#[inline(always)]
fn scaled(d: &Decimal) -> f64 {
    let power = POW10[d.exponent.unsigned_abs() as usize];
    let mantissa = d.mantissa as f64;
    let value = if d.exponent < 0 { mantissa / power } else { mantissa * power };
    if d.negative { -value } else { value }
}

/// Whether an `f64` lies half way between two neighbouring normal `f32`.
#[inline(always)]
pub(crate) fn is_f32_midpoint(value: f64) -> bool {
    value.to_bits() & 0x1FFF_FFFF == 0x1000_0000
}

/// Reads one number at `pos` that ends at a delimiter; gives the value and the position after it.
#[inline(always)]
pub(crate) fn scan_f64(bytes: &[u8], pos: usize) -> Result<(f64, usize), NumberError> {
    if let Some(d) = scan_decimal(bytes, pos)
        && bytes.get(d.end).is_none_or(|&b| is_delimiter(b))
        && let Some(value) = fast_f64(&d)
        && !is_f32_midpoint(value)
    {
        return Ok((value, d.end));
    }
    scan_slowly(bytes, pos)
}

/// Reads one number at `pos` that ends at a delimiter, for lists that keep `f32` only.
///
/// A mantissa of up to 19 digits is taken as the nearest `f64` and scaled, which is off by less than two units in the
/// last place of `f64`: enough to round to the right `f32` anywhere but close to the midpoint of two of them.
#[inline(always)]
pub(crate) fn scan_f32(bytes: &[u8], pos: usize) -> Result<(f32, usize), NumberError> {
    if let Some(d) = scan_decimal(bytes, pos)
        && bytes.get(d.end).is_none_or(|&b| is_delimiter(b))
        && d.digits <= 19
        && d.exponent.unsigned_abs() <= 22
    {
        let value = scaled(&d);
        let to_midpoint = (value.to_bits() & 0x1FFF_FFFF).abs_diff(0x1000_0000);
        let normal = f64::from(f32::MIN_POSITIVE)..1e38;
        if to_midpoint > 4 && (d.mantissa == 0 || normal.contains(&value.abs())) {
            return Ok((value as f32, d.end));
        }
    }
    scan_slowly(bytes, pos).map(|(value, end)| (value as f32, end))
}

/// Everything that the fast path leaves: long mantissas, large exponents, hexadecimals, midpoints, nonsense.
#[cold]
fn scan_slowly(bytes: &[u8], pos: usize) -> Result<(f64, usize), NumberError> {
    let end = bytes[pos..].iter().position(|&b| is_delimiter(b)).map_or(bytes.len(), |n| pos + n);
    let word = std::str::from_utf8(&bytes[pos..end]).map_err(|_| NumberError::Malformed)?;
    parse_f64(word).map(|value| (value, end))
}

/// Parses a word as a finite number whose magnitude `f32` can hold.
pub(crate) fn parse_f64(word: &str) -> Result<f64, NumberError> {
    let digits = word.trim_start_matches(['-', '+']);
    if digits.starts_with(['n', 'N', 'i', 'I']) {
        let special = ["nan", "inf", "infinity"].iter().any(|s| digits.eq_ignore_ascii_case(s));
        return Err(if special { NumberError::NotFinite } else { NumberError::Malformed });
    }
    let value = match parse_hex(word) {
        Some(value) => value,
        None => word.parse::<f64>().map_err(|_| NumberError::Malformed)?,
    };
    if value.abs() > f64::from(f32::MAX) {
        return Err(NumberError::OutOfRange);
    }
    Ok(if is_f32_midpoint(value) { off_midpoint(word, value) } else { value })
}

/// pbrt reads hexadecimal integers; so do we.
fn parse_hex(word: &str) -> Option<f64> {
    let (negative, rest) = match word.strip_prefix('-') {
        Some(rest) => (true, rest),
        None => (false, word.strip_prefix('+').unwrap_or(word)),
    };
    let digits = rest.strip_prefix("0x").or_else(|| rest.strip_prefix("0X"))?;
    let value = u32::from_str_radix(digits, 16).ok()? as f64;
    Some(if negative { -value } else { value })
}

/// Moves a midpoint by one last place where the text itself rounds the other way.
fn off_midpoint(word: &str, value: f64) -> f64 {
    match word.parse::<f32>() {
        Ok(nearest) if nearest != value as f32 => {
            if f64::from(nearest) > value {
                value.next_up()
            } else {
                value.next_down()
            }
        }
        _ => value,
    }
}

/// Reads one integer at `pos` that ends at a delimiter. `Ok` carries whether it was written as a whole `float`.
#[inline(always)]
pub(crate) fn scan_i32(bytes: &[u8], pos: usize) -> Result<(i32, usize, bool), NumberError> {
    let mut i = pos;
    let negative = bytes.get(i) == Some(&b'-');
    i += usize::from(matches!(bytes.get(i), Some(b'-' | b'+')));
    let start = i;
    let mut magnitude = 0u64;
    i = scan_digits(bytes, i, &mut magnitude);
    if i == start || i - start > 18 || bytes.get(i).is_some_and(|&b| !is_delimiter(b)) {
        return scan_whole_float(bytes, pos);
    }
    let value = if negative { -(magnitude as i64) } else { magnitude as i64 };
    let value = i32::try_from(value).map_err(|_| NumberError::OutOfRange)?;
    Ok((value, i, false))
}

/// An integer written as `1.0` or `1e3`.
#[cold]
fn scan_whole_float(bytes: &[u8], pos: usize) -> Result<(i32, usize, bool), NumberError> {
    let (value, end) = scan_f64(bytes, pos)?;
    if value.floor() != value {
        return Err(NumberError::Fraction);
    }
    if value < f64::from(i32::MIN) || value > f64::from(i32::MAX) {
        return Err(NumberError::OutOfRange);
    }
    Ok((value as i32, end, true))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn f(word: &str) -> Result<f64, NumberError> {
        scan_f64(word.as_bytes(), 0).map(|(v, end)| {
            assert_eq!(end, word.len());
            v
        })
    }

    #[test]
    fn numbers_of_every_spelling() {
        for (word, value) in [
            ("0", 0.0),
            ("1", 1.0),
            ("-1.5", -1.5),
            ("+.25", 0.25),
            ("3.", 3.0),
            ("1e3", 1e3),
            ("1E-3", 1e-3),
            ("0.1", 0.1),
            ("123456789012345678901234567890", 123456789012345678901234567890.0),
            ("1e-320", 1e-320),
            ("0x1F", 31.0),
            ("-0x10", -16.0),
            ("0.000000000000000000000000000000001", 1e-33),
        ] {
            assert_eq!(f(word), Ok(value), "{word}");
        }
        assert!(f("-0").unwrap().is_sign_negative());
    }

    #[test]
    fn words_that_are_no_numbers() {
        for (word, error) in [
            ("", NumberError::Malformed),
            ("-", NumberError::Malformed),
            (".", NumberError::Malformed),
            ("1e", NumberError::Malformed),
            ("1.2.3", NumberError::Malformed),
            ("1,5", NumberError::Malformed),
            ("nope", NumberError::Malformed),
            ("nan", NumberError::NotFinite),
            ("-inf", NumberError::NotFinite),
            ("Infinity", NumberError::NotFinite),
            ("1e39", NumberError::OutOfRange),
            ("-1e999", NumberError::OutOfRange),
        ] {
            assert_eq!(f(word), Err(error), "{word}");
        }
    }

    #[test]
    fn integers() {
        let i = |word: &str| scan_i32(word.as_bytes(), 0).map(|(v, _, float)| (v, float));
        assert_eq!(i("-2147483648"), Ok((i32::MIN, false)));
        assert_eq!(i("2147483647 "), Ok((i32::MAX, false)));
        assert_eq!(i("2147483648"), Err(NumberError::OutOfRange));
        assert_eq!(i("99999999999999999999999999"), Err(NumberError::OutOfRange));
        assert_eq!(i("16.0"), Ok((16, true)));
        assert_eq!(i("1e3"), Ok((1000, true)));
        assert_eq!(i("1.5"), Err(NumberError::Fraction));
        assert_eq!(i("x"), Err(NumberError::Malformed));
    }

    /// 1 + 2^-24 is the midpoint of 1 and the next f32; a text just above it must round up in both steps.
    #[test]
    fn no_double_rounding() {
        let above = "1.00000005960464477539062500000000000001";
        assert_eq!(above.parse::<f64>().unwrap() as f32, 1.0, "the trap is there");
        assert_eq!(f(above).unwrap() as f32, above.parse::<f32>().unwrap());
        assert_eq!(scan_f32(above.as_bytes(), 0).unwrap().0, above.parse::<f32>().unwrap());
        let close = "1.000000059604644776";
        assert_eq!(scan_f32(close.as_bytes(), 0).unwrap().0, close.parse::<f32>().unwrap());
        let tie = "1.000000059604644775390625";
        assert_eq!(f(tie).unwrap() as f32, 1.0);
    }

    proptest! {
        #[test]
        fn agrees_with_the_standard_library(mantissa in any::<i64>(), point in 0usize..20, e in -30i32..15) {
            let mut word = mantissa.unsigned_abs().to_string();
            word.insert(point.min(word.len()), '.');
            let word = format!("{}{word}e{e}", if mantissa < 0 { "-" } else { "" });
            let ours = f(&word).unwrap();
            let std: f64 = word.parse().unwrap();
            prop_assert!((ours - std).abs() <= (std.next_up() - std).abs());
            prop_assert_eq!(ours as f32, word.parse::<f32>().unwrap());
            prop_assert_eq!(scan_f32(word.as_bytes(), 0), Ok((word.parse::<f32>().unwrap(), word.len())));
        }
    }
}
