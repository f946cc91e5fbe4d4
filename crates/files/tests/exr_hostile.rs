//! Damaged and hostile EXR files: an error, no panic, no allocation that the file's size does not justify.

mod mutate;

use proptest::prelude::*;
use std::{io::Cursor, path::Path, time::Instant};
use tyndall_files::{FileError, image::*};

fn read(bytes: &[u8]) -> Result<Pixels, FileError> {
    decode_exr(Cursor::new(bytes), bytes.len() as u64, Path::new("hostile.exr"))
}

fn small_file(compression: ExrCompression) -> Vec<u8> {
    let mut pixels = Pixels::from_rgb(19, 23, &[[0.5, 1.0, 2.0]; 19 * 23]).expect("the right size");
    pixels.set("note", "x");
    pixels.set("edges", vec![1.0, 2.0]);
    let mut out = Cursor::new(Vec::new());
    encode_exr(&pixels, &ExrOptions { compression, parallel: false }, &mut out).expect("a sound image");
    out.into_inner()
}

fn seeds() -> Vec<Vec<u8>> {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    let made = ["spectral_openexr.exr", "mixed_piz.exr", "tiled_half_rgba.exr", "rgb_dwaa.exr"];
    let mut seeds: Vec<_> =
        made.iter().map(|n| std::fs::read(data.join(n)).expect("a file of ours")).collect();
    seeds.extend([small_file(ExrCompression::Zip), small_file(ExrCompression::None)]);
    seeds
}

/// The offset of an attribute's value.
fn value_of(bytes: &[u8], name_and_type: &[u8]) -> usize {
    bytes.windows(name_and_type.len()).position(|w| w == name_and_type).expect("the attribute")
        + name_and_type.len()
        + 4
}

fn with_window(mut bytes: Vec<u8>, x1: i32, y1: i32) -> Vec<u8> {
    for name in [&b"dataWindow\0box2i\0"[..], b"displayWindow\0box2i\0"] {
        let at = value_of(&bytes, name);
        bytes[at + 8..at + 12].copy_from_slice(&x1.to_le_bytes());
        bytes[at + 12..at + 16].copy_from_slice(&y1.to_le_bytes());
    }
    bytes
}

#[test]
fn a_huge_announced_size_is_refused_at_once() {
    for compression in [ExrCompression::Zip, ExrCompression::None] {
        for (x1, y1) in [(99_999, 99_999), (1 << 29, 22), (18, 1 << 29), (i32::MAX / 2, i32::MAX / 2)] {
            let mut bytes = with_window(small_file(compression), x1, y1);
            let lines = if compression == ExrCompression::Zip { 16 } else { 1 };
            let chunks = value_of(&bytes, b"chunkCount\0int\0");
            bytes[chunks..chunks + 4].copy_from_slice(&(y1 / lines + 1).to_le_bytes());
            let start = Instant::now();
            let error = read(&bytes).expect_err("it cannot hold that");
            assert!(matches!(error, FileError::Oversized { .. } | FileError::Malformed { .. }), "{error}");
            assert!(
                error.to_string().contains("hostile.exr") && error.to_string().contains("hint:"),
                "{error}"
            );
            assert!(start.elapsed().as_secs() < 1);
        }
    }
    let bytes = with_window(small_file(ExrCompression::None), 9999, 22);
    assert!(matches!(read(&bytes), Err(FileError::Oversized { .. })));
}

#[test]
fn a_chunk_that_announces_terabytes_is_refused() {
    let sound = seeds().swap_remove(3);
    // the header ends with its last attribute and a zero byte; the offset of the only chunk follows
    let header_end = value_of(&sound, b"type\0string\0") + b"scanlineimage\0".len();
    let chunk = usize::from(u16::from_le_bytes([sound[header_end], sound[header_end + 1]]));
    let counters = chunk + 8; // behind line number and size
    for counter in [1, 6, 7, 8, 9] {
        let mut bytes = sound.clone();
        bytes[counters + counter * 8 + 5] = 1; // 2^40 more
        let error = read(&bytes).expect_err("it cannot unpack to that");
        assert!(error.to_string().contains("DWA chunks of at most"), "{counter}: {error}");
    }
}

#[test]
fn every_truncation_is_an_error() {
    for seed in seeds() {
        for length in 0..seed.len() {
            assert!(read(&seed[..length]).is_err(), "{length} of {}", seed.len());
        }
        assert!(read(&seed).is_ok());
    }
}

#[test]
fn not_an_exr_file() {
    for bytes in [&b""[..], b"PF\n1 1\n", b"\x76\x2f\x31\x01", b"\x76\x2f\x31\x01\x02\0\0\0", &[0xff; 4096]] {
        let error = read(bytes).expect_err("not an image");
        assert!(matches!(error, FileError::Malformed { .. }), "{error}");
    }
}

#[test]
fn every_header_byte_changed() {
    for seed in seeds() {
        for at in 0..seed.len().min(700) {
            for value in [0, 1, 0x7f, 0x80, 0xff, seed[at] ^ 1] {
                let mut bytes = seed.clone();
                bytes[at] = value;
                let _ = read(&bytes); // any answer but a panic or a large allocation
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn mutations_never_panic(
        seed in 0..6_usize,
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..12),
        cut in prop::option::of(any::<prop::sample::Index>()),
    ) {
        let mut bytes = seeds().swap_remove(seed);
        for (at, value) in edits {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        if let Some(cut) = cut {
            bytes.truncate(cut.index(bytes.len()));
        }
        let _ = read(&bytes);
    }

    #[test]
    fn random_bytes_never_panic(mut bytes in prop::collection::vec(any::<u8>(), 0..600)) {
        let magic = [0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0];
        bytes.splice(0..0, magic);
        prop_assert!(read(&bytes).is_err());
    }
}

fn survive(count: u32) {
    mutate::survive(&seeds(), count, |bytes| drop(read(bytes)));
}

#[test]
fn damaged_copies() {
    survive(mutate::SHORT);
}

#[test]
#[ignore = "long: TYNDALL_FUZZ copies"]
fn many_damaged_copies() {
    survive(mutate::long());
}
