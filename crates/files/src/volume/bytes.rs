//! Little-endian numbers at checked offsets.

use crate::error::{FileError, Place, Result};
use std::{fmt::Display, path::Path};

/// The bytes of a file or of a grid, and the file's name for messages.
#[derive(Clone, Copy, Debug)]
pub struct Bytes<'d> {
    path: &'d Path,
    data: &'d [u8],
}

impl<'d> Bytes<'d> {
    pub fn new(path: &'d Path, data: &'d [u8]) -> Self {
        Self { path, data }
    }

    pub fn path(&self) -> &Path {
        self.path
    }

    pub fn len(&self) -> u64 {
        self.data.len() as u64
    }

    /// `count` bytes from `at` on.
    pub fn slice(&self, at: u64, count: u64) -> Result<&'d [u8]> {
        let end = at.checked_add(count).filter(|&end| end <= self.len());
        match end {
            Some(end) => Ok(&self.data[at as usize..end as usize]),
            None => Err(self.bad(at, format!("{count} bytes"), format!("the end at {}", self.len()))),
        }
    }

    fn array<const N: usize>(&self, at: u64) -> Result<[u8; N]> {
        let mut out = [0; N];
        out.copy_from_slice(self.slice(at, N as u64)?);
        Ok(out)
    }

    pub fn u8(&self, at: u64) -> Result<u8> {
        Ok(self.array::<1>(at)?[0])
    }

    pub fn u16(&self, at: u64) -> Result<u16> {
        self.array(at).map(u16::from_le_bytes)
    }

    pub fn u32(&self, at: u64) -> Result<u32> {
        self.array(at).map(u32::from_le_bytes)
    }

    pub fn u64(&self, at: u64) -> Result<u64> {
        self.array(at).map(u64::from_le_bytes)
    }

    pub fn i32(&self, at: u64) -> Result<i32> {
        self.array(at).map(i32::from_le_bytes)
    }

    pub fn f32(&self, at: u64) -> Result<f32> {
        self.array(at).map(f32::from_le_bytes)
    }

    pub fn f64(&self, at: u64) -> Result<f64> {
        self.array(at).map(f64::from_le_bytes)
    }

    /// `at + offset`, where the sum is an offset of these bytes.
    pub fn follow(&self, at: u64, offset: i64) -> Result<u64> {
        let to = at.checked_add_signed(offset).filter(|&to| to < self.len());
        to.ok_or_else(|| self.bad(at, "an offset within the grid", offset))
    }

    /// The error that something at `at` is not as expected.
    pub fn bad(&self, at: u64, expected: impl Into<String>, got: impl Display) -> FileError {
        FileError::Malformed {
            path: self.path.into(),
            place: Place::Byte(at),
            expected: expected.into(),
            got: got.to_string(),
            hint: "the file is damaged or cut off; copy or export it again".into(),
        }
    }
}
