//! Maps from voxel indices to the world.

use super::cursor::Cursor;
use crate::error::{FileError, Result};

/// Rows of the affine map.
pub fn affine(cursor: &mut Cursor<'_>) -> Result<[[f64; 4]; 3]> {
    let at = cursor.at();
    let name = cursor.text()?;
    let mut vector = || Ok::<_, FileError>([cursor.f64()?, cursor.f64()?, cursor.f64()?]);
    let (scale, translation) = match name.as_str() {
        "UniformScaleMap" | "ScaleMap" => (vector()?, [0.0; 3]),
        "UniformScaleTranslateMap" | "ScaleTranslateMap" => {
            let translation = vector()?;
            (vector()?, translation)
        }
        "TranslationMap" => ([1.0; 3], vector()?),
        "AffineMap" | "UnitaryMap" => return matrix(cursor),
        other => {
            let what = format!("a grid whose voxels lie by a {other}");
            return Err(FileError::unsupported(
                cursor.path(),
                what,
                "resample the grid with an affine transformation",
            ));
        }
    };
    if name != "TranslationMap" {
        // size of a voxel and three vectors made of the scale
        for _ in 0..4 {
            vector()?;
        }
    }
    let mut rows = [[0.0; 4]; 3];
    for k in 0..3 {
        rows[k][k] = scale[k];
        rows[k][3] = translation[k];
    }
    checked(cursor, at, rows)
}

/// A matrix for row vectors: the file's rows are columns here.
fn matrix(cursor: &mut Cursor<'_>) -> Result<[[f64; 4]; 3]> {
    let at = cursor.at();
    let mut rows = [[0.0; 4]; 3];
    for column in 0..4 {
        for row in &mut rows {
            row[column] = cursor.f64()?;
        }
        cursor.f64()?;
    }
    checked(cursor, at, rows)
}

fn checked(cursor: &Cursor<'_>, at: u64, rows: [[f64; 4]; 3]) -> Result<[[f64; 4]; 3]> {
    match rows.iter().flatten().find(|v| !v.is_finite()) {
        None => Ok(rows),
        Some(value) => Err(cursor.bad(at, "a map of finite numbers", value)),
    }
}
