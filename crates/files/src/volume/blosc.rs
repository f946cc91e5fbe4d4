//! Blosc, version 1 of the format, with LZ4: what NanoVDB and OpenVDB write.
//!
//! Each chunk has its length in front. Inside: a header of 16 bytes (versions, flags, size of an element; then the sizes of
//! the data, of a block and of the chunk), the offset of every block, and in a block one stream, or one for each byte of
//! an element. A stream of its full length is stored as it is. With the flag for shuffling, the first bytes of all
//! elements come first, then the second ones, and so on.

use super::bytes::Bytes;
use crate::error::Result;

/// Bytes of a chunk before compression at most: 1 GiB.
const CHUNK: u64 = 1 << 30;
const SHUFFLE: u8 = 1;
const STORED: u8 = 2;
const BIT_SHUFFLE: u8 = 4;
const ONE_STREAM: u8 = 16;
/// Fewest elements of a stream for which blocks are split.
const SPLIT_LEAST: usize = 128;

/// All chunks of a grid of `size` bytes.
pub fn chunks(file: &Bytes<'_>, at: u64, stored: &[u8], size: u64) -> Result<Vec<u8>> {
    let mut out = Vec::new();
    let mut from = 0u64;
    while (out.len() as u64) < size {
        let left = stored.get(from as usize..).unwrap_or_default();
        let short = || file.bad(at + from, "another compressed chunk", "the end of the grid");
        let length = left.first_chunk::<8>().map(|l| u64::from_le_bytes(*l)).ok_or_else(short)?;
        let chunk = left.get(8..).and_then(|l| l.get(..usize::try_from(length).ok()?)).ok_or_else(short)?;
        let expected = CHUNK.min(size - out.len() as u64);
        let before = out.len();
        decode(chunk, &mut out).map_err(|what| file.bad(at + from, what, "something else"))?;
        if (out.len() - before) as u64 != expected {
            return Err(file.bad(at + from, format!("{expected} bytes in a chunk"), out.len() - before));
        }
        from += 8 + length;
    }
    Ok(out)
}

/// Appends what one chunk holds; the error says what was expected.
pub fn decode(chunk: &[u8], out: &mut Vec<u8>) -> std::result::Result<(), &'static str> {
    let u32_at =
        |i: usize| chunk.get(i..i + 4).and_then(|b| b.first_chunk()).map(|b| u32::from_le_bytes(*b) as usize);
    let header = chunk.first_chunk::<4>().ok_or("a header of blosc")?;
    let [_, _, flags, element] = *header;
    let (total, block) = (u32_at(4).ok_or("sizes of blosc")?, u32_at(8).ok_or("sizes of blosc")?);
    if total as u64 > CHUNK || total / 255 > chunk.len() {
        return Err("data that can come from the chunk");
    }
    if flags & STORED != 0 {
        out.extend_from_slice(chunk.get(16..16 + total).ok_or("stored bytes")?);
        return Ok(());
    }
    if block == 0 || flags >> 5 != 1 || flags & BIT_SHUFFLE != 0 {
        return Err("blocks of LZ4 with bytes shuffled");
    }
    let element = usize::from(element.max(1));
    for i in 0..total.div_ceil(block) {
        let start = u32_at(16 + 4 * i).ok_or("offsets of blocks")?;
        let length = block.min(total - i * block);
        // the last block is split only where it is whole
        let split =
            flags & ONE_STREAM == 0 && length == block && element <= 16 && length / element >= SPLIT_LEAST;
        let streams = if split { element } else { 1 };
        let bytes = streams_of(chunk, start, streams, length)?;
        if flags & SHUFFLE != 0 && element > 1 {
            unshuffle(&bytes, element, out);
        } else {
            out.extend_from_slice(&bytes);
        }
    }
    Ok(())
}

fn streams_of(
    chunk: &[u8],
    mut at: usize,
    streams: usize,
    length: usize,
) -> std::result::Result<Vec<u8>, &'static str> {
    let each = length / streams;
    let mut out = Vec::with_capacity(length);
    for _ in 0..streams {
        let size = chunk.get(at..).and_then(|c| c.first_chunk::<4>()).ok_or("the size of a stream")?;
        let size = u32::from_le_bytes(*size) as usize;
        at += 4;
        let data =
            at.checked_add(size).and_then(|end| chunk.get(at..end)).ok_or("a stream within the chunk")?;
        if size == each {
            out.extend_from_slice(data);
        } else {
            let plain = lz4_flex::block::decompress(data, each).map_err(|_| "a stream of LZ4")?;
            if plain.len() != each {
                return Err("a stream of LZ4 of the block's length");
            }
            out.extend_from_slice(&plain);
        }
        at += size;
    }
    Ok(out)
}

/// Bytes of an element together again; what is left over behind the last element was not shuffled.
fn unshuffle(bytes: &[u8], element: usize, out: &mut Vec<u8>) {
    let count = bytes.len() / element;
    for i in 0..count {
        out.extend((0..element).map(|k| bytes[k * count + i]));
    }
    out.extend_from_slice(&bytes[count * element..]);
}
