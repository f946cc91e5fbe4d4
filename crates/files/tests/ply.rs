//! PLY: the hand-made files in `data/`, an independent reader as a judge, and damage.

mod mutate;

use ply_rs_bw::{parser::Parser, ply::DefaultElement, ply::Property};
use proptest::prelude::*;
use std::path::{Path, PathBuf};
use tyndall_base::vec::{vec2, vec3};
use tyndall_files::{FileError, mesh::*};

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)
}

fn decode(bytes: &[u8]) -> Result<PlyMesh, FileError> {
    decode_ply(bytes, bytes.len() as u64, Path::new("memory.ply"))
}

fn message(bytes: &[u8]) -> String {
    decode(bytes).expect_err("damaged").to_string()
}

#[test]
fn ascii_with_faces_of_every_size() {
    let mesh = read_ply(&data("mixed_ascii.ply")).expect("a sound file");
    let positions = [
        vec3(0.0, 0.0, 0.0),
        vec3(1.0, 0.0, 0.0),
        vec3(1.0, 1.0, 0.5),
        vec3(0.0, 1.0, 0.0),
        vec3(2.0, 0.5, -1.0),
    ];
    assert_eq!(mesh.positions, positions);
    assert_eq!(mesh.uv, [vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(1.0, 1.0), vec2(0.0, 1.0), vec2(0.5, 0.5)]);
    assert!(mesh.normals.is_empty());
    assert_eq!(mesh.quads, [[0, 1, 3, 2]], "in the order of a bilinear patch");
    assert_eq!(mesh.quad_face_indices, [7]);
    assert_eq!(mesh.triangles, [[1, 4, 2], [0, 1, 4], [0, 4, 2], [0, 2, 3]], "a triangle and a fan");
    assert_eq!(mesh.triangle_face_indices, [8, 9, 9, 9]);
    assert_eq!((mesh.fanned_faces, mesh.skipped_faces), (1, 1));
}

#[test]
fn binary_of_both_byte_orders_and_gzip_agree() {
    let little = read_ply(&data("binary_le.ply")).expect("a sound file");
    assert_eq!(little.positions.len(), 5);
    assert_eq!(little.positions[4], vec3(2.0, 0.5, -1.0));
    assert_eq!(little.normals, [vec3(0.0, 0.0, 1.0); 5]);
    assert_eq!(little.uv[4], vec2(0.5, 0.5));
    assert_eq!(little.triangles, [[0, 1, 2]]);
    assert_eq!(little.quads, [[0, 1, 3, 2]]);
    assert_eq!(read_ply(&data("binary_be.ply")).expect("a sound file"), little);
    assert_eq!(read_ply(&data("binary_le.ply.gz")).expect("a sound file"), little);
}

#[test]
fn the_crate_ply_rs_reads_the_same() {
    for name in ["mixed_ascii.ply", "binary_le.ply", "binary_be.ply"] {
        let ours = read_ply(&data(name)).expect("a sound file");
        let mut file = std::io::BufReader::new(std::fs::File::open(data(name)).expect("a file of ours"));
        let theirs = Parser::<DefaultElement>::new().read_ply(&mut file).expect("a sound file");
        let number = |p: &Property| match p {
            Property::Float(v) => *v,
            Property::Double(v) => *v as f32,
            other => panic!("{other:?}"),
        };
        let positions: Vec<_> =
            theirs.payload["vertex"].iter().map(|v| ["x", "y", "z"].map(|c| number(&v[c]))).collect();
        assert_eq!(ours.positions.iter().map(|p| [p.x, p.y, p.z]).collect::<Vec<_>>(), positions, "{name}");
        let lengths = theirs.payload["face"].iter().map(|f| match f.values().find_map(list_length) {
            Some(n) => n,
            None => panic!("a face without a list"),
        });
        let triangles: usize = lengths.clone().filter(|n| *n != 4).map(|n| n.saturating_sub(2)).sum();
        assert_eq!(ours.triangles.len(), triangles, "{name}");
        assert_eq!(ours.quads.len(), lengths.filter(|n| *n == 4).count(), "{name}");
    }
}

fn list_length(property: &Property) -> Option<usize> {
    match property {
        Property::ListInt(v) => Some(v.len()),
        Property::ListUInt(v) => Some(v.len()),
        _ => None,
    }
}

const VERTEX: &str = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
const FACE: &str = "element face 1\nproperty list uchar int vertex_indices\n";

fn ascii(head: &str, body: &str) -> Vec<u8> {
    format!("ply\nformat ascii 1.0\n{head}end_header\n{body}").into_bytes()
}

#[test]
fn every_name_of_texture_coordinates() {
    for [u, v] in [["u", "v"], ["s", "t"], ["texture_u", "texture_v"], ["texture_s", "texture_t"]] {
        let head = format!("{VERTEX}property float {u}\nproperty float {v}\n{FACE}");
        let mesh =
            decode(&ascii(&head, "0 0 0 .25 .5\n1 0 0 0 0\n0 1 0 1 1\n3 0 1 2\n")).expect("a sound file");
        assert_eq!(mesh.uv[0], vec2(0.25, 0.5));
    }
}

#[test]
fn windows_line_ends_and_faces_before_vertices() {
    let text = format!("ply\nformat ascii 1.0\n{FACE}{VERTEX}end_header\n3 2 1 0\n0 0 0\n1 0 0\n0 1 0\n");
    let mesh = decode(text.replace('\n', "\r\n").as_bytes()).expect("a sound file");
    assert_eq!(mesh.triangles, [[2, 1, 0]]);
}

#[test]
fn a_billion_vertices_are_refused_before_they_are_allocated() {
    for format in ["ascii", "binary_little_endian"] {
        let vertex = VERTEX.replace("vertex 3", "vertex 1000000000");
        let text = format!("ply\nformat {format} 1.0\n{vertex}{FACE}end_header\n");
        assert!(matches!(decode(text.as_bytes()), Err(FileError::Oversized { .. })), "{format}");
        let faces =
            text.replace("vertex 1000000000", "vertex 3").replace("face 1\n", "face 18446744073709551615\n");
        assert!(matches!(decode(faces.as_bytes()), Err(FileError::Oversized { .. })), "{format}");
    }
}

#[test]
fn damage_is_named_with_its_line() {
    let head = format!("{VERTEX}{FACE}");
    let vertices = "0 0 0\n1 0 0\n0 1 0\n";
    let case = |body: &str| message(&ascii(&head, body));
    let indices = case(&format!("{vertices}3 0 1 3\n"));
    assert!(
        indices.starts_with("memory.ply:13: expected vertex indices from 0 to 2 in face 0, got 3"),
        "{indices}"
    );
    assert!(case(&format!("{vertices}3 0 -1 2\n")).contains("got -1"));
    assert!(
        case("0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n")
            .contains("memory.ply:10: expected finite coordinates in vertex 0")
    );
    assert!(case("0 0 1e99\n1 0 0\n0 1 0\n3 0 1 2\n").contains("finite"));
    assert!(case("0 x 0\n").contains("`x` for a number"));
    assert!(case(vertices).contains("the end of the file"));
    assert!(case(&format!("{vertices}-3 0 1 2\n")).contains("`-3` for an integer from 0 to 255"));
    assert!(case(&format!("{vertices}3 0 1.5 2\n")).contains("`1.5` for a signed 32-bit integer"));
}

#[test]
fn damaged_headers_are_named() {
    let head = |text: &str| message(text.as_bytes());
    assert!(head("").contains("the end of the file"));
    assert!(head("PLY\n").contains("`ply` in the first line"));
    assert!(head("ply\nformat ascii 2.0\n").contains("version 2.0"));
    assert!(head("ply\nformat text 1.0\n").contains("`text`"));
    assert!(head("ply\nproperty float x\n").contains("`element` before"));
    assert!(head("ply\nelement vertex -1\n").contains("a count from 0"));
    assert!(head("ply\nelement vertex 1\nproperty real x\n").contains("a type of PLY"));
    assert!(head("ply\nelement face 1\nproperty list float int i\n").contains("INTEGER-TYPE"));
    assert!(head("ply\nelement vertex 1\nproperty float x\nproperty float x\n").contains("`x` again"));
    assert!(head("ply\nend_header\n").contains("`format ...`"));
    assert!(head("ply\nwhatever\n").contains("`whatever`"));
    assert!(head(&format!("ply\n{}", "x".repeat(5000))).contains("4096"));
    assert!(message(&ascii(VERTEX, "")).contains("an element `face`"));
    assert!(message(&ascii(FACE, "")).contains("an element `vertex`"));
    assert!(message(&ascii(&format!("{VERTEX}{VERTEX}{FACE}"), "")).contains("one element `vertex`"));
    assert!(
        message(&ascii(&format!("{VERTEX}element face 1\nproperty int n\n"), "")).contains("vertex_indices")
    );
    assert!(
        message(&ascii(&format!("element vertex 1\nproperty float x\n{FACE}"), "")).contains("`x`, `y`, `z`")
    );
}

#[test]
fn every_truncation_is_an_error() {
    for name in ["binary_le.ply", "binary_be.ply", "binary_le.ply.gz"] {
        let bytes = std::fs::read(data(name)).expect("a file of ours");
        for length in 0..bytes.len() {
            assert!(decode(&bytes[..length]).is_err(), "{name} {length}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn mutations_never_panic(
        which in 0..4_usize,
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..10),
    ) {
        let names = ["mixed_ascii.ply", "binary_le.ply", "binary_be.ply", "binary_le.ply.gz"];
        let mut bytes = std::fs::read(data(names[which])).expect("a file of ours");
        for (at, value) in edits {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        if let Ok(mesh) = decode(&bytes) {
            let vertices = mesh.positions.len() as u32;
            prop_assert!(mesh.triangles.iter().flatten().chain(mesh.quads.iter().flatten()).all(|i| *i < vertices));
            prop_assert!(mesh.positions.iter().all(|p| p.x.is_finite() && p.y.is_finite() && p.z.is_finite()));
        }
    }

    #[test]
    fn any_mesh_comes_back(
        points in prop::collection::vec(prop::array::uniform3(-1e30_f32..1e30), 1..20),
        corners in prop::collection::vec(prop::collection::vec(any::<prop::sample::Index>(), 3..6), 0..20),
    ) {
        let faces: Vec<Vec<usize>> =
            corners.iter().map(|f| f.iter().map(|i| i.index(points.len())).collect()).collect();
        let head = format!(
            "{}{}",
            VERTEX.replace("vertex 3", &format!("vertex {}", points.len())),
            FACE.replace("face 1", &format!("face {}", faces.len()))
        );
        let mut body: String = points.iter().map(|[x, y, z]| format!("{x} {y} {z}\n")).collect();
        for face in &faces {
            let words: Vec<_> = face.iter().map(usize::to_string).collect();
            body += &format!("{} {}\n", face.len(), words.join(" "));
        }
        let mesh = decode(&ascii(&head, &body)).expect("a sound file");
        prop_assert_eq!(mesh.positions.iter().map(|p| [p.x, p.y, p.z]).collect::<Vec<_>>(), points);
        prop_assert_eq!(mesh.quads.len(), faces.iter().filter(|f| f.len() == 4).count());
        prop_assert_eq!(mesh.fanned_faces, faces.iter().filter(|f| f.len() == 5).count());
    }
}

fn survive(count: u32) {
    let names = ["mixed_ascii.ply", "binary_le.ply", "binary_be.ply", "binary_le.ply.gz"];
    let seeds = names.map(|n| std::fs::read(data(n)).expect("a file of ours"));
    mutate::survive(&seeds, count, |bytes| {
        if let Ok(mesh) = decode(bytes) {
            let vertices = mesh.positions.len() as u32;
            assert!(
                mesh.triangles.iter().flatten().chain(mesh.quads.iter().flatten()).all(|i| *i < vertices)
            );
            assert!(mesh.positions.iter().all(|p| p.x.is_finite() && p.y.is_finite() && p.z.is_finite()));
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
