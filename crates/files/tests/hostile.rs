//! Damaged lens files, tensor files and textures: an error or other numbers, never a panic.

mod mutate;

use std::{io::Cursor, path::Path};
use tyndall_files::{image, lens, tensor};

/// A tensor file of two fields.
fn tensors() -> Vec<u8> {
    let mut out = [&b"tensor_file\0\x01\0"[..], &2u32.to_le_bytes()].concat();
    let mut at = 18 + 2 * (2 + 3 + 2 + 1 + 8) as u64 + 16 + 8;
    for (name, shape) in [("ndf", &[2u64, 3][..]), ("phi", &[4][..])] {
        out.extend((name.len() as u16).to_le_bytes());
        out.extend(name.bytes());
        out.extend((shape.len() as u16).to_le_bytes());
        out.push(10);
        out.extend(at.to_le_bytes());
        shape.iter().for_each(|n| out.extend(n.to_le_bytes()));
        at += 4 * shape.iter().product::<u64>();
    }
    out.extend((0..10).flat_map(|i| (i as f32).to_le_bytes()));
    out
}

#[test]
fn the_seed_is_sound() {
    let read = tensor::decode_tensors(&tensors(), Path::new("gold.bsdf")).expect("valid");
    assert!(read.field("ndf", 2).is_ok() && read.field("phi", 1).is_ok());
}

fn survive_tensors(count: u32) {
    mutate::survive(&[tensors()], count, |bytes| {
        if let Ok(read) = tensor::decode_tensors(bytes, Path::new("gold.bsdf"))
            && let Ok(field) = read.field("ndf", 2)
        {
            assert_eq!(field.values.len(), field.shape.iter().product::<usize>());
        }
    });
}

fn survive_lenses(count: u32) {
    let seed = "# a singlet\n50 1.5 1.5 20 # front\n\n0 2 0 8\n-50 45 1 20\n";
    mutate::survive(&[seed.into()], count, |bytes| {
        if let Ok(rows) = lens::decode_lens(&String::from_utf8_lossy(bytes), Path::new("lens.dat")) {
            assert!(rows.iter().all(|r| r.radius.is_finite() && r.thickness >= 0.0 && r.diameter > 0.0));
        }
    });
}

fn survive_textures(count: u32) {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    let read = |name: &str| std::fs::read(data.join(name)).expect("a file of ours");
    mutate::survive(&["grey_be.pfm", "rgb_le.pfm"].map(read), count, |bytes| {
        drop(image::decode_pfm(Cursor::new(bytes), bytes.len() as u64, Path::new("a.pfm")));
    });
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["rgb8.png", "grey16.png", "grey128.jpg", "rgb8.bmp", "rgb8.qoi", "rgb8.tga", "tiny.hdr"] {
        let path = folder.path().join(name);
        mutate::survive(&[read(name)], count / 8, |bytes| {
            std::fs::write(&path, bytes).expect("a file");
            drop(image::read_image(&path));
        });
    }
}

#[test]
fn damaged_tensors() {
    survive_tensors(mutate::SHORT);
}

#[test]
fn damaged_lenses() {
    survive_lenses(mutate::SHORT);
}

#[test]
fn damaged_textures() {
    survive_textures(mutate::SHORT);
}

#[test]
#[ignore = "long: TYNDALL_FUZZ copies"]
fn many_damaged_tensors() {
    survive_tensors(mutate::long());
}

#[test]
#[ignore = "long: TYNDALL_FUZZ copies"]
fn many_damaged_lenses() {
    survive_lenses(mutate::long());
}

#[test]
#[ignore = "long: TYNDALL_FUZZ copies"]
fn many_damaged_textures() {
    survive_textures(mutate::long());
}
