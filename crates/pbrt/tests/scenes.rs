//! Whole scenes: every directive, files within files, line ends and encodings.

#![allow(clippy::unwrap_used, reason = "a test that cannot unwrap has failed")]

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use tyndall_pbrt::{
    Directive, DirectiveKind as D, EntityKind, Limits, OptionValue, Parser, Scene, SpectrumValue, parse_file,
    parse_str, to_text,
};

fn good(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join("good").join(name)
}

fn everything() -> Scene {
    parse_file(good("everything.pbrt")).unwrap()
}

fn shapes(scene: &Scene) -> Vec<String> {
    let entities = scene.directives.iter().filter_map(|d| match &d.kind {
        D::Entity(e) if e.kind == EntityKind::Shape => Some(e.name.to_string()),
        _ => None,
    });
    entities.collect()
}

#[test]
fn every_directive_is_read() {
    let scene = everything();
    assert_eq!(shapes(&scene), ["\"sphere\"", "\"bilinearmesh\"", "\"disk\"", "\"cylinder\""]);
    let has = |kind: &D| scene.directives.iter().any(|d| d.kind == *kind);
    for kind in [
        D::LookAt([3.0, 4.0, 1.5, 0.5, 0.5, 0.0, 0.0, 0.0, 1.0]),
        D::TransformTimes([0.0, 1.0]),
        D::Rotate([45.0, 0.0, 1.0, 0.0]),
        D::Scale([1.0, 1.0, 2.0]),
        D::ConcatTransform([1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 3., 0., 0., 1.]),
        D::Identity,
        D::ReverseOrientation,
        D::WorldBegin,
        D::ObjectEnd,
        D::ImportEnd,
    ] {
        assert!(has(&kind), "{kind}");
    }
    let option = scene.directives.iter().find_map(|d| match &d.kind {
        D::Option(name, value) if name.as_str() == "seed" => Some(value.clone()),
        _ => None,
    });
    assert_eq!(option, Some(OptionValue::Number(7.0)));
}

#[test]
fn one_medium_name_counts_for_both_sides() {
    let scene = everything();
    let sides: Vec<_> = scene
        .directives
        .iter()
        .filter_map(|d| match &d.kind {
            D::MediumInterface { interior, exterior } => Some((interior.as_str(), exterior.as_str())),
            _ => None,
        })
        .collect();
    assert_eq!(sides, [("", "fog"), ("fog", "fog")]);
}

#[test]
fn transform_blocks_are_attribute_blocks_with_one_warning() {
    let scene = parse_str("t", "WorldBegin TransformBegin TransformEnd TransformBegin TransformEnd").unwrap();
    let kinds: Vec<_> = scene.directives.iter().map(|d| d.kind.clone()).collect();
    assert_eq!(kinds[1..], [D::AttributeBegin, D::AttributeEnd, D::AttributeBegin, D::AttributeEnd]);
    let warnings = scene.diagnostics.to_vec();
    assert_eq!(warnings.len(), 1);
    assert!(warnings[0].to_string().starts_with("t:1:12: warning: TransformBegin"), "{}", warnings[0]);
}

#[test]
fn included_text_stands_in_place_and_names_its_own_file() {
    let scene = everything();
    let disk = scene.directives.iter().find(|d| d.to_string() == "Shape \"disk\"").unwrap();
    let at = scene.sources.location(disk.span);
    assert!(at.path.ends_with("nested.pbrt"), "{at}");
    assert_eq!((at.line, at.column), (1, 5));
    let notes: Vec<_> = scene.diagnostics.to_vec().iter().map(ToString::to_string).collect();
    assert!(notes.iter().any(|n| n.contains("beside the file that names it")), "{notes:?}");
}

#[test]
fn an_import_is_fenced_and_keeps_its_media_apart() {
    let scene = everything();
    let begin = scene.directives.iter().position(|d| matches!(d.kind, D::ImportBegin(_))).unwrap();
    let inside = &scene.directives[begin + 1..scene.directives.len() - 1];
    assert_eq!(inside.len(), 5);
    assert_eq!(inside[0].kind, D::Translate([5.0, 0.0, 0.0]));
    assert_eq!(scene.directives.last().unwrap().kind, D::ImportEnd);
}

#[test]
fn blocks_do_not_reach_out_of_an_import() {
    let dir = tempfile::tempdir().unwrap();
    let main = dir.path().join("main.pbrt");
    fs::write(&main, "WorldBegin AttributeBegin Import \"part.pbrt\" AttributeEnd").unwrap();
    for (part, message) in [
        ("AttributeEnd", "there is no open AttributeBegin"),
        ("AttributeBegin", "AttributeBegin is not closed"),
        ("ObjectEnd", "there is no open ObjectBegin"),
    ] {
        fs::write(dir.path().join("part.pbrt"), part).unwrap();
        let error = parse_file(&main).unwrap_err();
        assert!(error.to_string().contains(message), "{error}");
        assert!(error.location().unwrap().path.ends_with("part.pbrt"));
    }
    fs::write(&main, "WorldBegin AttributeBegin Include \"part.pbrt\"").unwrap();
    fs::write(dir.path().join("part.pbrt"), "AttributeEnd").unwrap();
    parse_file(&main).expect("an include may close the block around it");
}

#[test]
fn text_written_back_reads_the_same() {
    let scene = everything();
    let text = to_text(&scene.directives);
    let dir = good("");
    let again = Parser::from_bytes("again", text.into_bytes(), &dir).unwrap().parse().unwrap();
    assert_eq!(again.directives, scene.directives);
}

#[test]
fn line_ends_byte_order_mark_tabs_and_missing_newline() {
    let plain = fs::read_to_string(good("everything.pbrt")).unwrap().replace("\r\n", "\n");
    let windows = format!("\u{feff}{}", plain.trim_end().replace('\n', "\r\n").replace("    ", "\t"));
    let scene = Parser::from_bytes("windows", windows.into_bytes(), &good("")).unwrap().parse().unwrap();
    assert_eq!(scene.directives, everything().directives);
    let first = &scene.directives[0];
    assert_eq!(scene.sources.location(first.span).to_string(), "windows:2:1");
}

#[test]
fn comments_may_be_in_any_encoding() {
    let text = b"# caf\xe9 \xff\xfe\nWorldBegin # \xe4\nShape \"sphere\"# no blank before\n".to_vec();
    let scene = Parser::from_bytes("latin", text, Path::new("")).unwrap().parse().unwrap();
    assert_eq!(scene.directives.len(), 2);
    let text = b"WorldBegin NamedMaterial \"caf\xe9\"".to_vec();
    let scene = Parser::from_bytes("latin", text, Path::new("")).unwrap().parse().unwrap();
    assert!(scene.diagnostics.to_vec()[0].message.contains("UTF-8"));
}

fn gzip(text: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    encoder.write_all(text).unwrap();
    encoder.finish().unwrap()
}

#[test]
fn gzipped_scenes_and_includes() {
    let dir = tempfile::tempdir().unwrap();
    let main = dir.path().join("scene.pbrt.gz");
    fs::write(&main, gzip(b"WorldBegin\nInclude \"geometry.pbrt.gz\"\n")).unwrap();
    fs::write(dir.path().join("geometry.pbrt.gz"), gzip(b"Shape \"sphere\"\n  \"float radius\" x")).unwrap();
    let error = parse_file(&main).unwrap_err();
    let at = error.location().unwrap();
    assert!(at.path.ends_with("geometry.pbrt.gz"));
    assert_eq!((at.line, at.column), (2, 18));
}

#[test]
fn a_large_file_is_mapped_and_read() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("large.pbrt");
    let numbers = "0.125 -3 1e2\n".repeat(100_000);
    fs::write(&path, format!("WorldBegin Shape \"trianglemesh\" \"point3 P\" [\n{numbers}]")).unwrap();
    let scene = parse_file(&path).unwrap();
    let D::Entity(mesh) = &scene.directives[1].kind else { panic!("a shape") };
    let points = mesh.params.point3s("P").unwrap().unwrap();
    assert_eq!(points.len(), 100_000);
    assert!(points.iter().all(|p| *p == [0.125, -3.0, 100.0]));
    let error = mesh.params.error_at_index("P", 3 * 99_999 + 1, "must be up", "down");
    assert_eq!(error.location().unwrap().line, 100_001);
    assert_eq!(error.location().unwrap().column, 7);
}

#[test]
fn windows_paths_of_other_machines() {
    let dir = tempfile::tempdir().unwrap();
    fs::create_dir(dir.path().join("new")).unwrap();
    fs::write(dir.path().join("new").join("tree.pbrt"), "Shape \"sphere\"").unwrap();
    let main = dir.path().join("main.pbrt");
    for name in [r"new\tree.pbrt", r"new\\tree.pbrt", r"C:\Users\me\new\tree.pbrt"] {
        fs::write(&main, format!("WorldBegin Include \"{name}\"")).unwrap();
        let scene = parse_file(&main).unwrap();
        assert_eq!(shapes(&scene).len(), 1);
        assert_eq!(scene.diagnostics.len(), 1, "{name}: a note says where it was found");
    }
}

#[test]
fn hostile_includes_are_bounded() {
    let dir = tempfile::tempdir().unwrap();
    // 20 levels, each including the next twice: a million files unless bounded
    for level in 0..20 {
        let next = format!("Include \"{0}.pbrt\"\nInclude \"{0}.pbrt\"\n", level + 1);
        fs::write(dir.path().join(format!("{level}.pbrt")), next).unwrap();
    }
    fs::write(dir.path().join("20.pbrt"), "Identity").unwrap();
    let open = || Parser::open(&dir.path().join("0.pbrt")).unwrap();
    let many = open().limits(Limits { files: 500, ..Limits::default() }).parse().unwrap_err();
    assert!(many.to_string().ends_with("files in one scene: expected at most 500"), "{many}");
    let deep = open().limits(Limits { include_depth: 8, ..Limits::default() }).parse().unwrap_err();
    assert!(deep.to_string().ends_with("files within files: expected at most 8"), "{deep}");
}

#[test]
fn a_file_that_is_not_there() {
    let error = parse_file("no/such/scene.pbrt").unwrap_err();
    assert!(error.to_string().starts_with("no/such/scene.pbrt: cannot read the file"), "{error}");
    let error = parse_file(good("")).unwrap_err();
    assert!(error.to_string().contains("directory"), "{error}");
}

#[test]
fn fragments_need_no_world() {
    let parse = |text: &str| Parser::from_bytes("f", text.into(), Path::new("")).unwrap().fragment().parse();
    assert_eq!(parse("Shape \"sphere\"").unwrap().directives.len(), 1);
    assert!(parse("").unwrap().directives.is_empty());
}

#[test]
fn spectra_of_every_kind() {
    let scene = everything();
    let all: Vec<SpectrumValue> = scene
        .directives
        .iter()
        .filter_map(|d| match &d.kind {
            D::Entity(e) if matches!(e.kind, EntityKind::LightSource | EntityKind::MakeNamedMedium) => {
                Some(e)
            }
            _ => None,
        })
        .flat_map(|e| ["sigma_a", "sigma_s", "L"].map(|name| e.params.spectrum(name).unwrap()))
        .flatten()
        .collect();
    let samples = SpectrumValue::Samples { lambda: vec![400.0, 700.0], values: vec![0.1, 0.2] };
    let rgb = SpectrumValue::Rgb { rgb: [1.0, 2.0, 3.0], color_space: None };
    assert_eq!(all[..3], [samples, rgb, SpectrumValue::Blackbody(5000.0)]);
    assert!(matches!(&all[3], SpectrumValue::Named(name) if name.as_str() == "stdillum-D65"));
}

#[test]
fn long_lines_are_shown_in_part() {
    let text = format!("WorldBegin Shape \"curve\" \"point3 P\" [ {}x", "1.5 ".repeat(100_000));
    let error = parse_str("long", &text).unwrap_err();
    let handler = miette::GraphicalReportHandler::new_themed(miette::GraphicalTheme::none());
    let mut report = String::new();
    handler.render_report(&mut report, &error).unwrap();
    assert!(report.len() < 1000, "{} bytes", report.len());
    assert!(report.contains("1.5 1.5 x"), "{report}");
}

#[test]
fn directives_can_be_taken_one_by_one() {
    let mut parser =
        Parser::from_bytes("p", "Identity Identity nonsense Identity".into(), Path::new("")).unwrap();
    let one: Directive = parser.next().unwrap().unwrap();
    assert_eq!(one.kind, D::Identity);
    assert!(parser.next().unwrap().is_ok());
    assert!(parser.next().unwrap().is_err());
    assert!(parser.next().is_none(), "an error is the end");
}
