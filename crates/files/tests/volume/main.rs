//! NanoVDB files written here come back, whatever the leaves and the compression; damaged ones are refused.

#[path = "../mutate/mod.rs"]
mod mutate;
mod writer;

use proptest::prelude::*;
use std::{collections::BTreeMap, io::Write, path::PathBuf};
use tyndall_files::{
    FileError,
    volume::{
        Piece,
        nanovdb::{Class, Grid, NanoVdb},
    },
};
use writer::{Spec, file, stored, values};

fn waves([x, y, z]: [i32; 3]) -> f32 {
    0.25 * ((x * 7 + y * 3 + z * 5).rem_euclid(11)) as f32
}

fn spec(kind: u32) -> Spec<'static> {
    // across the borders of leaves, of lower and of upper nodes
    let (first, last) = ([-10, 120, 4090], [5, 133, 4101]);
    Spec {
        name: "density",
        kind,
        class: 2,
        first,
        last,
        voxel_size: 0.5,
        offset: [1.0, 2.0, 3.0],
        value: &waves,
    }
}

fn zip(plain: Vec<u8>) -> Vec<u8> {
    let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
    encoder.write_all(&plain).expect("memory takes it");
    let packed = encoder.finish().expect("memory takes it");
    [(packed.len() as u64).to_le_bytes().to_vec(), packed].concat()
}

/// One chunk in blocks of 64 KiB, bytes shuffled, four streams a block.
fn blosc(plain: Vec<u8>) -> Vec<u8> {
    const BLOCK: usize = 1 << 16;
    let blocks: Vec<&[u8]> = plain.chunks(BLOCK).collect();
    let mut starts = Vec::new();
    let mut body = Vec::new();
    for block in &blocks {
        starts.extend(((16 + 4 * blocks.len() + body.len()) as u32).to_le_bytes());
        let count = block.len() / 4;
        let mut shuffled: Vec<u8> = (0..4 * count).map(|i| block[(i % count) * 4 + i / count]).collect();
        shuffled.extend(&block[4 * count..]);
        let streams = if block.len() == BLOCK { 4 } else { 1 };
        for stream in shuffled.chunks(block.len() / streams) {
            let packed = lz4_flex::block::compress(stream);
            let kept = if packed.len() < stream.len() { packed } else { stream.to_vec() };
            body.extend((kept.len() as u32).to_le_bytes());
            body.extend(kept);
        }
    }
    let total = 16 + starts.len() + body.len();
    let mut chunk = vec![2, 1, 0b0010_0001, 4];
    for size in [plain.len(), BLOCK, total] {
        chunk.extend((size as u32).to_le_bytes());
    }
    chunk.extend(starts);
    chunk.extend(body);
    [(chunk.len() as u64).to_le_bytes().to_vec(), chunk].concat()
}

fn on_disk(bytes: &[u8]) -> (tempfile::TempDir, PathBuf) {
    let dir = tempfile::tempdir().expect("a folder");
    let path = dir.path().join("grid.nvdb");
    std::fs::write(&path, bytes).expect("a file");
    (dir, path)
}

type Leaves = BTreeMap<[i32; 3], Vec<f32>>;

fn leaves(grid: &Grid<'_>) -> Result<Leaves, FileError> {
    let mut all = BTreeMap::new();
    grid.visit::<FileError>(|origin, piece| {
        if let Piece::Brick(v) = piece {
            all.insert(origin, v.to_vec());
        }
        Ok(())
    })?;
    Ok(all)
}

fn read(bytes: &[u8], name: &str) -> Result<Option<Leaves>, FileError> {
    let (_dir, path) = on_disk(bytes);
    let file = NanoVdb::open(&path)?;
    file.grid(name)?.as_ref().map(leaves).transpose()
}

#[test]
fn every_kind_of_leaf_and_every_compression() {
    type Pack = fn(Vec<u8>) -> Vec<u8>;
    let packs: [(u16, Pack); 3] = [(0, |b| b), (1, zip), (2, blosc)];
    for kind in [1, 2, 13, 14, 15, 16] {
        for (codec, pack) in packs {
            let spec = spec(kind);
            let got = read(&file(codec, &[spec], pack), "density").unwrap().unwrap();
            let spec = self::spec(kind);
            assert_eq!(got.len(), 3 * 2 * 2, "kind {kind}");
            for (n, (origin, voxels)) in got.iter().enumerate() {
                let expected = stored(&spec, n, &values(&spec, *origin));
                assert_eq!(voxels, &expected, "kind {kind}, codec {codec}, leaf at {origin:?}");
            }
        }
    }
}

#[test]
fn descriptions() {
    let glow = Spec { name: "temperature", class: 0, ..spec(1) };
    let (_dir, path) = on_disk(&file(0, &[spec(14), glow], |b| b));
    let file = NanoVdb::open(&path).unwrap();
    assert_eq!(file.names(), ["density", "temperature"]);
    assert!(file.grid("flames").unwrap().is_none());
    let grid = file.grid("density").unwrap().unwrap();
    assert_eq!((grid.class(), grid.background()), (Class::FogVolume, 0.0));
    assert_eq!(grid.index_box(), [[-10, 120, 4090], [5, 133, 4101]]);
    assert_eq!(grid.to_world(), [[0.5, 0.0, 0.0, 1.0], [0.0, 0.5, 0.0, 2.0], [0.0, 0.0, 0.5, 3.0]]);
    assert_eq!(file.grid("temperature").unwrap().unwrap().class(), Class::Unknown);
}

#[test]
fn bare_grids() {
    let mut bytes = writer::grid(&spec(1));
    bytes[7] = b'1';
    assert_eq!(read(&bytes, "density").unwrap().unwrap().len(), 12);
}

#[test]
fn foreign_files_are_named() {
    let told = |bytes: &[u8]| read(bytes, "density").unwrap_err().to_string();
    let mut old = file(0, &[spec(1)], |b| b);
    assert!(told(&old[..12]).contains("bytes"));
    old[8..12].copy_from_slice(&(31u32 << 21).to_le_bytes());
    assert!(told(&old).contains("expected NanoVDB version 32, got 31.0.0"), "{}", told(&old));
    let vdb = [0x5644_4220u32.to_le_bytes().to_vec(), vec![0; 60]].concat();
    assert!(told(&vdb).contains("OpenVDB"), "{}", told(&vdb));
    let vectors = file(0, &[Spec { kind: 6, ..spec(1) }], |b| b);
    assert!(told(&vectors).contains("type 6"), "{}", told(&vectors));
}

/// A node that names itself, or one node many times: no more work than the file has room for.
#[test]
fn cycles_end() {
    let mut bytes = writer::grid(&spec(1));
    bytes[7] = b'1';
    let upper = 672 + 64 + 64 + 32 * 4;
    let mask = bytes[upper + 32 + 4096..upper + 32 + 8192].iter().position(|b| *b != 0).unwrap();
    // every child of the first upper node is its first one
    let (i, _) =
        (8 * mask..).map(|i| (i, i)).find(|(i, _)| bytes[upper + 4128 + i / 8] >> (i % 8) & 1 == 1).unwrap();
    let offset: [u8; 8] = bytes[upper + 8256 + 8 * i..][..8].try_into().unwrap();
    for n in 0..32_768 {
        bytes[upper + 4128 + n / 8] = 0xff;
        bytes[upper + 8256 + 8 * n..][..8].copy_from_slice(&offset);
    }
    assert!(read(&bytes, "density").unwrap_err().to_string().contains("more nodes"));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Damage anywhere in what describes the grid gives an error or a grid, never a panic.
    #[test]
    fn damage_is_survived(at in 0usize..2000, bytes in prop::collection::vec(any::<u8>(), 1..12), cut in 0usize..400_000) {
        let small = Spec { first: [0; 3], last: [7; 3], ..spec(16) };
        let mut data = file(0, &[small], |b| b);
        let end = (at + bytes.len()).min(data.len());
        let count = end - at;
        data[at..end].copy_from_slice(&bytes[..count]);
        data.truncate(data.len() - cut.min(data.len()) * usize::from(cut % 3 == 0));
        let _ = read(&data, "density");
    }

    #[test]
    fn packed_damage_is_survived(codec in 1u16..3, at in 0usize..4000, byte in any::<u8>()) {
        let small = Spec { first: [0; 3], last: [7; 3], ..spec(1) };
        let mut data = file(codec, &[small], if codec == 1 { zip } else { blosc });
        let at = at % data.len();
        data[at] = byte;
        let _ = read(&data, "density");
    }
}

fn survive(count: u32) {
    let small = |kind| Spec { first: [0; 3], last: [7; 3], ..spec(kind) };
    let mut seeds: Vec<Vec<u8>> = [1, 13, 14, 16].map(|kind| file(0, &[small(kind)], |b| b)).into();
    seeds.extend([file(1, &[small(1)], zip), file(2, &[small(2)], blosc)]);
    mutate::survive(&seeds, count, |bytes| {
        let (_dir, path) = on_disk(bytes);
        let Ok(file) = NanoVdb::open(&path) else { return };
        for name in file.names() {
            let _ = file.grid(name).and_then(|g| g.as_ref().map(leaves).transpose());
        }
    });
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
