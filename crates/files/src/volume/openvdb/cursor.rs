//! A place in the file that moves on with what is read.

use super::super::bytes::Bytes;
use crate::error::{FileError, Result};
use std::{fmt::Display, path::Path};

/// See the module.
#[derive(Clone, Copy, Debug)]
pub struct Cursor<'d> {
    bytes: Bytes<'d>,
    path: &'d Path,
    at: u64,
}

impl<'d> Cursor<'d> {
    pub fn new(path: &'d Path, data: &'d [u8], at: u64) -> Self {
        Self { bytes: Bytes::new(path, data), path, at }
    }

    pub fn path(&self) -> &'d Path {
        self.path
    }

    pub fn at(&self) -> u64 {
        self.at
    }

    /// Goes to `at`, which must lie in the file or at its end.
    pub fn seek(&mut self, at: u64) -> Result<()> {
        if at > self.bytes.len() {
            return Err(self.bad(self.at, "an offset within the file", at));
        }
        self.at = at;
        Ok(())
    }

    pub fn take(&mut self, count: u64) -> Result<&'d [u8]> {
        let found = self.bytes.slice(self.at, count)?;
        self.at += count;
        Ok(found)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N]> {
        let mut out = [0; N];
        out.copy_from_slice(self.take(N as u64)?);
        Ok(out)
    }

    pub fn u8(&mut self) -> Result<u8> {
        Ok(self.array::<1>()?[0])
    }

    pub fn u32(&mut self) -> Result<u32> {
        self.array().map(u32::from_le_bytes)
    }

    pub fn u64(&mut self) -> Result<u64> {
        self.array().map(u64::from_le_bytes)
    }

    pub fn f64(&mut self) -> Result<f64> {
        self.array().map(f64::from_le_bytes)
    }

    /// Three indices of a voxel.
    pub fn origin(&mut self) -> Result<[i32; 3]> {
        let mut next = || self.array().map(i32::from_le_bytes);
        Ok([next()?, next()?, next()?])
    }

    /// A text with its length in front.
    pub fn text(&mut self) -> Result<String> {
        let length = self.u32()?;
        Ok(String::from_utf8_lossy(self.take(length.into())?).into_owned())
    }

    /// A mask of bits, lowest first.
    pub fn mask(&mut self, bits: usize) -> Result<Mask<'d>> {
        Ok(Mask { bytes: self.take(bits as u64 / 8)? })
    }

    pub fn bad(&self, at: u64, expected: impl Into<String>, got: impl Display) -> FileError {
        self.bytes.bad(at, expected, got)
    }
}

/// Bits of a node.
#[derive(Clone, Copy, Debug)]
pub struct Mask<'d> {
    bytes: &'d [u8],
}

impl Mask<'_> {
    #[inline]
    pub fn has(&self, i: usize) -> bool {
        self.bytes[i / 8] >> (i % 8) & 1 == 1
    }

    pub fn count(&self) -> usize {
        self.bytes.iter().map(|b| b.count_ones() as usize).sum()
    }
}
