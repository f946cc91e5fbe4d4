//! OpenEXR: what is written comes back to the bit, the same image gives the same bytes, and files of OpenEXR's
//! own library (in `data/`) read as they were made.

use std::{io::Cursor, path::Path};
use tyndall_files::{FileError, image::*};

fn data(name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)
}

/// Values that lossy storage would change: subnormal, huge, negative zero, infinite.
fn awkward(i: usize) -> f32 {
    [0.1, -0.0, 1e-42, 3.4e38, f32::INFINITY, -7.25e-9, 16_777_217.0][i % 7]
        * if i.is_multiple_of(3) { -1.0 } else { 1.0 }
}

fn sample_image(width: usize, height: usize) -> Pixels {
    let plane = |c: usize| (0..width * height).map(|i| awkward(i * 5 + c)).collect();
    let mut pixels = Pixels::new(width, height);
    for (c, name) in ["R", "G", "B", "depth.Z", "Albedo"].into_iter().enumerate() {
        pixels.push(name, plane(c)).expect("the plane has the right size");
    }
    pixels
}

fn attributed(mut pixels: Pixels) -> Pixels {
    pixels.set("comments", "made by a test, µm");
    pixels.set("capDate", "2026:11:22 03:00:00");
    pixels.set("expTime", 0.5_f32);
    pixels.set("sceneHash", "0123456789abcdef");
    pixels.set("aNameOfMoreThanThirtyOneCharacters", "long");
    pixels.set("samplesPerPixel", 64);
    pixels.set("medianError", 0.01_f32);
    pixels.set("seconds", 1.0 / 3.0);
    pixels.set("edges", vec![380.0, 385.0, 390.5]);
    pixels.set("up", MetaValue::Vec3([0.0, 1.0, 0.0]));
    pixels.set("views", MetaValue::Texts(vec!["a".into(), "bc".into()]));
    let moved = [[1.0, 0.0, 0.0, 5.0], [0.0, 1.0, 0.0, 6.0], [0.0, 0.0, 1.0, 7.0], [0.0, 0.0, 0.0, 1.0]];
    pixels.set("worldToCamera", MetaValue::Matrix4(moved));
    pixels.set("worldToNDC", MetaValue::Matrix4(moved.map(|row| row.map(|v| v * 2.0))));
    pixels.set(
        "chromaticities",
        MetaValue::Chromaticities([[0.64, 0.33], [0.3, 0.6], [0.15, 0.06], [0.3127, 0.329]]),
    );
    pixels
}

fn encoded(pixels: &Pixels, options: &ExrOptions) -> Vec<u8> {
    let mut out = Cursor::new(Vec::new());
    encode_exr(pixels, options, &mut out).expect("a sound image");
    out.into_inner()
}

fn decoded(bytes: &[u8]) -> Pixels {
    decode_exr(Cursor::new(bytes), bytes.len() as u64, Path::new("memory.exr")).expect("a sound file")
}

fn bits(data: &[f32]) -> Vec<u32> {
    data.iter().map(|v| v.to_bits()).collect()
}

#[test]
fn samples_and_attributes_come_back_to_the_bit() {
    let mut pixels = attributed(sample_image(37, 41));
    pixels.channel_mut("G").expect("green")[5] = f32::from_bits(0x7fc1_2345);
    for compression in [ExrCompression::Zip, ExrCompression::None] {
        let back = decoded(&encoded(&pixels, &ExrOptions { compression, parallel: false }));
        assert_eq!(back.window(), pixels.window());
        assert_eq!(back.channels().len(), pixels.channels().len());
        for channel in pixels.channels() {
            let read = back.channel(&channel.name).expect("every channel is there");
            assert_eq!(bits(read), bits(&channel.data), "{}", channel.name);
        }
        for (name, value) in &pixels.meta {
            assert_eq!(back.meta.get(name), Some(value), "{name}");
        }
    }
}

#[test]
fn the_same_image_gives_the_same_bytes() {
    let first = encoded(&attributed(sample_image(64, 70)), &ExrOptions::default());
    for parallel in [true, false, true, false] {
        // a new image: its maps hash with other keys
        let options = ExrOptions { parallel, ..ExrOptions::default() };
        assert!(encoded(&attributed(sample_image(64, 70)), &options) == first);
    }
}

#[test]
fn the_order_of_adding_channels_does_not_matter() {
    let (mut a, mut b) = (Pixels::new(2, 2), Pixels::new(2, 2));
    for (name, value) in [("R", 1.0), ("G", 2.0), ("B", 3.0)] {
        a.push(name, vec![value; 4]).expect("four samples");
    }
    for (name, value) in [("B", 3.0), ("R", 1.0), ("G", 2.0)] {
        b.push(name, vec![value; 4]).expect("four samples");
    }
    assert_eq!(encoded(&a, &ExrOptions::default()), encoded(&b, &ExrOptions::default()));
}

#[test]
fn a_crop_keeps_its_windows() {
    let window = Window { x0: -3, y0: 17, width: 5, height: 18 };
    let display = Window { x0: -8, y0: 2, width: 64, height: 48 };
    let mut pixels = Pixels::cropped(window, display);
    pixels.push("Y", (0..90).map(|i| i as f32).collect()).expect("90 samples");
    let back = decoded(&encoded(&pixels, &ExrOptions::default()));
    assert_eq!((back.window(), back.display()), (window, display));
    assert_eq!(back.channel("Y"), pixels.channel("Y"));
}

#[test]
fn matrices_are_stored_for_row_vectors_as_openexr_documents() {
    let bytes = encoded(&attributed(sample_image(1, 1)), &ExrOptions::default());
    let name = b"worldToCamera\0m44f\0";
    let at = bytes.windows(name.len()).position(|w| w == name).expect("the attribute") + name.len() + 4;
    let stored: Vec<f32> =
        bytes[at..at + 64].chunks(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect();
    assert_eq!(stored[12..], [5.0, 6.0, 7.0, 1.0], "the translation is the last row");
}

#[test]
fn a_spectral_image_has_the_published_layout() {
    let layout = SpectralLayout {
        edges_nm: vec![395.0, 405.0, 410.0, 1190.0],
        unit: SpectralUnit::Absolute,
        samples_per_pixel: Some(16),
    };
    let mut pixels = Pixels::from_rgb(2, 1, &[[1.0, 2.0, 3.0]; 2]).expect("two pixels");
    layout.add_to(&mut pixels, vec![vec![4.0; 2], vec![5.0; 2], vec![6.0; 2]]).expect("three bands");
    let back = decoded(&encoded(&pixels, &ExrOptions::default()));
    let names: Vec<_> = back.channels().iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["B", "G", "R", "S0.400,000000nm", "S0.407,500000nm", "S0.800,000000nm"]);
    let text = |name: &str| back.meta.get(name).cloned();
    assert_eq!(text("spectralLayoutVersion"), Some("1.0".into()));
    assert_eq!(text("emissiveUnits"), Some("W.m^-2.sr^-1".into()));
    assert_eq!(text("spectralQuantity"), Some("per nm, band mean".into()));
    assert_eq!(text("samplesPerPixel"), Some(16.into()));
    assert_eq!(band_edges_nm(&back), Some(layout.edges_nm));
    let spectrum: Vec<_> =
        spectral_channels(&back).iter().map(|c| (c.lambda_nm, c.channel.data[1])).collect();
    assert_eq!(spectrum, [(400.0, 4.0), (407.5, 5.0), (800.0, 6.0)]);
}

#[test]
fn a_spectral_image_without_rgb_or_with_bad_bands_is_refused() {
    let layout = |edges: &[f64]| SpectralLayout {
        edges_nm: edges.to_vec(),
        unit: SpectralUnit::Relative("pbrt-normalised".into()),
        samples_per_pixel: None,
    };
    let rgb = || Pixels::from_rgb(1, 1, &[[1.0; 3]]).expect("one pixel");
    let error = |mut pixels, edges: &[f64], planes| {
        layout(edges).add_to(&mut pixels, planes).expect_err("must be refused").to_string()
    };
    assert!(error(Pixels::new(1, 1), &[400.0, 500.0], vec![vec![0.0]]).contains("R, G and B"));
    assert!(error(rgb(), &[500.0, 400.0], vec![vec![0.0]]).contains("ascending"));
    assert!(error(rgb(), &[400.0, f64::NAN], vec![vec![0.0]]).contains("ascending"));
    assert!(error(rgb(), &[400.0], vec![]).contains("edges"));
    assert!(error(rgb(), &[400.0, 500.0], vec![]).contains("1 planes"));
}

/// `c + x / 4 + 2 y` of the files in `data/`, made with OpenEXR's Python module.
fn ramp(c: f32, width: usize, height: usize) -> Vec<f32> {
    (0..width * height).map(|i| c + 0.25 * (i % width) as f32 + 2.0 * (i / width) as f32).collect()
}

#[test]
fn openexrs_spectral_file() {
    let pixels = read_exr(&data("spectral_openexr.exr")).expect("a sound file");
    assert_eq!(pixels.window(), Window { x0: 2, y0: 1, width: 5, height: 3 });
    assert_eq!(pixels.display(), Window { x0: 0, y0: 0, width: 10, height: 10 });
    let spectral = spectral_channels(&pixels);
    assert_eq!(spectral.iter().map(|c| c.lambda_nm).collect::<Vec<_>>(), [400.0, 500.5, 1000.0]);
    for (band, c) in spectral.iter().zip([10.0, 20.0, 30.0]) {
        assert_eq!(band.channel.data, ramp(c, 5, 3));
    }
    assert_eq!(pixels.rgb().expect("RGB")[2], ramp(3.0, 5, 3));
}

#[test]
fn openexrs_half_uint_and_tiled_files() {
    let mixed = read_exr(&data("mixed_piz.exr")).expect("a sound file");
    assert_eq!(mixed.channel("Y"), Some(ramp(1.0, 5, 3).as_slice()));
    assert_eq!(mixed.channel("Z"), Some(ramp(7.0, 5, 3).as_slice()));
    assert_eq!(mixed.channel("id"), Some((0..15).map(|i| i as f32).collect::<Vec<_>>().as_slice()));
    assert_eq!(mixed.rgb().expect("grey")[1], ramp(1.0, 5, 3));
    let tiled = read_exr(&data("tiled_half_rgba.exr")).expect("a sound file");
    for (name, c) in [("R", 1.0), ("G", 2.0), ("B", 3.0), ("A", 0.0)] {
        assert_eq!(tiled.channel(name), Some(ramp(c, 5, 3).as_slice()), "{name}");
    }
}

#[test]
fn what_was_read_can_be_written_again() {
    for name in
        ["spectral_openexr.exr", "mixed_piz.exr", "tiled_half_rgba.exr", "rgb_dwaa.exr", "rgb_dwaa_raw.exr"]
    {
        let pixels = read_exr(&data(name)).expect("a sound file");
        assert_eq!(decoded(&encoded(&pixels, &ExrOptions::default())), pixels, "{name}");
    }
}

#[test]
fn dwa_files_are_close_and_their_raw_blocks_too() {
    for (name, width) in [("rgb_dwaa.exr", 40), ("rgb_dwaa_raw.exr", 20)] {
        let pixels = read_exr(&data(name)).expect("a sound file");
        assert_eq!(pixels.width(), width);
        for (channel, c) in [("R", 1.0), ("G", 2.0), ("B", 3.0)] {
            for (i, value) in pixels.channel(channel).expect("a channel").iter().enumerate() {
                // the files were made as c + sin(x / 4) + y / 10 in half floats
                let made = c + (0.25 * (i % width) as f32).sin() + 0.1 * (i / width) as f32;
                assert!((value - made).abs() < 0.05, "{name} {channel} {i}: {value} {made}");
            }
        }
    }
}

#[test]
fn a_probe_reads_only_the_header() {
    let info = probe_exr(&data("spectral_openexr.exr")).expect("a sound file");
    assert_eq!(info.channels.len(), 6);
    assert_eq!(info.sample_bytes(), 5 * 3 * 6 * 4);
    assert_eq!(info.frame.meta.get("spectralLayoutVersion"), Some(&"1.0".into()));
}

#[test]
fn images_that_exr_cannot_hold_are_refused() {
    let refused = |pixels: &Pixels| {
        let result = encode_exr(pixels, &ExrOptions::default(), Cursor::new(Vec::new()));
        assert!(matches!(result, Err(FileError::BadImage { .. })), "{result:?}");
    };
    refused(&Pixels::new(3, 3));
    let mut empty = Pixels::new(0, 3);
    empty.push("R", vec![]).expect("no samples");
    refused(&empty);
    let mut far =
        Pixels::cropped(Window { x0: i32::MAX - 1, y0: 0, width: 4, height: 1 }, Window::of_size(1, 1));
    far.push("R", vec![0.0; 4]).expect("four samples");
    refused(&far);
    let mut reserved = sample_image(1, 1);
    reserved.set("dataWindow", "somewhere");
    refused(&reserved);
    assert!(sample_image(2, 2).push("R", vec![0.0; 4]).is_err(), "the name is taken");
    assert!(sample_image(2, 2).push("new", vec![0.0; 3]).is_err(), "a sample is missing");
}
