//! Text in PNG files: the attributes of an image as `iTXt` chunks (UTF-8), so that a picture says where it comes from.
//!
//! Source: ISO/IEC 15948:2004 (PNG), 11.3.4.5.

use crate::{FileError, Result};
use flate2::Crc;
use std::{
    collections::BTreeMap,
    fs::File,
    io::{self, BufReader, Read, Seek, SeekFrom},
    path::Path,
};

const SIGNATURE: [u8; 8] = [0x89, b'P', b'N', b'G', b'\r', b'\n', 0x1a, b'\n'];
/// Signature and `IHDR`, after which text may stand.
const HEAD: usize = 8 + 25;
/// Longest text chunk that is read.
const LONGEST: u32 = 1 << 20;

/// Puts texts behind the header of an encoded PNG.
pub(super) fn with_texts(png: &[u8], texts: &[(&str, &str)]) -> Vec<u8> {
    let (head, rest) = png.split_at(HEAD.min(png.len()));
    let mut out = head.to_vec();
    for (keyword, text) in texts {
        out.extend(chunk(keyword, text));
    }
    out.extend_from_slice(rest);
    out
}

fn chunk(keyword: &str, text: &str) -> Vec<u8> {
    let mut body = b"iTXt".to_vec();
    body.extend(keyword.bytes().take(79));
    // end of the keyword, not compressed, method 0, no language, no translated keyword
    body.extend([0, 0, 0, 0, 0]);
    body.extend(text.as_bytes());
    let mut crc = Crc::new();
    crc.update(&body);
    let mut out = (body.len() as u32 - 4).to_be_bytes().to_vec();
    out.extend(body);
    out.extend(crc.sum().to_be_bytes());
    out
}

/// The uncompressed `iTXt` texts of a PNG file, by keyword.
///
/// # Errors
/// [`FileError::Io`] when the file cannot be read. A file that is no PNG, or is cut short, gives what was found.
pub fn read_png_texts(path: &Path) -> Result<BTreeMap<String, String>> {
    let file = File::open(path).map_err(|e| FileError::io(path, "open", e))?;
    let mut texts = BTreeMap::new();
    match collect(&mut BufReader::new(file), &mut texts) {
        Err(e) if e.kind() != io::ErrorKind::UnexpectedEof => Err(FileError::io(path, "read", e)),
        _ => Ok(texts),
    }
}

fn collect(file: &mut (impl Read + Seek), texts: &mut BTreeMap<String, String>) -> io::Result<()> {
    let mut signature = [0; 8];
    file.read_exact(&mut signature)?;
    if signature != SIGNATURE {
        return Ok(());
    }
    loop {
        let mut head = [0; 8];
        file.read_exact(&mut head)?;
        let length = u32::from_be_bytes([head[0], head[1], head[2], head[3]]);
        match &head[4..] {
            // texts stand before the image
            b"IDAT" | b"IEND" => return Ok(()),
            b"iTXt" if length <= LONGEST => {
                let mut body = vec![0; length as usize];
                file.read_exact(&mut body)?;
                texts.extend(parse(&body));
                file.seek(SeekFrom::Current(4))?;
            }
            _ => {
                file.seek(SeekFrom::Current(i64::from(length) + 4))?;
            }
        }
    }
}

/// Keyword and text of a chunk that is not compressed.
fn parse(body: &[u8]) -> Option<(String, String)> {
    let mut parts = body.splitn(2, |b| *b == 0);
    let (keyword, rest) = (parts.next()?, parts.next()?);
    let rest = rest.strip_prefix(&[0, 0])?;
    let text = rest.splitn(3, |b| *b == 0).nth(2)?;
    Some((String::from_utf8(keyword.to_vec()).ok()?, String::from_utf8(text.to_vec()).ok()?))
}

#[cfg(test)]
mod tests {
    use super::super::{Pixels, PngOptions, read_image, write_png};
    use super::*;

    #[test]
    fn texts_survive_and_the_image_stays_readable() {
        let folder = tempfile::tempdir().expect("writable");
        let path = folder.path().join("a.png");
        let mut pixels = Pixels::from_rgb(2, 1, &[[0.0, 0.5, 1.0], [1.0; 3]]).expect("two pixels");
        pixels.set("tyndall:job", "0123");
        pixels.set("Software", "µ");
        pixels.set("number", 3);
        write_png(&path, &pixels, &PngOptions::default()).expect("writable");
        let texts = read_png_texts(&path).expect("readable");
        assert_eq!(texts.len(), 2, "numbers are left out: {texts:?}");
        assert_eq!((texts["tyndall:job"].as_str(), texts["Software"].as_str()), ("0123", "µ"));
        // the decoder checks every chunk's checksum
        assert_eq!(read_image(&path).expect("still a PNG").width(), 2);
    }

    #[test]
    fn files_that_are_no_png_have_no_texts() {
        let folder = tempfile::tempdir().expect("writable");
        let path = folder.path().join("a");
        for bytes in [&b""[..], b"hello", &SIGNATURE, b"\x89PNG\r\n\x1a\n\xff\xff\xff\xffiTXt"] {
            std::fs::write(&path, bytes).expect("writable");
            assert!(read_png_texts(&path).expect("no error").is_empty());
        }
        assert!(read_png_texts(&folder.path().join("none")).is_err());
    }
}
