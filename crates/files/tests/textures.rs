//! PNG, JPEG, BMP, TGA, QOI and Radiance files as textures, and PNG as a result.

use proptest::prelude::*;
use std::path::{Path, PathBuf};
use tyndall_files::{FileError, image::*};

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)
}

/// The bytes of the 2 x 2 image in `data/rgb8.*`.
const RGB8: [[u8; 3]; 4] = [[0, 128, 255], [188, 10, 64], [255, 255, 255], [0, 0, 0]];

fn expected(channel: usize, encoding: Encoding) -> Vec<f32> {
    RGB8.iter().map(|p| encoding.decode(f64::from(p[channel]) / 255.0) as f32).collect()
}

#[test]
fn eight_bit_formats_are_srgb_unless_told() {
    for name in ["rgb8.png", "rgb8.bmp", "rgb8.tga", "rgb8.qoi"] {
        for (asked, used) in [
            (None, Encoding::Srgb),
            (Some(Encoding::Linear), Encoding::Linear),
            (Some(Encoding::Gamma(2.2)), Encoding::Gamma(2.2)),
        ] {
            let pixels = read_encoded(&data(name), asked).expect("a sound file");
            for (c, channel) in ["R", "G", "B"].iter().enumerate() {
                assert_eq!(pixels.channel(channel), Some(expected(c, used).as_slice()), "{name} {channel}");
            }
        }
    }
}

#[test]
fn alpha_is_linear() {
    let pixels = read_image(&data("rgba8.png")).expect("a sound file");
    assert_eq!(pixels.channel("A"), Some([128.0_f32 / 255.0; 4].as_slice()));
    assert_eq!(pixels.channel("G"), Some(expected(1, Encoding::Srgb).as_slice()));
}

#[test]
fn sixteen_bit_grey() {
    let linear = read_encoded(&data("grey16.png"), Some(Encoding::Linear)).expect("a sound file");
    let of = |w: u16| (f64::from(w) / 65535.0) as f32;
    assert_eq!(linear.channel("Y"), Some([of(0), of(32768), of(65535), of(1)].as_slice()));
    let srgb = read_image(&data("grey16.png")).expect("a sound file");
    let middle = Encoding::Srgb.decode(32768.0 / 65535.0) as f32;
    assert_eq!(srgb.channel("Y").expect("grey")[1], middle, "as pbrt-v4, 16 bits go through the encoding");
}

#[test]
fn jpeg_of_one_grey() {
    let pixels = read_encoded(&data("grey128.jpg"), Some(Encoding::Linear)).expect("a sound file");
    assert_eq!((pixels.width(), pixels.height()), (8, 8));
    for plane in pixels.rgb().expect("RGB") {
        assert!(plane.iter().all(|v| (v - 128.0 / 255.0).abs() < 1.5 / 255.0));
    }
}

#[test]
fn radiance_ignores_the_encoding() {
    for encoding in [None, Some(Encoding::Gamma(2.2))] {
        let pixels = read_encoded(&data("tiny.hdr"), encoding).expect("a sound file");
        // mantissa / 256 * 2^(exponent - 128)
        assert_eq!(pixels.channel("R"), Some([1.0, 0.5, 0.0, 255.0 / 65536.0].as_slice()));
        assert_eq!(pixels.channel("G"), Some([0.5, 0.0, 0.0, 255.0 / 65536.0].as_slice()));
        assert_eq!(pixels.channel("B"), Some([0.25, 0.0, 0.0, 255.0 / 65536.0].as_slice()));
    }
}

#[test]
fn unknown_and_missing_files() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let text = folder.path().join("notes.png");
    std::fs::write(&text, "not an image").expect("writable");
    assert!(matches!(read_image(&text), Err(FileError::Unsupported { .. })));
    let missing = read_image(&folder.path().join("missing.png")).expect_err("there is none");
    assert!(missing.to_string().contains("check the spelling"), "{missing}");
    let is_folder = read_image(folder.path()).expect_err("a folder");
    assert!(is_folder.to_string().contains("this is a folder"), "{is_folder}");
}

#[test]
fn a_png_of_a_huge_announced_size_is_refused() {
    let mut bytes = std::fs::read(data("rgb8.png")).expect("a file of ours");
    // the header chunk, 100,000 x 100,000, with its checksum
    bytes[16..20].copy_from_slice(&100_000_u32.to_be_bytes());
    bytes[20..24].copy_from_slice(&100_000_u32.to_be_bytes());
    let crc = crc32(&bytes[12..29]);
    bytes[29..33].copy_from_slice(&crc.to_be_bytes());
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("huge.png");
    std::fs::write(&path, bytes).expect("writable");
    assert!(matches!(read_image(&path), Err(FileError::Oversized { .. })));
}

/// ISO 3309, bit by bit.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |c, _| (c >> 1) ^ (0xedb8_8320 & (c & 1).wrapping_neg()))
    })
}

fn png(pixels: &Pixels, options: &PngOptions) -> (Pixels, PngReport) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("a.png");
    let report = write_png(&path, pixels, options).expect("RGB");
    (read_image(&path).expect("our own file"), report)
}

#[test]
fn a_png_comes_back_within_half_a_code() {
    let ramp: Vec<[f32; 3]> =
        (0..=1000).map(|i| [i as f32 / 1000.0, 0.25, 1.0 - i as f32 / 1000.0]).collect();
    let pixels = Pixels::from_rgb(1001, 1, &ramp).expect("1001 pixels");
    for (depth, codes) in [(BitDepth::Eight, 255.0), (BitDepth::Sixteen, 65535.0)] {
        let (back, report) = png(&pixels, &PngOptions { depth, ..PngOptions::default() });
        assert_eq!(report, PngReport { pixels: 1001, ..PngReport::default() });
        for (a, b) in back.rgb().expect("RGB").iter().zip(pixels.rgb().expect("RGB")) {
            for (a, b) in a.iter().zip(b) {
                let codes_apart = Encoding::Srgb.encode((*a).into()) - Encoding::Srgb.encode((*b).into());
                assert!(codes_apart.abs() * codes < 0.501, "{a} {b}");
            }
        }
    }
}

#[test]
fn exposure_is_in_stops() {
    let pixels = Pixels::from_rgb(1, 1, &[[0.125; 3]]).expect("one pixel");
    let (back, _) = png(&pixels, &PngOptions { exposure: 2.0, depth: BitDepth::Sixteen, dither: false });
    assert!((back.channel("R").expect("red")[0] - 0.5).abs() < 1e-4);
}

/// A colour between two codes becomes both, in proportion; black and white stay.
#[test]
fn dithered_colours_keep_their_mean() {
    let between = Encoding::Srgb.decode(100.25 / 255.0) as f32;
    let pixels = Pixels::from_rgb(64, 64, &[[between, 0.0, 1.0]; 4096]).expect("4096 pixels");
    let (back, _) = png(&pixels, &PngOptions { dither: true, ..PngOptions::default() });
    let codes = |name: &str| {
        let plane = back.channel(name).expect("a channel");
        plane.iter().map(|v| Encoding::Srgb.encode(f64::from(*v)) * 255.0).collect::<Vec<_>>()
    };
    let mean = codes("R").iter().sum::<f64>() / 4096.0;
    // four standard errors of the share of a quarter
    assert!((mean - 100.25).abs() < 4.0 * (0.25f64 * 0.75 / 4096.0).sqrt(), "{mean}");
    assert!(codes("G").iter().all(|c| *c == 0.0) && codes("B").iter().all(|c| (c - 255.0).abs() < 1e-9));
}

#[test]
fn what_cannot_be_shown_is_counted() {
    let colours = [
        [0.5, 0.5, 0.5],
        [-0.01, 0.5, 0.5],
        [0.5, 1.5, 0.5],
        [-1.0, 2.0, 0.0],
        [f32::NAN, 0.0, 0.0],
        [0.0, f32::INFINITY, 0.0],
    ];
    let pixels = Pixels::from_rgb(6, 1, &colours).expect("six pixels");
    let (back, report) = png(&pixels, &PngOptions::default());
    assert_eq!(report, PngReport { pixels: 6, below: 2, above: 2, non_finite: 2 });
    let [r, g, b] = back.rgb().expect("RGB");
    assert_eq!([r[3], g[3], b[3]], [0.0, 1.0, 0.0], "clamped");
    for i in [4, 5] {
        assert_eq!([r[i], g[i], b[i]], [1.0, 0.0, 1.0], "not finite: magenta");
    }
}

#[test]
fn a_png_of_nothing_is_refused() {
    let options = PngOptions::default();
    assert!(matches!(encode_png(&Pixels::new(1, 1), &options, Vec::new()), Err(FileError::BadImage { .. })));
    let empty = Pixels::from_rgb(0, 0, &[]).expect("no pixels");
    assert!(matches!(encode_png(&empty, &options, Vec::new()), Err(FileError::BadImage { .. })));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn damaged_files_never_panic(
        which in 0..8_usize,
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
    ) {
        let names =
            ["rgb8.png", "rgb8.bmp", "rgb8.tga", "rgb8.qoi", "grey16.png", "rgba8.png", "tiny.hdr", "grey128.jpg"];
        let mut bytes = std::fs::read(data(names[which])).expect("a file of ours");
        for (at, value) in edits {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join(names[which]);
        std::fs::write(&path, bytes).expect("writable");
        let _ = read_image(&path);
    }
}
