//! OpenVDB files written here come back, whatever the compression and the rule for inactive values; damaged ones are refused.

mod mutate;

use proptest::prelude::*;
use std::{collections::BTreeMap, io::Write, path::PathBuf};
use tyndall_files::{
    FileError,
    volume::{Class, Grid, Piece, Volume},
};

const BACKGROUND: f32 = 0.25;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Codec {
    Plain,
    Zip,
    Blosc,
}

/// How a file is written.
#[derive(Clone, Copy, Debug)]
struct Spec {
    codec: Codec,
    /// Only active values are stored.
    masked: bool,
    /// Rule for inactive values of leaves.
    rule: u8,
    half: bool,
    map: &'static str,
    kind: &'static str,
}

const SPEC: Spec = Spec {
    codec: Codec::Plain,
    masked: true,
    rule: 0,
    half: false,
    map: "UniformScaleTranslateMap",
    kind: "Tree_float_5_4_3",
};

/// Leaves at these places, in the order of the tree, and what is in them.
const LEAVES: [[i32; 3]; 3] = [[-4096, 0, 0], [-4096, 0, 8], [-4096, 128, 0]];
/// An active tile of the lower node at (-4096, 0, 0), and one of the root.
const TILE: ([i32; 3], f32) = ([-4096 + 8, 0, 0], 1.5);
const ROOT_TILE: ([i32; 3], f32) = ([0, 0, 0], 0.5);

fn is_active(i: usize) -> bool {
    i % 3 != 1
}

fn chosen(i: usize) -> bool {
    i.is_multiple_of(2)
}

/// Value of voxel `i` of leaf `leaf`, exact in 16 bits.
fn value(leaf: usize, i: usize, rule: u8) -> f32 {
    if is_active(i) {
        return (leaf * 512 + i) as f32 / 8.0;
    }
    match rule {
        0 => BACKGROUND,
        1 => -BACKGROUND,
        2 => 7.0,
        3 => {
            if chosen(i) {
                BACKGROUND
            } else {
                -BACKGROUND
            }
        }
        4 => {
            if chosen(i) {
                BACKGROUND
            } else {
                7.0
            }
        }
        5 => {
            if chosen(i) {
                9.0
            } else {
                7.0
            }
        }
        _ => 11.0,
    }
}

fn text(s: &str) -> Vec<u8> {
    [&(s.len() as u32).to_le_bytes(), s.as_bytes()].concat()
}

fn mask(bits: usize, has: impl Fn(usize) -> bool) -> Vec<u8> {
    (0..bits / 8).map(|b| (0..8).map(|k| u8::from(has(8 * b + k)) << k).sum()).collect()
}

fn numbers(spec: &Spec, values: &[f32]) -> Vec<u8> {
    let double = spec.kind.contains("double");
    let of = |v: &f32| match (spec.half, double) {
        (true, _) => half::f16::from_f32(*v).to_le_bytes().to_vec(),
        (_, true) => f64::from(*v).to_le_bytes().to_vec(),
        _ => v.to_le_bytes().to_vec(),
    };
    values.iter().flat_map(of).collect()
}

fn lone(spec: &Spec, v: f32) -> Vec<u8> {
    numbers(&Spec { half: false, ..*spec }, &[v])
}

/// One block, one stream, not shuffled.
fn blosc(plain: &[u8]) -> Vec<u8> {
    let packed = lz4_flex::block::compress(plain);
    let packed = if packed.len() < plain.len() { packed } else { plain.to_vec() };
    let size = plain.len() as u32;
    let mut out = vec![2, 1, 1 << 5 | 16, 4];
    out.extend([size, size, 20 + 4 + packed.len() as u32, 20].iter().flat_map(|v| v.to_le_bytes()));
    out.extend((packed.len() as u32).to_le_bytes());
    out.extend(packed);
    out
}

fn packed(spec: &Spec, values: &[f32]) -> Vec<u8> {
    let plain = numbers(spec, values);
    if spec.half && values.is_empty() {
        return plain;
    }
    let small = match spec.codec {
        Codec::Plain => return plain,
        Codec::Zip => {
            let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
            encoder.write_all(&plain).expect("memory takes it");
            encoder.finish().expect("memory takes it")
        }
        Codec::Blosc => blosc(&plain),
    };
    if plain.len() < 64 {
        // too short to gain: stored as it is, with a negative length
        return [(-(plain.len() as i64)).to_le_bytes().to_vec(), plain].concat();
    }
    [(small.len() as i64).to_le_bytes().to_vec(), small].concat()
}

/// Values of a node with the rule's inactive values and mask in front.
fn node(spec: &Spec, rule: u8, values: &[f32], active: impl Fn(usize) -> bool) -> Vec<u8> {
    let mut out = vec![rule];
    if matches!(rule, 2 | 4 | 5) {
        out.extend(lone(spec, 7.0));
    }
    if rule == 5 {
        out.extend(lone(spec, 9.0));
    }
    if matches!(rule, 3..=5) {
        out.extend(mask(values.len(), chosen));
    }
    let kept: Vec<f32> = if spec.masked && rule != 6 {
        values.iter().enumerate().filter(|(i, _)| active(*i)).map(|(_, v)| *v).collect()
    } else {
        values.to_vec()
    };
    out.extend(packed(spec, &kept));
    out
}

/// An upper node at (-4096, 0, 0) with two lower nodes, the first with two leaves and a tile, the second with one leaf.
fn topology(spec: &Spec) -> Vec<u8> {
    let mut out = 1u32.to_le_bytes().to_vec();
    out.extend(lone(spec, BACKGROUND));
    out.extend([1u32, 1].iter().flat_map(|v| v.to_le_bytes()));
    out.extend(ROOT_TILE.0.iter().flat_map(|v| v.to_le_bytes()));
    out.extend(lone(spec, ROOT_TILE.1));
    out.push(1);
    out.extend([-4096i32, 0, 0].iter().flat_map(|v| v.to_le_bytes()));
    // children 0 and (0, 1, 0)
    out.extend(mask(32768, |i| i == 0 || i == 32));
    out.extend(mask(32768, |_| false));
    out.extend(node(spec, 0, &[BACKGROUND; 32768], |_| false));
    for (children, tile) in [([0, 1], Some(256)), ([0, 0], None)] {
        let mut values = [BACKGROUND; 4096];
        if let Some(i) = tile {
            values[i] = TILE.1;
        }
        let is_tile = |i| Some(i) == tile;
        out.extend(mask(4096, |i| children.contains(&i)));
        out.extend(mask(4096, is_tile));
        out.extend(node(spec, 0, &values, is_tile));
        let distinct = if children[0] == children[1] { 1 } else { 2 };
        for _ in 0..distinct {
            out.extend(mask(512, is_active));
        }
    }
    out
}

fn leaves(spec: &Spec) -> Vec<u8> {
    let leaf = |k: usize| {
        let values: Vec<f32> = (0..512).map(|i| value(k, i, spec.rule)).collect();
        [mask(512, is_active), node(spec, spec.rule, &values, is_active)].concat()
    };
    (0..LEAVES.len()).flat_map(leaf).collect()
}

fn map(name: &str) -> Vec<u8> {
    let matrix = [[0.5, 0.0, 0.0, 0.0], [0.0, 0.5, 0.0, 0.0], [0.1, 0.0, 0.5, 0.0], [1.0, 2.0, 3.0, 1.0]];
    let numbers: Vec<f64> = match name {
        "AffineMap" => matrix.concat(),
        "UniformScaleMap" => vec![0.5; 15],
        _ => [vec![1.0, 2.0, 3.0], vec![0.5; 15]].concat(),
    };
    [text(name), numbers.iter().flat_map(|v| v.to_le_bytes()).collect()].concat()
}

fn file(spec: &Spec) -> Vec<u8> {
    let mut out = 0x5644_4220u64.to_le_bytes().to_vec();
    out.extend([224u32, 10, 0].iter().flat_map(|v| v.to_le_bytes()));
    out.push(1);
    out.extend([b'0'; 36]);
    out.extend(0u32.to_le_bytes());
    out.extend(1u32.to_le_bytes());
    out.extend(text("density\u{1e}0"));
    out.extend(text(&format!("{}{}", spec.kind, if spec.half { "_HalfFloat" } else { "" })));
    out.extend(text(""));
    let at = out.len() as u64 + 24;
    let flags = match spec.codec {
        Codec::Plain => 0,
        Codec::Zip => 1,
        Codec::Blosc => 4,
    };
    let mut grid = (flags | if spec.masked { 2u32 } else { 0 }).to_le_bytes().to_vec();
    grid.extend(1u32.to_le_bytes());
    grid.extend([text("class"), text("string"), text("fog volume")].concat());
    grid.extend(map(spec.map));
    grid.extend(topology(spec));
    grid.extend(leaves(spec));
    // readers go on behind the tree, wherever the second place points
    out.extend([at, at, at + grid.len() as u64].iter().flat_map(|v| v.to_le_bytes()));
    out.extend(grid);
    out
}

fn stored(bytes: &[u8]) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("smoke.vdb");
    std::fs::write(&path, bytes).expect("written");
    (folder, path)
}

type Tiles = Vec<([i32; 3], u32, f32)>;

fn pieces(grid: &Grid<'_>) -> (BTreeMap<[i32; 3], Vec<f32>>, Tiles) {
    let (mut bricks, mut tiles) = (BTreeMap::new(), Vec::new());
    grid.visit::<FileError>(|origin, piece| {
        match piece {
            Piece::Brick(values) => drop(bricks.insert(origin, values.to_vec())),
            Piece::Tile(edge, value) => tiles.push((origin, edge, value)),
        }
        Ok(())
    })
    .expect("valid");
    (bricks, tiles)
}

fn check(spec: &Spec) {
    let (_folder, path) = stored(&file(spec));
    let volume = Volume::open(&path).expect("a file of OpenVDB");
    assert_eq!(volume.names(), ["density"]);
    assert!(volume.grid("temperature").expect("readable").is_none());
    let grid = volume.grid("density").unwrap_or_else(|e| panic!("{spec:?}: {e}")).expect("present");
    assert_eq!((grid.class(), grid.background()), (Class::FogVolume, BACKGROUND));
    assert_eq!(grid.index_box(), [[-4096, 0, 0], [4095, 4095, 4095]]);
    let (bricks, tiles) = pieces(&grid);
    assert_eq!(tiles, [(ROOT_TILE.0, 4096, ROOT_TILE.1), (TILE.0, 8, TILE.1)], "{spec:?}");
    assert_eq!(bricks.len(), LEAVES.len());
    for (k, origin) in LEAVES.iter().enumerate() {
        let expected: Vec<f32> = (0..512).map(|i| value(k, i, spec.rule)).collect();
        assert_eq!(bricks[origin], expected, "{spec:?} {origin:?}");
    }
}

#[test]
fn every_compression_and_rule_comes_back() {
    for codec in [Codec::Plain, Codec::Zip, Codec::Blosc] {
        for rule in 0..=6 {
            check(&Spec { codec, rule, ..SPEC });
        }
        check(&Spec { codec, masked: false, rule: 6, ..SPEC });
        check(&Spec { codec, half: true, rule: 5, ..SPEC });
        check(&Spec { codec, kind: "Tree_double_5_4_3", rule: 4, ..SPEC });
    }
}

#[test]
fn maps_place_the_voxels() {
    let to_world = |map| {
        let (_folder, path) = stored(&file(&Spec { map, ..SPEC }));
        Volume::open(&path).expect("valid").grid("density").expect("valid").expect("present").to_world()
    };
    let diagonal = |t: [f64; 3]| [[0.5, 0.0, 0.0, t[0]], [0.0, 0.5, 0.0, t[1]], [0.0, 0.0, 0.5, t[2]]];
    assert_eq!(to_world("UniformScaleMap"), diagonal([0.0; 3]));
    assert_eq!(to_world("ScaleTranslateMap"), diagonal([1.0, 2.0, 3.0]));
    // row vectors times the file's matrix
    let sheared = [[0.5, 0.0, 0.1, 1.0], [0.0, 0.5, 0.0, 2.0], [0.0, 0.0, 0.5, 3.0]];
    assert_eq!(to_world("AffineMap"), sheared);
}

#[test]
fn what_is_not_read_says_so() {
    let refused = |bytes: &[u8], why: &str| {
        let (_folder, path) = stored(bytes);
        let volume = Volume::open(&path);
        let message = match &volume {
            Err(e) => e.to_string(),
            Ok(v) => v.grid("density").expect_err("refused").to_string(),
        };
        assert!(message.contains(why), "{message}");
    };
    refused(&file(&Spec { kind: "Tree_vec3s_5_4_3", ..SPEC }), "Tree_vec3s_5_4_3");
    refused(&file(&Spec { map: "NonlinearFrustumMap", ..SPEC }), "NonlinearFrustumMap");
    let mut old = file(&SPEC);
    old[8] = 221;
    refused(&old, "version 221");
    let whole = file(&SPEC);
    refused(&whole[..whole.len() - 100], "within the file");
    refused(b"VDB", "bytes");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    /// Damage is an error or other numbers, never a panic.
    #[test]
    fn damaged_files_do_not_panic(
        zip in any::<bool>(),
        changes in prop::collection::vec((0.0f64..1.0, any::<u8>()), 1..4),
        near_the_start in any::<bool>(),
    ) {
        let codec = if zip { Codec::Zip } else { Codec::Blosc };
        let mut bytes = file(&Spec { codec, rule: 5, ..SPEC });
        let span = if near_the_start { 400 } else { bytes.len() };
        for (place, byte) in changes {
            bytes[(place * span as f64) as usize] = byte;
        }
        let (_folder, path) = stored(&bytes);
        if let Ok(volume) = Volume::open(&path)
            && let Ok(Some(grid)) = volume.grid("density")
        {
            pieces(&grid);
        }
    }
}

fn survive(count: u32) {
    let spec = |codec, rule, half| file(&Spec { codec, rule, half, ..SPEC });
    let seeds = [
        spec(Codec::Plain, 0, false),
        spec(Codec::Plain, 5, true),
        spec(Codec::Zip, 3, false),
        spec(Codec::Blosc, 5, false),
    ];
    mutate::survive(&seeds, count, |bytes| {
        let (_folder, path) = stored(bytes);
        let Ok(volume) = Volume::open(&path) else { return };
        for name in volume.names() {
            if let Ok(Some(grid)) = volume.grid(name) {
                pieces(&grid);
            }
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
