//! IES LM-63 files: luminous intensities of measured luminaires over directions (type C photometry).
//!
//! Own code: the format is a page of numbers, and a reader here must say which line is wrong. Layout: IESNA LM-63-2002.

use crate::{FileError, Place, Result, limits::justify};
use std::path::Path;

/// Intensities over vertical and horizontal angles, whatever symmetry the file uses unfolded.
#[derive(Clone, Debug, PartialEq)]
pub struct IesProfile {
    /// Vertical angles from the nadir, ascending \[degrees\].
    pub vertical: Vec<f32>,
    /// Horizontal angles from 0 to 360, ascending \[degrees\].
    pub horizontal: Vec<f32>,
    /// Candela, vertical angles fastest, multipliers and ballast factor included.
    pub candela: Vec<f32>,
}

/// Reads an IES file.
///
/// # Errors
/// [`FileError::Io`] when it cannot be read; [`FileError::Malformed`] with the line where it is damaged;
/// [`FileError::Unsupported`] for photometry of type A or B.
pub fn read_ies(path: &Path) -> Result<IesProfile> {
    let bytes = std::fs::read(path).map_err(|e| FileError::io(path, "read", e))?;
    decode_ies(&String::from_utf8_lossy(&bytes), path)
}

/// Reads the text of an IES file; `path` is for messages.
///
/// # Errors
/// Those of [`read_ies`].
pub fn decode_ies(text: &str, path: &Path) -> Result<IesProfile> {
    let mut source = Source::after_tilt(text, path)?;
    let _lamps = source.number("number of lamps")?;
    let _lumens = source.number("lumens per lamp")?;
    let factor = source.number("candela multiplier")?;
    let rows = source.count("number of vertical angles")?;
    let columns = source.count("number of horizontal angles")?;
    justify(path, "intensities", rows as u128 * columns as u128, text.len() as u64, 1)?;
    if source.number("photometric type")? != 1.0 {
        return Err(FileError::Unsupported {
            path: path.to_path_buf(),
            feature: "photometry of type A or B".into(),
            hint: "convert the file to type C, which most luminaires have".into(),
        });
    }
    for what in ["units", "width", "length", "height"] {
        source.number(what)?;
    }
    let ballast = source.number("ballast factor")?;
    for what in ["reserved number", "input watts"] {
        source.number(what)?;
    }
    let vertical = source.angles(rows, "vertical angles", [0.0, 180.0])?;
    let horizontal = source.angles(columns, "horizontal angles", [0.0, 360.0])?;
    let mut candela = Vec::with_capacity(rows * columns);
    for _ in 0..rows * columns {
        let value = source.number("candela value")?;
        if value < 0.0 {
            return Err(source.wrong("a candela value >= 0", &value.to_string()));
        }
        let product = value * factor * ballast;
        if !(product >= 0.0 && product.is_finite()) {
            return Err(source.wrong(
                "a candela value that is finite and >= 0 with its multipliers",
                &product.to_string(),
            ));
        }
        candela.push(product);
    }
    unfold(IesProfile { vertical, horizontal, candela }).ok_or_else(|| {
        source.wrong("horizontal angles from 0 to 0, 90, 180 or 360, or from 90 to 270", "others")
    })
}

/// Repeats what symmetry leaves out.
fn unfold(p: IesProfile) -> Option<IesProfile> {
    let rows = p.vertical.len();
    let ends = (*p.horizontal.first()?, *p.horizontal.last()?);
    let column = |k: usize| p.candela[k * rows..(k + 1) * rows].to_vec();
    let mut columns: Vec<(f32, Vec<f32>)> = p.horizontal.iter().copied().zip((0..).map(column)).collect();
    let mirror = |about: f32, columns: &mut Vec<(f32, Vec<f32>)>| {
        let images: Vec<_> = columns.iter().rev().map(|(h, c)| (2.0 * about - h, c.clone())).collect();
        columns.extend(images.into_iter().filter(|(h, _)| *h > about));
    };
    match ends {
        (0.0, 0.0) => columns.push((360.0, column(0))),
        (0.0, 90.0) => {
            mirror(90.0, &mut columns);
            mirror(180.0, &mut columns);
        }
        (0.0, 180.0) => mirror(180.0, &mut columns),
        (90.0, 270.0) => {
            // the other half is this one seen in the plane of 90 and 270 degrees
            let back: Vec<_> = columns.iter().map(|(h, c)| ((540.0 - h) % 360.0, c.clone())).collect();
            columns.extend(back.into_iter().filter(|(h, _)| *h < 90.0 || *h > 270.0));
            columns.sort_by(|a, b| a.0.total_cmp(&b.0));
            let first = columns.first()?.1.clone();
            columns.push((360.0, first));
        }
        (0.0, 360.0) => {}
        _ => return None,
    }
    let horizontal = columns.iter().map(|c| c.0).collect();
    let candela = columns.into_iter().flat_map(|c| c.1).collect();
    Some(IesProfile { horizontal, candela, ..p })
}

/// Numbers of the file with their lines.
struct Source<'a> {
    words: Box<dyn Iterator<Item = (u64, &'a str)> + 'a>,
    line: u64,
    path: &'a Path,
}

impl<'a> Source<'a> {
    /// Skips labels and the tilt.
    fn after_tilt(text: &'a str, path: &'a Path) -> Result<Self> {
        let lines: Vec<&str> = text.lines().collect();
        let tilt = lines.iter().position(|l| l.trim_start().to_ascii_uppercase().starts_with("TILT="));
        let Some(tilt) = tilt else {
            return Err(FileError::Malformed {
                path: path.to_path_buf(),
                place: Place::File,
                expected: "a line that begins with TILT=".into(),
                got: "none".into(),
                hint: "is it an IES file (LM-63)?".into(),
            });
        };
        let rest = lines.into_iter().enumerate().skip(tilt + 1);
        let words = rest.flat_map(|(k, l)| {
            l.split(|c: char| c.is_whitespace() || c == ',')
                .filter(|w| !w.is_empty())
                .map(move |w| (k as u64 + 1, w))
        });
        let mut source = Self { words: Box::new(words), line: tilt as u64 + 1, path };
        let how = text.lines().nth(tilt).unwrap_or_default();
        if how.trim().to_ascii_uppercase().ends_with("INCLUDE") {
            source.number("lamp orientation")?;
            let pairs = source.count("number of tilt angles")?;
            for _ in 0..2 * pairs {
                source.number("tilt angle or factor")?;
            }
        }
        Ok(source)
    }

    fn wrong(&self, expected: &str, got: &str) -> FileError {
        FileError::Malformed {
            path: self.path.to_path_buf(),
            place: Place::Line(self.line),
            expected: expected.into(),
            got: got.into(),
            hint: "the layout is that of IESNA LM-63".into(),
        }
    }

    fn number(&mut self, what: &str) -> Result<f32> {
        let Some((line, word)) = self.words.next() else {
            return Err(self.wrong(what, "the end of the file"));
        };
        self.line = line;
        let value = word.parse::<f32>().ok().filter(|v| v.is_finite());
        value.ok_or_else(|| self.wrong(what, &format!("\"{word}\"")))
    }

    fn count(&mut self, what: &str) -> Result<usize> {
        let value = self.number(what)?;
        if (1.0..=65536.0).contains(&value) && value.fract() == 0.0 {
            return Ok(value as usize);
        }
        Err(self.wrong(what, &value.to_string()))
    }

    fn angles(&mut self, count: usize, what: &str, [low, high]: [f32; 2]) -> Result<Vec<f32>> {
        let mut angles: Vec<f32> = Vec::new();
        for _ in 0..count {
            let angle = self.number(what)?;
            let ascends = angles.last().is_none_or(|last| angle > *last);
            if !ascends || !(low..=high).contains(&angle) {
                return Err(
                    self.wrong(&format!("{what} from {low} to {high}, ascending"), &angle.to_string())
                );
            }
            angles.push(angle);
        }
        Ok(angles)
    }
}
