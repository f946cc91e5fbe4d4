//! Lens files of pbrt: one interface a row, from the scene to the film.
//!
//! Four numbers each: radius of curvature \[mm\] (0 for the aperture stop, positive where the centre lies towards the film),
//! distance to the next interface \[mm\], index of refraction behind the interface, diameter \[mm\]. `#` begins a comment.

use crate::{FileError, Place, Result};
use std::path::Path;

/// One row of a lens file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LensRow {
    /// Radius of curvature \[mm\]; 0 for the stop.
    pub radius: f64,
    /// Distance to the next interface towards the film \[mm\].
    pub thickness: f64,
    /// Index of refraction behind the interface; 0 or 1 for air.
    pub eta: f64,
    /// Diameter \[mm\].
    pub diameter: f64,
}

/// Reads a lens file.
///
/// # Errors
/// [`FileError::Io`] when it cannot be read; [`FileError::Malformed`] with the line where it is not a lens.
pub fn read_lens(path: &Path) -> Result<Vec<LensRow>> {
    let bytes = std::fs::read(path).map_err(|e| FileError::io(path, "read", e))?;
    decode_lens(&String::from_utf8_lossy(&bytes), path)
}

/// Reads the text of a lens file; `path` is for messages.
///
/// # Errors
/// [`FileError::Malformed`], as for [`read_lens`].
pub fn decode_lens(text: &str, path: &Path) -> Result<Vec<LensRow>> {
    let wrong = |line: u64, expected: &str, got: String| {
        let hint = "rows hold radius of curvature, thickness, index of refraction and diameter, in mm";
        FileError::malformed(path, Place::Line(line), expected, got, hint)
    };
    let mut numbers: Vec<(u64, f64)> = Vec::new();
    for (line, text) in (1..).zip(text.lines()) {
        let text = text.split('#').next().unwrap_or_default();
        for word in text.split_whitespace() {
            let value = word.parse::<f64>().ok().filter(|v| v.is_finite());
            numbers.push((line, value.ok_or_else(|| wrong(line, "a number", format!("\"{word}\"")))?));
        }
    }
    let last = numbers.last().map_or(1, |n| n.0);
    if numbers.is_empty() || !numbers.len().is_multiple_of(4) {
        return Err(wrong(last, "rows of four numbers", format!("{} numbers in all", numbers.len())));
    }
    let row = |n: &[(u64, f64); 4]| {
        let [(line, radius), (_, thickness), (_, eta), (_, diameter)] = *n;
        if thickness < 0.0 {
            return Err(wrong(line, "a thickness >= 0", thickness.to_string()));
        }
        if eta != 0.0 && !(1.0..=10.0).contains(&eta) {
            return Err(wrong(line, "an index of refraction from 1 to 10, or 0 for air", eta.to_string()));
        }
        if diameter <= 0.0 {
            return Err(wrong(line, "a diameter > 0", diameter.to_string()));
        }
        Ok(LensRow { radius, thickness, eta, diameter })
    };
    numbers.as_chunks::<4>().0.iter().map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<LensRow>> {
        decode_lens(text, Path::new("lens.dat"))
    }

    #[test]
    fn rows_and_comments() {
        let rows = read("# a singlet\n50 1.5 1.5 20 # front\n\n0 2 0 8\n-50 45 1 20\n").expect("valid");
        assert_eq!(rows.len(), 3);
        assert_eq!(rows[1], LensRow { radius: 0.0, thickness: 2.0, eta: 0.0, diameter: 8.0 });
    }

    #[test]
    fn what_is_no_lens_is_refused_with_its_line() {
        for (text, line, why) in [
            ("", 1, "four numbers"),
            ("50 1 1.5", 1, "four numbers"),
            ("50 1 1.5 20\n-50 x 1 20", 2, "a number"),
            ("50 1 1.5 20\n-50 -1 1 20", 2, "thickness"),
            ("50 1 0.5 20", 1, "index"),
            ("\n50 1 1.5 0", 2, "diameter"),
            ("50 inf 1.5 1", 1, "a number"),
        ] {
            let message = read(text).expect_err(text).to_string();
            assert!(message.contains(why), "{text}: {message}");
            assert!(message.contains(&format!("lens.dat:{line}:")), "{text}: {message}");
        }
    }
}
