//! Leaves: 8^3 values, as they are or quantised between the least and the greatest.
//!
//! A leaf begins with its box (16 bytes) and the mask of active voxels (64 bytes). Quantised ones then have the minimum
//! and the step, and codes from byte 96 on: `value = code step + minimum`.

use crate::{error::Result, volume::bytes::Bytes};

/// How the values of a grid are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Float,
    Double,
    /// Codes of so many bits.
    Fixed(u32),
    /// Codes whose width each leaf tells.
    Variable,
}

/// Voxels of a leaf.
const VOXELS: usize = 512;

impl Kind {
    /// By the number that the format gives a type of grid.
    pub fn find(number: u32) -> Option<Self> {
        match number {
            1 => Some(Self::Float),
            2 => Some(Self::Double),
            13 => Some(Self::Fixed(4)),
            14 => Some(Self::Fixed(8)),
            15 => Some(Self::Fixed(16)),
            16 => Some(Self::Variable),
            _ => None,
        }
    }

    /// Bytes of a value in the nodes above.
    pub fn value_bytes(self) -> u64 {
        if self == Self::Double { 8 } else { 4 }
    }

    /// Fewest bytes of a leaf.
    pub fn leaf_bytes(self) -> u64 {
        match self {
            Self::Float => 96 + 2048,
            Self::Double => 128 + 4096,
            Self::Fixed(bits) => 96 + 64 * u64::from(bits),
            Self::Variable => 96 + 64,
        }
    }

    /// A value of a node above the leaves.
    pub fn value(self, data: &Bytes<'_>, at: u64) -> Result<f32> {
        if self == Self::Double { data.f64(at).map(|v| v as f32) } else { data.f32(at) }
    }

    /// The values of the leaf at `at`.
    pub fn leaf(self, data: &Bytes<'_>, at: u64, out: &mut [f32; VOXELS]) -> Result<()> {
        match self {
            Self::Float => {
                let values = data.slice(at + 96, 2048)?;
                for (o, v) in out.iter_mut().zip(values.as_chunks::<4>().0) {
                    *o = f32::from_le_bytes(*v);
                }
            }
            Self::Double => {
                let values = data.slice(at + 128, 4096)?;
                for (o, v) in out.iter_mut().zip(values.as_chunks::<8>().0) {
                    *o = f64::from_le_bytes(*v) as f32;
                }
            }
            Self::Fixed(bits) => quantised(data, at, bits, out)?,
            Self::Variable => {
                let width = data.u8(at + 15)? >> 5;
                if width > 4 {
                    return Err(data.bad(at + 15, "a width of 1, 2, 4, 8 or 16 bits", format!("2^{width}")));
                }
                quantised(data, at, 1 << width, out)?;
            }
        }
        Ok(())
    }
}

fn quantised(data: &Bytes<'_>, at: u64, bits: u32, out: &mut [f32; VOXELS]) -> Result<()> {
    let (minimum, step) = (data.f32(at + 80)?, data.f32(at + 84)?);
    let codes = data.slice(at + 96, 64 * u64::from(bits))?;
    for (i, o) in out.iter_mut().enumerate() {
        let code = if bits == 16 {
            u16::from_le_bytes([codes[2 * i], codes[2 * i + 1]])
        } else {
            let first = i * bits as usize;
            let mask = (1u16 << bits) - 1;
            u16::from(codes[first / 8]) >> (first % 8) & mask
        };
        *o = f32::from(code) * step + minimum;
    }
    Ok(())
}
