//! Tensor files (`.bsdf`) of the RGL material database: named arrays of numbers.
//!
//! The mark `tensor_file`, a zero, the version (1, 0), the number of fields; then for each its name, rank, type, offset in
//! the file and shape. Dupuy, Jakob 2018. Arrays of 32-bit floats are read, others left alone.

use crate::{FileError, Place, Result};
use std::{collections::BTreeMap, path::Path, path::PathBuf};

const MARK: &[u8] = b"tensor_file\0";
const FLOAT: u8 = 10;
/// More dimensions than any field has.
const MOST: usize = 8;

/// An array, its last index fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Entries along each dimension.
    pub shape: Vec<usize>,
    /// All entries.
    pub values: Vec<f32>,
}

/// The arrays of floats of a file.
#[derive(Clone, Debug)]
pub struct Tensors {
    path: PathBuf,
    fields: BTreeMap<String, Field>,
}

impl Tensors {
    /// The field `name`, which must have `rank` dimensions.
    ///
    /// # Errors
    /// [`FileError::Malformed`] when it is not there, or has another rank.
    pub fn field(&self, name: &str, rank: usize) -> Result<&Field> {
        let wrong = |got: String| {
            let expected = format!("a field \"{name}\" of floats with {rank} dimensions");
            FileError::malformed(
                &self.path,
                Place::File,
                expected,
                got,
                "is it a material of the RGL database?",
            )
        };
        let field = self.fields.get(name).ok_or_else(|| wrong("none".into()))?;
        if field.shape.len() != rank {
            return Err(wrong(format!("{} dimensions", field.shape.len())));
        }
        Ok(field)
    }
}

/// Reads a tensor file.
///
/// # Errors
/// [`FileError::Io`] when it cannot be read; [`FileError::Malformed`] with the byte where it is damaged.
pub fn read_tensors(path: &Path) -> Result<Tensors> {
    let bytes = std::fs::read(path).map_err(|e| FileError::io(path, "read", e))?;
    decode_tensors(&bytes, path)
}

/// Reads the bytes of a tensor file; `path` is for messages.
///
/// # Errors
/// Those of [`read_tensors`].
pub fn decode_tensors(bytes: &[u8], path: &Path) -> Result<Tensors> {
    let mut source = Source { bytes, at: 0, path };
    if source.take(MARK.len())? != MARK {
        return Err(source.wrong(0, "the mark of a tensor file", "something else"));
    }
    let version = source.take(2)?;
    if version != [1, 0] {
        return Err(source.wrong(12, "version 1.0", &format!("{}.{}", version[0], version[1])));
    }
    let count = source.number(4)?;
    let mut fields = BTreeMap::new();
    let mut room = bytes.len();
    for _ in 0..count {
        let length = source.number(2)? as usize;
        let name = String::from_utf8_lossy(source.take(length)?).into_owned();
        let at = source.at;
        let rank = source.number(2)? as usize;
        if rank > MOST {
            return Err(source.wrong(at, "at most 8 dimensions", &rank.to_string()));
        }
        let kind = source.number(1)? as u8;
        let offset = source.number(8)?;
        let shape = (0..rank).map(|_| source.number(8)).collect::<Result<Vec<u64>>>()?;
        if kind == FLOAT {
            let values = source.floats(offset, &shape)?;
            // arrays that lie over each other would ask for more memory than the file has
            room = room
                .checked_sub(4 * values.len())
                .ok_or_else(|| source.wrong(at, "arrays that together fit into the file", "more"))?;
            fields.insert(name, Field { shape: shape.iter().map(|n| *n as usize).collect(), values });
        }
    }
    Ok(Tensors { path: path.to_path_buf(), fields })
}

/// Bytes and the place in them.
struct Source<'a> {
    bytes: &'a [u8],
    at: usize,
    path: &'a Path,
}

impl<'a> Source<'a> {
    fn wrong(&self, at: usize, expected: &str, got: &str) -> FileError {
        let hint = "the file is damaged, cut off, or no tensor file; copy it again";
        FileError::malformed(self.path, Place::Byte(at as u64), expected, got, hint)
    }

    fn take(&mut self, count: usize) -> Result<&'a [u8]> {
        let found = self.at.checked_add(count).and_then(|end| self.bytes.get(self.at..end));
        let found =
            found.ok_or_else(|| self.wrong(self.at, &format!("{count} bytes"), "the end of the file"))?;
        self.at += count;
        Ok(found)
    }

    /// An unsigned number of `size` bytes.
    fn number(&mut self, size: usize) -> Result<u64> {
        Ok(self.take(size)?.iter().rev().fold(0, |n, b| n << 8 | u64::from(*b)))
    }

    fn floats(&self, offset: u64, shape: &[u64]) -> Result<Vec<f32>> {
        let size = shape.iter().try_fold(4u64, |n, s| n.checked_mul(*s));
        let found = size.and_then(|size| {
            let end = offset.checked_add(size)?;
            self.bytes.get(usize::try_from(offset).ok()?..usize::try_from(end).ok()?)
        });
        let found = found.ok_or_else(|| {
            self.wrong(self.at, "an array within the file", &format!("{shape:?} floats at {offset}"))
        })?;
        Ok(found.as_chunks::<4>().0.iter().map(|b| f32::from_le_bytes(*b)).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(kind: u8, rank: u16, offset: u64) -> Vec<u8> {
        let mut out = [MARK, &[1, 0], &1u32.to_le_bytes(), &3u16.to_le_bytes(), b"ndf"].concat();
        out.extend(rank.to_le_bytes());
        out.push(kind);
        out.extend(offset.to_le_bytes());
        out.extend([2u64, 3].iter().flat_map(|n| n.to_le_bytes()));
        out.extend((0..6).flat_map(|i| (i as f32).to_le_bytes()));
        out
    }

    /// Where the values of [`file`] begin.
    const VALUES: u64 = 12 + 2 + 4 + 2 + 3 + 2 + 1 + 8 + 16;

    #[test]
    fn arrays_come_back() {
        let path = Path::new("gold.bsdf");
        let tensors = decode_tensors(&file(FLOAT, 2, VALUES), path).expect("valid");
        let field = tensors.field("ndf", 2).expect("present");
        assert_eq!((field.shape.as_slice(), field.values.len()), ([2, 3].as_slice(), 6));
        assert_eq!(field.values[4], 4.0);
        assert!(tensors.field("ndf", 1).is_err() && tensors.field("sigma", 2).is_err());
        assert!(decode_tensors(&file(1, 2, VALUES), path).expect("valid").field("ndf", 2).is_err());
    }

    #[test]
    fn damage_is_refused() {
        let path = Path::new("gold.bsdf");
        for bytes in [
            b"tensor".to_vec(),
            vec![0; 64],
            file(FLOAT, 9, VALUES),
            file(FLOAT, 2, VALUES + 1),
            file(FLOAT, 2, u64::MAX),
        ] {
            assert!(decode_tensors(&bytes, path).is_err());
        }
        let whole = file(FLOAT, 2, VALUES);
        for end in 0..whole.len() {
            assert!(decode_tensors(&whole[..end], path).is_err(), "{end}");
        }
    }
}
