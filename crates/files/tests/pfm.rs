//! PFM: both byte orders, scale, the flip, and damage.

use proptest::prelude::*;
use std::path::Path;
use tyndall_files::{FileError, image::*};

fn data(name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)
}

fn decode(bytes: &[u8]) -> Result<Pixels, FileError> {
    decode_pfm(bytes, bytes.len() as u64, Path::new("memory.pfm"))
}

#[test]
fn little_endian_rgb_starts_with_the_bottom_row() {
    let pixels = read_pfm(&data("rgb_le.pfm")).expect("a sound file");
    assert_eq!((pixels.width(), pixels.height()), (2, 3));
    // the file was made as red = x + 10 y with y = 0 on top
    assert_eq!(pixels.channel("R"), Some([0.0, 1.0, 10.0, 11.0, 20.0, 21.0].as_slice()));
    assert_eq!(pixels.channel("G"), Some([-1.5; 6].as_slice()));
    assert_eq!(pixels.channel("B"), Some([0.0, 0.25, 0.0, 0.25, 0.0, 0.25].as_slice()));
}

#[test]
fn big_endian_grey_is_scaled() {
    let pixels = read_image(&data("grey_be.pfm")).expect("a sound file");
    assert_eq!(pixels.channel("Y"), Some([0.0, 2.0, 20.0, 22.0, 40.0, 42.0].as_slice()));
    assert_eq!(pixels.rgb().expect("grey")[2][5], 42.0);
}

#[test]
fn what_is_written_comes_back_to_the_bit() {
    let values = [1e-42, -0.0, f32::INFINITY, 3.25, f32::NAN, -1e30];
    let mut rgb = Pixels::from_rgb(3, 2, &values.map(|v| [v, v * 2.0, 0.1])).expect("six pixels");
    let mut out = Vec::new();
    encode_pfm(&rgb, &mut out).expect("RGB");
    let back = decode(&out).expect("our own file");
    for (a, b) in back.channels().iter().zip(rgb.channels()) {
        assert!(a.data.iter().zip(&b.data).all(|(x, y)| x.to_bits() == y.to_bits()), "{}", a.name);
    }
    rgb = Pixels::new(2, 1);
    rgb.push("Y", vec![1.0, 2.0]).expect("two samples");
    out.clear();
    encode_pfm(&rgb, &mut out).expect("grey");
    assert_eq!(decode(&out).expect("our own file"), rgb);
    assert!(encode_pfm(&Pixels::new(1, 1), &mut out).is_err(), "no channel to write");
}

#[test]
fn damage_is_named() {
    let message = |bytes: &[u8]| decode(bytes).expect_err("damaged").to_string();
    assert!(message(b"P6\n1 1\n255\n").contains("`PF`"));
    assert!(message(b"PF\n0 1\n-1\n").contains("size from 1"));
    assert!(message(b"PF\n-4 1\n-1\n").contains("size from 1"));
    assert!(message(b"PF\n1 1\n0\n").contains("scale other than 0"));
    assert!(message(b"PF\n1 1\nnan\n").contains("scale other than 0"));
    assert!(message(b"PF\n1 1\n-1\n\0\0\0\0").contains("12 bytes of samples"));
    assert!(message(b"PF\n1000000 1000000\n-1\n\0\0\0\0").contains("announces 12000000000000 bytes"));
    assert!(message(b"").contains("`PF`"));
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_bytes_never_panic(tail in prop::collection::vec(any::<u8>(), 0..80), size in "[0-9 \n.-]{0,12}") {
        let mut bytes = format!("PF\n{size}\n").into_bytes();
        bytes.extend(tail);
        let _ = decode(&bytes);
    }
}
