//! Bad input: one clear message with its place, a hint, exit code 2, never a panic.

mod common;

use common::Place;

const HEAD: &str = "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\nWorldBegin\n";

/// The refusal of a scene whose third line is `line`.
fn refused(line: &str) -> String {
    let place = Place::new();
    place.write("a.pbrt", format!("{HEAD}{line}\n"));
    let ran = place.run("render a.pbrt --spp 1 --quiet");
    assert!(!place.has("a.exr"), "{line}");
    format!("{}\n{}", ran.refusal(), ran.err)
}

#[test]
fn mistakes_in_the_text() {
    for (line, message) in [
        ("Shpae \"sphere\"", "a.pbrt:3:1: unknown directive `Shpae`"),
        (
            "Shape \"sphere\" \"string radius\" \"x\"",
            "a.pbrt:3:16: radius: expected a parameter of type `float`, got `string`",
        ),
        ("Shape \"sphere\" \"float radius\" nan", "a.pbrt:3:31: radius: expected a finite number, got `nan`"),
        ("Shape \"trianglemesh\" \"point3 P\" [0 0 1 0", "list is not closed"),
        ("Include \"nowhere.pbrt\"", "a.pbrt:3:9: file `nowhere.pbrt` not found"),
        ("Include \"a.pbrt\"", "cyclic Include: a.pbrt -> a.pbrt"),
        ("AttributeBegin", "AttributeBegin is not closed"),
        ("MediumInterface \"fgo\" \"\"\nShape \"sphere\"", "no medium is named \"fgo\""),
    ] {
        let text = refused(line);
        assert!(text.contains(message), "{line}\n{text}");
    }
    assert!(refused("Shpae \"sphere\"").contains("hint: did you mean `Shape`?"));
}

#[test]
fn mistakes_in_physics() {
    let medium = "MakeNamedMedium \"m\" \"string type\" \"homogeneous\"";
    for (line, message) in [
        (format!("{medium} \"float sigma_s\" -0.3"), "a.pbrt:3:"),
        (format!("{medium} \"float sigma_s\" -0.3"), "sigma_s: must be >= 0, got -0.3 1/m"),
        (format!("{medium} \"spectrum sigma_a\" [400 1 700 -2]"), "sigma_a: must be >= 0"),
        (format!("{medium} \"float g\" 1.5"), "g"),
        (
            "Material \"diffuse\" \"rgb reflectance\" [2 2 2]".into(),
            "reflectance: must be between 0 and 1, got 2",
        ),
        ("Camera \"perspective\" \"float fov\" 200".into(), "Camera"),
    ] {
        let text = refused(&line);
        assert!(text.contains(message), "{line}\n{text}");
    }
}

#[test]
fn files_that_are_no_scenes() {
    let place = Place::new();
    place.write("empty.pbrt", "");
    place.write("binary.pbrt", [0x7f, b'E', b'L', b'F', 0, 1, 2, 3, 0, 0, 0, 255]);
    place.write("cut.pbrt.gz", [0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 0, 3, 0x4b]);
    for (name, message) in [
        ("empty.pbrt", "the file is empty"),
        ("binary.pbrt", "looks binary"),
        ("cut.pbrt.gz", "cannot unpack the gzip file"),
        ("nowhere.pbrt", "nowhere.pbrt: cannot read the file"),
        (".", "it is a directory"),
    ] {
        for command in ["render", "info"] {
            let ran = place.run(&format!("{command} {name}"));
            assert!(ran.refusal().contains(message), "{command} {name}: {}", ran.err);
        }
    }
}

#[test]
fn shapes_that_cannot_be() {
    let text = refused("Shape \"trianglemesh\" \"point3 P\" [0 0 1 0 0 1 0 0 1] \"integer indices\" [0 1 2]");
    assert!(text.contains("expected a primitive with an area"), "{text}");
    let place = Place::new();
    place.write("a.pbrt", format!("{HEAD}Shape \"plymesh\" \"string filename\" \"big.ply\"\n"));
    place.write(
        "big.ply",
        "ply\nformat binary_little_endian 1.0\nelement vertex 1000000000\nproperty float x\nproperty float y\n\
         property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n",
    );
    let ran = place.run("render a.pbrt --spp 1 --quiet");
    assert!(ran.refusal().contains("big.ply: announces 1200000000"), "{}", ran.err);
}

#[test]
fn films_that_cannot_be() {
    let place = Place::new();
    place.write("zero.pbrt", "Film \"rgb\" \"integer xresolution\" 0\nWorldBegin\n");
    assert!(place.run("render zero.pbrt").refusal().contains("xresolution: must be between 1 and"));
    let huge = place.run("render --resolution 1000000x1000000");
    assert!(huge.refusal().contains("GiB of memory") && huge.err.contains("hint:"), "{}", huge.err);
    let bands = place.run("render --bands 300:400:10 --range 360:830 --resolution 4x4");
    assert!(bands.refusal().contains("expected edges within 360 to 830 nm"), "{}", bands.err);
}

#[test]
fn folders_and_files_that_cannot_be_written() {
    let place = Place::new();
    let ran = place.run("render --resolution 4x4 --spp 1 -o nowhere/a.exr");
    assert_eq!(ran.code, 1, "{}", ran.err);
    assert!(
        ran.err.starts_with("nowhere/a.exr: cannot write: No such file") && ran.err.contains("hint:"),
        "{}",
        ran.err
    );
    std::fs::create_dir(place.path("folder.exr")).expect("writable");
    let ran = place.run("render --resolution 4x4 --spp 1 -o folder.exr");
    assert_eq!(ran.code, 1, "{}", ran.err);
    assert!(ran.err.contains("folder.exr: cannot write"), "{}", ran.err);
}

#[test]
fn overrides_that_fit_nothing() {
    let place = Place::new();
    for (set, message) in [
        ("fgo.scale=2", "nothing in the scene is named \"fgo\""),
        ("fog.scael=2", "MakeNamedMedium \"fog\" has no parameter \"scael\""),
        ("fog.scale=-2", "scale: must be finite and >= 0, got -2"),
        ("fog.scale=abc", "scale: expected a parameter of type `float`"),
        ("film.xresolution=0", "xresolution: must be between 1 and"),
    ] {
        let ran = place.run(&format!("render --quiet --resolution 4x4 --spp 1 --set {set}"));
        assert!(ran.refusal().contains(message), "{set}: {}", ran.err);
    }
    assert!(place.run("render --set fgo.scale=2").err.contains("hint: did you mean `fog`?"));
}

#[test]
fn warnings_have_their_place_and_strict_makes_them_errors() {
    let place = Place::new();
    place.write("a.pbrt", format!("{HEAD}LightSource \"infinite\"\nShape \"sphere\" \"float radus\" 2\n"));
    let ran = place.ok("render a.pbrt --spp 1");
    assert!(
        ran.err.contains("a.pbrt:4:16: warning: Shape \"sphere\": unused parameter \"float radus\""),
        "{}",
        ran.err
    );
    assert_eq!(ran.err.matches("unused parameter").count(), 1, "each warning once");
    let ran = place.run("render a.pbrt --spp 1 --strict --force");
    assert_eq!(ran.code, 2, "{}", ran.err);
    assert!(ran.err.contains("--strict"), "{}", ran.err);
}

#[test]
fn images_that_cannot_be_read_or_compared() {
    let place = Place::new();
    place.write("noise.exr", b"\x76\x2f\x31\x01 nothing of an EXR".repeat(9));
    place.write("text.exr", "hello");
    place.write("cut.film", "TYNDFILM");
    for name in ["noise.exr", "text.exr", "cut.film", "nowhere.exr"] {
        for command in [
            format!("diff {name} {name}"),
            format!("develop {name} -o out.png"),
            format!("merge {name} -o out.exr"),
        ] {
            let ran = place.run(&command);
            assert!(ran.refusal().contains(name), "{command}: {}", ran.err);
        }
    }
    assert!(!place.has("out.png") && !place.has("out.exr"));
    place.ok("render --resolution 4x4 --spp 2 --quiet -o a.exr");
    place.ok("render --resolution 8x4 --spp 2 --quiet -o b.exr");
    assert!(place.run("diff a.exr b.exr").refusal().contains("4 x 4 from 0,0 and 8 x 4 from 0,0"));
}
