//! One text of a NetCDF-3 file's header, found without believing anything else in the file.

use std::{fs::File, io::Read, path::Path};

/// So much of a file is looked through.
const LOOK: u64 = 1 << 16;
/// Type tags of texts: bytes, characters.
const TEXT: [u32; 2] = [1, 2];

/// The text of an attribute in the header; `None` when the file is no NetCDF-3 or has no such text near its start.
pub fn netcdf_text(path: &Path, attribute: &str) -> Option<String> {
    let mut bytes = Vec::new();
    File::open(path).ok()?.take(LOOK).read_to_end(&mut bytes).ok()?;
    if !bytes.starts_with(b"CDF") {
        return None;
    }
    let mut name = (attribute.len() as u32).to_be_bytes().to_vec();
    name.extend(attribute.as_bytes());
    name.resize(name.len().next_multiple_of(4), 0);
    let at = bytes.windows(name.len()).position(|w| w == name)? + name.len();
    let word = |at: usize| Some(u32::from_be_bytes(*bytes.get(at..)?.first_chunk::<4>()?));
    if !TEXT.contains(&word(at)?) {
        return None;
    }
    let text = bytes.get(at + 8..)?.get(..word(at + 4)? as usize)?;
    String::from_utf8(text.to_vec()).ok()
}
