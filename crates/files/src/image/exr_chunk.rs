//! A look at a compressed chunk before the crate `exr` unpacks it: its DWA decoder (1.74) allocates what
//! counters inside the chunk announce, whatever the size of the block.

use crate::{FileError, Place, Result};
use exr::{
    block::chunk::{Chunk, CompressedBlock},
    meta::header::Header,
    prelude::{Compression, Vec2},
};
use std::path::Path;

/// Counters of a DWA chunk that size buffers, by their position, with the bytes of one unit: bytes of raw
/// channels, run-length bytes before and after unpacking, AC and DC coefficients.
const DWA_SIZES: [(usize, u64); 5] = [(1, 1), (6, 1), (7, 1), (8, 2), (9, 2)];

/// Refuses a chunk that would unpack to more than its block of pixels can need.
pub(super) fn check_chunk(header: &Header, chunk: &Chunk, path: &Path) -> Result<()> {
    let packed = match &chunk.compressed_block {
        CompressedBlock::ScanLine(block) => &block.compressed_pixels_le,
        CompressedBlock::Tile(block) => &block.compressed_pixels_le,
        _ => return Ok(()),
    };
    let is_dwa = matches!(header.compression, Compression::DWAA(_) | Compression::DWAB(_));
    if !is_dwa {
        return Ok(());
    }
    let Ok(pixels) = block_size(header, &chunk.compressed_block) else { return Ok(()) }; // the crate refuses it
    if packed.len() == pixels.area() * header.channels.bytes_per_pixel {
        return Ok(()); // what does not shrink is stored as it is, without counters
    }
    let most = most_dwa_bytes(header, pixels);
    let (counters, _) = packed.as_chunks::<8>();
    for (position, unit) in DWA_SIZES {
        let announced = counters.get(position).map_or(0, |c| u64::from_le_bytes(*c)).saturating_mul(unit);
        if announced > most {
            return Err(FileError::malformed(
                path,
                Place::File,
                format!("DWA chunks of at most {most} bytes"),
                format!("one of {announced}"),
                "the file is damaged; copy or export it again",
            ));
        }
    }
    Ok(())
}

fn block_size(header: &Header, block: &CompressedBlock) -> exr::error::Result<Vec2<usize>> {
    let position = header.get_block_data_indices(block)?;
    Ok(header.get_absolute_block_pixel_coordinates(position)?.size)
}

/// Channels of a block padded to 8 x 8, as 32-bit values, twice for incompressible runs.
fn most_dwa_bytes(header: &Header, Vec2(columns, rows): Vec2<usize>) -> u64 {
    (columns as u64 + 8) * (rows as u64 + 8) * header.channels.list.len() as u64 * 8
}
