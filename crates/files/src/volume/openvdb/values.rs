//! Values of a node: which are stored, how they are packed, and what the others are.

use super::{
    super::blosc,
    cursor::{Cursor, Mask},
};
use crate::error::Result;
use std::io::Read;

/// How values stand in the file.
#[derive(Clone, Copy, Debug)]
pub struct Stored {
    /// 64 bits, else 32.
    pub double: bool,
    /// Values of nodes in 16 bits; background and tiles of the root are not.
    pub half: bool,
}

impl Stored {
    /// Bytes of a value on its own.
    fn lone(self) -> u64 {
        if self.double { 8 } else { 4 }
    }

    /// Bytes of a value of a node.
    fn packed(self) -> usize {
        if self.half { 2 } else { self.lone() as usize }
    }

    /// A value on its own: the background, an inactive value, a tile of the root.
    pub fn value(self, cursor: &mut Cursor<'_>) -> Result<f32> {
        Ok(number(cursor.take(self.lone())?))
    }
}

fn number(bytes: &[u8]) -> f32 {
    match *bytes {
        [a, b] => half::f16::from_le_bytes([a, b]).to_f32(),
        [a, b, c, d] => f32::from_le_bytes([a, b, c, d]),
        [a, b, c, d, e, f, g, h] => f64::from_le_bytes([a, b, c, d, e, f, g, h]) as f32,
        _ => 0.0,
    }
}

const ZIP: u32 = 1;
const ACTIVE_MASK: u32 = 2;
const BLOSC: u32 = 4;

/// How the values of a grid are packed.
#[derive(Clone, Copy, Debug)]
pub struct Codec {
    flags: u32,
}

impl Codec {
    pub fn read(cursor: &mut Cursor<'_>) -> Result<Self> {
        let at = cursor.at();
        let flags = cursor.u32()?;
        if flags & !(ZIP | ACTIVE_MASK | BLOSC) != 0 {
            return Err(cursor.bad(at, "compression by zip, blosc or the active mask", flags));
        }
        Ok(Self { flags })
    }

    /// `count` packed values.
    fn unpack(self, cursor: &mut Cursor<'_>, count: usize, stored: Stored) -> Result<Vec<f32>> {
        let size = stored.packed();
        let bytes = count * size;
        let of = |raw: &[u8]| raw.chunks_exact(size).map(number).collect();
        if stored.half && count == 0 {
            return Ok(Vec::new());
        }
        if self.flags & (ZIP | BLOSC) == 0 {
            return Ok(of(cursor.take(bytes as u64)?));
        }
        let at = cursor.at();
        let length = cursor.u64()? as i64;
        if length <= 0 {
            let plain = length.unsigned_abs();
            if plain != bytes as u64 {
                return Err(cursor.bad(at, format!("{bytes} bytes of values"), plain));
            }
            return Ok(of(cursor.take(plain)?));
        }
        let packed = cursor.take(length as u64)?;
        let mut plain = Vec::new();
        if self.flags & BLOSC != 0 {
            blosc::decode(packed, &mut plain).map_err(|what| cursor.bad(at, what, "something else"))?;
        } else {
            // one byte more shows that there is too much
            flate2::read::ZlibDecoder::new(packed)
                .take(bytes as u64 + 1)
                .read_to_end(&mut plain)
                .map_err(|e| cursor.bad(at, "a zlib stream", e))?;
        }
        if plain.len() != bytes {
            return Err(cursor.bad(at, format!("{bytes} bytes of values"), plain.len()));
        }
        Ok(of(&plain))
    }
}

/// All `count` values of a node with the active ones in `active`.
///
/// A byte says what inactive values are: 0 the background, 1 its negative, 2 one value, 3 the negative or the background by
/// a mask, 4 one value or the background by a mask, 5 one of two values by a mask, 6 stored like the active ones.
pub fn read(
    cursor: &mut Cursor<'_>,
    count: usize,
    active: Mask<'_>,
    background: f32,
    stored: Stored,
    codec: Codec,
) -> Result<Vec<f32>> {
    let at = cursor.at();
    let rule = cursor.u8()?;
    if rule > 6 {
        return Err(cursor.bad(at, "a rule from 0 to 6 for inactive values", rule));
    }
    let mut inactive = [if rule == 0 { background } else { -background }, background];
    if matches!(rule, 2 | 4 | 5) {
        inactive[0] = stored.value(cursor)?;
    }
    if rule == 5 {
        inactive[1] = stored.value(cursor)?;
    }
    let choice = if matches!(rule, 3..=5) { Some(cursor.mask(count)?) } else { None };
    let kept = if codec.flags & ACTIVE_MASK != 0 && rule != 6 { active.count() } else { count };
    let values = codec.unpack(cursor, kept, stored)?;
    if kept == count {
        return Ok(values);
    }
    let mut next = values.iter();
    let value = |i: usize| {
        if active.has(i) {
            // as many as the mask has bits
            next.next().copied().unwrap_or(background)
        } else {
            inactive[usize::from(choice.is_some_and(|c| c.has(i)))]
        }
    };
    Ok((0..count).map(value).collect())
}
