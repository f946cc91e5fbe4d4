//! Names of spectral channels and spectrum strings of the spectral EXR layout.
//!
//! A channel is named `S0.550,000000nm`: Stokes component (`S0` to `S3`, emissive) or `T` (reflective), a
//! point, the wavelength or frequency with a decimal *comma* (the point separates layers in EXR), an optional
//! SI prefix, `m` or `Hz`. A spectrum string is `400nm:0.1;500nm:0.2;`.
//!
//! Source: A. Fichet, R. Pacanowski, A. Wilkie, "An OpenEXR layout for spectral images", JCGT 10(3), 2021.

use super::{Channel, Pixels};
use std::fmt::Write;

/// Speed of light in vacuum, m/s (exact).
const SPEED_OF_LIGHT: f64 = 299_792_458.0;

/// What a spectral channel holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum SpectralKind {
    /// A Stokes component of emissive radiance; 0 is the intensity.
    Stokes(u8),
    /// Reflectance or transmittance, without a unit.
    Reflective,
}

/// A channel of an image that holds one wavelength.
#[derive(Clone, Copy, Debug)]
pub struct SpectralChannel<'a> {
    /// What it holds.
    pub kind: SpectralKind,
    /// Its wavelength in nm.
    pub lambda_nm: f64,
    /// Its samples.
    pub channel: &'a Channel,
}

/// `S0.550,000000nm` for 550 nm: the name of an emissive, unpolarised channel.
pub fn spectral_channel_name(lambda_nm: f64) -> String {
    format!("S0.{lambda_nm:.6}nm").replacen('.', "\u{0}", 1).replace('.', ",").replace('\u{0}', ".")
}

/// The spectral channels of an image, sorted by kind and then by *number*: alphabetically, as EXR stores
/// them, `S0.1000,0nm` comes before `S0.400,0nm`.
pub fn spectral_channels(pixels: &Pixels) -> Vec<SpectralChannel<'_>> {
    let mut found: Vec<_> = pixels
        .channels()
        .iter()
        .filter_map(|channel| {
            let (kind, lambda_nm) = parse_channel_name(&channel.name)?;
            Some(SpectralChannel { kind, lambda_nm, channel })
        })
        .collect();
    found.sort_by(|a, b| a.kind.cmp(&b.kind).then(a.lambda_nm.total_cmp(&b.lambda_nm)));
    found
}

/// Accepts decimal commas and points, and names inside a layer (`part.S0.550,0nm`).
pub(super) fn parse_channel_name(name: &str) -> Option<(SpectralKind, f64)> {
    let start = name
        .char_indices()
        .map(|(i, _)| i)
        .find(|&i| (i == 0 || name[..i].ends_with('.')) && kind_of(&name[i..]).is_some())?;
    let (kind, quantity) = kind_of(&name[start..])?;
    Some((kind, parse_lambda_nm(quantity)?))
}

fn kind_of(name: &str) -> Option<(SpectralKind, &str)> {
    let (prefix, quantity) = name.split_once('.')?;
    let kind = match prefix {
        "S0" => SpectralKind::Stokes(0),
        "S1" => SpectralKind::Stokes(1),
        "S2" => SpectralKind::Stokes(2),
        "S3" => SpectralKind::Stokes(3),
        "T" => SpectralKind::Reflective,
        _ => return None,
    };
    Some((kind, quantity))
}

/// `550,0nm`, `0.55um`, `545THz` to a wavelength in nm.
fn parse_lambda_nm(quantity: &str) -> Option<f64> {
    let (number, is_frequency) = match quantity.strip_suffix("Hz") {
        Some(rest) => (rest, true),
        None => (quantity.strip_suffix('m')?, false),
    };
    let (number, scale) = strip_si_prefix(number);
    let value = parse_number(number)? * scale;
    let metres = if is_frequency { SPEED_OF_LIGHT / value } else { value };
    // 1e-9 is not exact in binary and would turn 550 nm into 550.0000000000001 nm
    let lambda_nm = if !is_frequency && scale == 1e-9 { parse_number(number)? } else { metres * 1e9 };
    (lambda_nm.is_finite() && lambda_nm > 0.0).then_some(lambda_nm)
}

fn strip_si_prefix(number: &str) -> (&str, f64) {
    const PREFIXES: [(&str, f64); 20] = [
        ("da", 1e1), // before `d` and `a`
        ("Y", 1e24),
        ("Z", 1e21),
        ("E", 1e18),
        ("P", 1e15),
        ("T", 1e12),
        ("G", 1e9),
        ("M", 1e6),
        ("k", 1e3),
        ("h", 1e2),
        ("d", 1e-1),
        ("c", 1e-2),
        ("m", 1e-3),
        ("u", 1e-6),
        ("n", 1e-9),
        ("p", 1e-12),
        ("f", 1e-15),
        ("a", 1e-18),
        ("z", 1e-21),
        ("y", 1e-24),
    ];
    PREFIXES
        .iter()
        .find_map(|(prefix, scale)| number.strip_suffix(prefix).map(|rest| (rest, *scale)))
        .unwrap_or((number, 1.0))
}

/// A decimal number with a comma or a point; no `inf`, `nan` or spaces.
fn parse_number(text: &str) -> Option<f64> {
    let plain = text.bytes().all(|b| b.is_ascii_digit() || b",.+-eE".contains(&b));
    let value: f64 = plain.then(|| text.replace(',', ".").parse().ok())??;
    value.is_finite().then_some(value)
}

/// `400.000000nm:0.1;500.000000nm:0.2;` from (wavelength in nm, value) pairs, with the trailing `;`.
pub fn format_spectrum(points: &[(f64, f64)]) -> String {
    points.iter().fold(String::new(), |mut text, (lambda_nm, value)| {
        write!(text, "{lambda_nm:.6}nm:{value};").expect("writing to a string cannot fail");
        text
    })
}

/// The (wavelength in nm, value) pairs of a spectrum string, sorted by wavelength.
///
/// Accepts the string with or without its last `;`, decimal commas or points, and spaces around entries.
/// `None` when an entry does not parse.
pub fn parse_spectrum(text: &str) -> Option<Vec<(f64, f64)>> {
    let mut points = text
        .split(';')
        .map(str::trim)
        .filter(|entry| !entry.is_empty())
        .map(|entry| {
            let (lambda, value) = entry.split_once(':')?;
            Some((parse_lambda_nm(lambda.trim())?, parse_number(value.trim())?))
        })
        .collect::<Option<Vec<_>>>()?;
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    Some(points)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn channel_name_has_a_decimal_comma() {
        assert_eq!(spectral_channel_name(550.0), "S0.550,000000nm");
        assert_eq!(spectral_channel_name(382.5), "S0.382,500000nm");
    }

    #[test]
    fn names_parse_in_every_accepted_form() {
        let nm = |name: &str| parse_channel_name(name).map(|(_, l)| l);
        assert_eq!(nm("S0.550,000000nm"), Some(550.0));
        assert_eq!(nm("S0.550.25nm"), Some(550.25));
        assert_eq!(nm("S0.5,5E2nm"), Some(550.0));
        assert_eq!(nm("layer.part.S3.400,0nm"), Some(400.0));
        assert!((nm("T.0,55um").expect("micrometres") - 550.0).abs() < 1e-9);
        assert!((nm("S0.500THz").expect("frequency") - 599.584916).abs() < 1e-6);
        for bad in ["R", "S4.550nm", "S0.550", "S0.nm", "S0.-550nm", "S0.infnm", "S0.1e999nm", "T", "S0.0nm"]
        {
            assert_eq!(nm(bad), None, "{bad}");
        }
    }

    #[test]
    fn channels_sort_by_number() {
        let mut pixels = Pixels::new(1, 1);
        for name in ["S0.1000,0nm", "S0.400,0nm", "R", "S0.90,0nm"] {
            pixels.push(name, vec![0.0]).expect("one sample");
        }
        let order: Vec<f64> = spectral_channels(&pixels).iter().map(|c| c.lambda_nm).collect();
        assert_eq!(order, [90.0, 400.0, 1000.0]);
    }

    #[test]
    fn spectrum_strings_in_both_forms() {
        let points = vec![(400.0, 0.125), (500.5, 2.0)];
        let text = format_spectrum(&points);
        assert_eq!(text, "400.000000nm:0.125;500.500000nm:2;");
        assert_eq!(parse_spectrum(&text).as_ref(), Some(&points));
        assert_eq!(parse_spectrum("500,5nm:2; 400nm:0,125").as_ref(), Some(&points));
        assert_eq!(parse_spectrum("400nm=1;"), None);
        assert_eq!(parse_spectrum(""), Some(vec![]));
    }
}
