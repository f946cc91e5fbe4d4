//! Every class of surface, texture, light and camera that pbrt-v4 has: read without a warning, refused with a reason.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use std::path::Path;
use tyndall_io::{LoadOptions, LoadedScene, load_text};

const DISK: &str = "Shape \"disk\"\n";

fn load(options: &str, world: &str) -> Result<LoadedScene, String> {
    let text = format!("{options}\nWorldBegin\n{world}\n");
    load_text("test", &text, Path::new(""), &LoadOptions::default()).map_err(|e| {
        let hint = e.to_string();
        format!("{e:?} {hint}")
    })
}

/// Reads `world` and refuses warnings.
fn clean(world: &str) -> LoadedScene {
    let scene = load("", world).unwrap_or_else(|e| panic!("{world}: {e}"));
    let told = scene.diagnostics.to_vec();
    assert!(told.is_empty(), "{world}: {told:?}");
    scene
}

fn refused(options: &str, world: &str, why: &str) {
    let message = load(options, world).err().unwrap_or_else(|| panic!("{world}: nothing was refused"));
    assert!(message.contains(why), "{world}: {message}");
}

#[test]
fn materials() {
    for material in [
        r#"Material "coateddiffuse" "rgb reflectance" [0.2 0.5 0.9] "float roughness" 0.1 "float thickness" 0.02"#,
        r#"Material "coateddiffuse" "spectrum eta" "glass-BK7" "float g" 0.3 "rgb albedo" [0.1 0.2 0.3] "integer maxdepth" 20 "integer nsamples" 2"#,
        r#"Material "coatedconductor" "float interface.roughness" 0.1 "spectrum conductor.eta" "metal-Ag-eta" "spectrum conductor.k" "metal-Ag-k" "float conductor.uroughness" 0.2"#,
        r#"Material "coatedconductor" "rgb reflectance" [0.9 0.8 0.7]"#,
        r#"Material "hair" "float eumelanin" 1.3 "float beta_m" 0.2 "float alpha" 3"#,
        r#"Material "hair" "rgb color" [0.6 0.3 0.1]"#,
        r#"Material "hair" "rgb sigma_a" [0.1 0.3 0.9]"#,
        r#"Material "subsurface" "rgb reflectance" [0.8 0.6 0.4] "rgb mfp" [1 0.5 0.2] "float g" 0.5"#,
        r#"Material "subsurface" "rgb sigma_a" [0.1 0.2 0.3] "float sigma_s" 2"#,
        r#"Material "subsurface" "string name" "Skin1" "float scale" 10"#,
        r#"Material "subsurface""#,
        r#"Texture "skin" "spectrum" "checkerboard" "rgb tex1" [0.8 0.5 0.4] "rgb tex2" [0.6 0.3 0.3]
           Material "subsurface" "texture reflectance" "skin" "rgb mfp" [1 0.5 0.2] "float scale" 2"#,
        r#"Texture "soot" "spectrum" "constant" "rgb value" [0.1 0.2 0.3]
           Material "subsurface" "texture sigma_a" "soot" "float sigma_s" 2"#,
        r#"Texture "hills" "float" "fbm" Material "diffuse" "texture displacement" "hills""#,
        r#"MakeNamedMaterial "a" "string type" "diffuse" MakeNamedMaterial "b" "string type" "mix" "string materials" ["a" "interface"]
           Material "mix" "string materials" ["a" "b"] "float amount" 0.25"#,
    ] {
        clean(&format!("{material}\n{DISK}"));
    }
    let filled = clean(&format!("Material \"subsurface\"\n{DISK}")).scene;
    assert!(filled.media.len() == 1 && filled.shapes[0].boundary.is_some());
    refused("", r#"Material "velvet""#, "not supported");
    refused("", r#"Material "mix" "string materials" ["x" "y"]"#, "no material is named");
    refused(
        "",
        r#"MakeNamedMaterial "m" "string type" "mix" "string materials" ["m" "m"]"#,
        "a mix of itself",
    );
    refused("", r#"Material "subsurface" "rgb sigma_a" [1 1 1]"#, "sigma_s");
    let paint = r#"Texture "paint" "spectrum" "constant" "rgb value" [0.1 0.2 0.3]"#;
    for (given, why) in [
        (r#""texture sigma_s" "paint""#, "sigma_a"),
        (r#""texture mfp" "paint""#, "reflectance"),
        (r#""texture reflectance" "paint" "string name" "Skin1""#, "both \"name\""),
        (r#""texture reflectance" "pain""#, "pain"),
    ] {
        refused("", &format!("{paint} Material \"subsurface\" {given}"), why);
    }
    refused("", r#"Material "coateddiffuse" "integer nsamples" 0"#, "between 1 and 10000");
}

#[test]
fn textures() {
    for (kind, class) in [
        ("float", r#""checkerboard" "float tex1" 0.2 "float uscale" 4"#),
        ("float", r#""checkerboard" "integer dimension" 3"#),
        ("float", r#""dots" "float inside" 1"#),
        ("float", r#""fbm" "integer octaves" 4 "float roughness" 0.4"#),
        ("float", r#""wrinkled""#),
        ("float", r#""windy""#),
        ("float", r#""bilerp" "float v00" 0.1"#),
        ("float", r#""directionmix" "vector3 dir" [0 0 1]"#),
        ("float", r#""mix" "float amount" 0.3"#),
        (
            "spectrum",
            r#""checkerboard" "rgb tex1" [0.1 0.2 0.3] "string mapping" "planar" "vector3 v1" [2 0 0]"#,
        ),
        ("spectrum", r#""dots" "string mapping" "spherical""#),
        ("spectrum", r#""marble" "float variation" 0.4 "float scale" 3"#),
        ("spectrum", r#""bilerp" "rgb v11" [0.1 0.9 0.3]"#),
        ("spectrum", r#""directionmix" "rgb tex1" [0.1 0.9 0.3]"#),
        ("spectrum", r#""mix" "rgb tex1" [0.1 0.9 0.3]"#),
    ] {
        let uses = if kind == "spectrum" { "\"texture reflectance\" \"t\"" } else { "" };
        clean(&format!("Texture \"t\" \"{kind}\" {class}\nMaterial \"diffuse\" {uses}\n{DISK}"));
    }
    refused("", r#"Texture "t" "float" "ptex" "string filename" "x.ptx""#, "ptex");
    refused("", r#"Texture "t" "float" "marble""#, "not known");
    refused("", r#"Texture "t" "float" "checkerboard" "integer dimension" 4"#, "must be 2 or 3");
}

#[test]
fn shapes() {
    let curve = r#"Shape "curve" "point3 P" [0 0 0  1 1 0  2 0 0  3 1 0]"#;
    for shape in [
        r#"Shape "cylinder" "float radius" 0.5 "float phimax" 200"#.into(),
        format!("{curve} \"string type\" \"cylinder\" \"float width0\" 0.1 \"float width1\" 0.2"),
        format!("{curve} \"string type\" \"ribbon\" \"normal N\" [0 0 1  0 1 0] \"integer splitdepth\" 1"),
        format!("{curve} \"string basis\" \"bspline\" \"integer degree\" 2"),
        r#"Shape "loopsubdiv" "integer levels" 2 "integer indices" [0 1 2 0 2 3] "point3 P" [0 0 0 1 0 0 1 1 0 0 1 0]"#.into(),
        "Texture \"holes\" \"float\" \"dots\"\nShape \"disk\" \"texture alpha\" \"holes\"".into(),
    ] {
        clean(&shape);
    }
    let scene = clean("ActiveTransform EndTime Translate 1 0 0 ActiveTransform All Shape \"sphere\"").scene;
    assert!(scene.accel.instances()[0].motion.is_some());
    assert!(clean("Shape \"disk\" \"float alpha\" 0.5").scene.has_alpha);
    refused("", &format!("{curve} \"string type\" \"ribbon\""), "N");
    refused("", &format!("AreaLightSource \"diffuse\" {curve}"), "cannot be area lights");
    refused("", r#"Shape "curve" "point3 P" [0 0 0 1 1 1]"#, "points of a Bezier curve");
    refused("", r#"Shape "cylinder" "float zmin" 1 "float zmax" 1"#, "zmax");
}

#[test]
fn cameras_films_and_lights() {
    for options in [
        r#"Camera "spherical" "string mapping" "equirectangular""#,
        r#"Film "gbuffer" "string coordinatesystem" "world""#,
        r#"Film "rgb" "string sensor" "canon_eos_5d_mkiv" "float iso" 200"#,
        r#"Film "spectral" "integer nbuckets" 8"#,
        r#"Integrator "volpath" "string lightsampler" "power""#,
    ] {
        let scene = load(options, DISK).unwrap_or_else(|e| panic!("{options}: {e}"));
        let told = scene.diagnostics.to_vec();
        assert!(told.is_empty(), "{options}: {told:?}");
    }
    refused(r#"Camera "fisheye""#, DISK, "known are perspective");
    refused(r#"Film "rgb" "string sensor" "canon_eos_5d_mkvi""#, DISK, "canon_eos_5d_mkii");
    refused(r#"Integrator "volpath" "string lightsampler" "bhv""#, DISK, "exhaustive");
    refused("", r#"LightSource "projection""#, "filename");
    refused("", r#"LightSource "goniometric" "string filename" "no-such.exr""#, "no-such.exr");
    refused("", "AreaLightSource \"diffuse\" \"string filename\" \"no.png\"\nShape \"disk\"", "no.png");
}

#[test]
fn reflectances_above_one_are_clamped_aloud() {
    let scene = load("", &format!("Material \"diffuse\" \"spectrum reflectance\" [400 0.5 700 1.5]\n{DISK}"))
        .unwrap();
    assert!(format!("{:?}", scene.diagnostics).contains("clamped"));
    // a blackbody is 1 at its peak, give or take a rounding
    load("", &format!("Material \"diffuse\" \"blackbody reflectance\" 6500\n{DISK}")).unwrap();
}

#[test]
fn hints_do_not_name_what_was_written() {
    let scene = load("", &format!("Material \"diffuse\" \"string k\" \"x\"\n{DISK}")).unwrap();
    let told = format!("{:?}", scene.diagnostics);
    assert!(told.contains("in another type") && !told.contains("did you mean \\\"k\\\""), "{told}");
    refused("", &format!("MediumInterface \"fog\" \"\"\n{DISK}"), "MediumInterface: no medium is named");
}

#[test]
fn portals_are_rectangles_in_the_world() {
    let window = r#""point3 portal" [1 3 0 1 3 1 -1 3 1 -1 3 0]"#;
    clean(&format!("Translate 5 5 5\nLightSource \"infinite\" {window} \"rgb L\" [1 2 3]\n{DISK}"));
    clean(&format!("LightSource \"infinite\" {window} \"float illuminance\" 10\n{DISK}"));
    refused("", r#"LightSource "infinite" "point3 portal" [1 3 0 1 3 1 -1 3 1]"#, "4 corners");
    refused("", r#"LightSource "infinite" "point3 portal" [0 0 0 1 0 0 1.5 1 0 0.5 1 0]"#, "right angles");
}

#[test]
fn realistic_cameras_read_their_lenses() {
    let folder = tempfile::tempdir().unwrap();
    let lens = folder.path().join("singlet.dat");
    std::fs::write(&lens, "# r d n diameter\n60 4 1.6 20\n-200 3 1 20\n0 3 0 8\n250 4 1.6 20\n-85 45 1 20\n")
        .unwrap();
    let camera =
        |more: &str| format!("Camera \"realistic\" \"string lensfile\" \"{}\" {more}", lens.display());
    for more in [
        "\"float aperturediameter\" 4",
        "\"float aperturediameter\" 4 \"float focusdistance\" 0.6 \"string aperture\" \"star\"",
        "\"string aperture\" \"gaussian\"\nFilm \"rgb\" \"float diagonal\" 20",
    ] {
        let scene = load(&camera(more), DISK).unwrap_or_else(|e| panic!("{more}: {e}"));
        let told = scene.diagnostics.to_vec();
        assert!(told.is_empty(), "{more}: {told:?}");
    }
    let wide = load(&camera("\"float aperturediameter\" 40"), DISK).unwrap();
    assert!(format!("{:?}", wide.diagnostics).contains("more than the lens has"));
    refused(r#"Camera "realistic""#, DISK, "lensfile");
    refused(&camera("\"float focusdistance\" 0.01"), DISK, "focusdistance");
    refused(&camera("\"string aperture\" \"no-such-shape.png\""), DISK, "pentagon");
    std::fs::write(&lens, "60 4 1.6").unwrap();
    refused(&camera(""), DISK, "four numbers");
}
