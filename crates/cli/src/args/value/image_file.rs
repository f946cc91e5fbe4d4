//! A file to write, whose ending tells its format.

use std::path::PathBuf;

use super::Refusal;

/// Format of a file to write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FileKind {
    /// OpenEXR, linear, all channels.
    Exr,
    /// PNG, for the eye.
    Png,
    /// Table of pixels, units in its header.
    Csv,
    /// NetCDF: the spectral cube with its errors.
    Netcdf,
    /// The film itself, with everything needed to go on or to merge.
    Film,
}

/// Endings and what they mean.
const ENDINGS: [(&str, FileKind); 5] = [
    ("exr", FileKind::Exr),
    ("png", FileKind::Png),
    ("csv", FileKind::Csv),
    ("nc", FileKind::Netcdf),
    ("film", FileKind::Film),
];

impl FileKind {
    /// Whether it holds rows of numbers.
    pub const fn is_table(self) -> bool {
        matches!(self, Self::Csv)
    }
}

/// A file to write.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ImageFile {
    /// Where.
    pub path: PathBuf,
    /// In which format.
    pub kind: FileKind,
}

impl ImageFile {
    /// Tells the format by the ending, in upper or lower case.
    ///
    /// # Errors
    /// If the ending is none of those known.
    pub fn parse(text: &str) -> Result<Self, Refusal> {
        let path = PathBuf::from(text);
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
        let ending = ending.filter(|_| !text.ends_with('/'));
        let kind =
            ENDINGS.into_iter().find(|(known, _)| Some(*known) == ending.as_deref()).map(|(_, kind)| kind);
        kind.map(|kind| Self { path, kind }).ok_or_else(|| {
            let known = ENDINGS.map(|(ending, _)| format!(".{ending}")).join(", ");
            format!("expected a file whose name ends with one of {known}, got `{text}`")
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ending_tells() {
        let kind = |text: &str| ImageFile::parse(text).map(|file| file.kind);
        assert_eq!(kind("out/a.exr"), Ok(FileKind::Exr));
        assert_eq!(kind("A.PNG"), Ok(FileKind::Png));
        assert_eq!(kind("a.1-of-3.film"), Ok(FileKind::Film));
        for text in ["", "exr", ".exr", "a", "a.jpg", "a.exr/"] {
            assert!(kind(text).expect_err(text).contains(".exr, .png"), "{text}");
        }
    }
}
