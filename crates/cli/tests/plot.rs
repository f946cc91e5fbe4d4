//! `tyndall plot`: curves as SVG.

mod common;

use common::Place;

const SCENE: &str = r#"
Camera "perspective"
Film "rgb" "integer xresolution" 4 "integer yresolution" 3
WorldBegin
MakeNamedMedium "mist" "string type" "homogeneous" "spectrum sigma_s" [360 1 830 0.2] "spectrum sigma_a" [360 0.1 830 0.4]
  "float g" 0.8
MakeNamedMedium "ink" "string type" "homogeneous" "float sigma_s" 0 "float sigma_a" 2
LightSource "infinite"
"#;

fn svg(place: &Place, name: &str) -> String {
    let text = String::from_utf8(place.read(name)).expect("text");
    assert!(text.starts_with("<svg") && text.ends_with("</svg>") && !text.contains("NaN"), "{name}");
    text
}

#[test]
fn media_spectra_and_pixels() {
    let place = Place::new();
    place.write("fog.pbrt", SCENE);
    place.write("lamp.spd", "400 1\n500 2\n# a remark\n700 0.5\n");
    assert_eq!(place.ok("plot fog.pbrt:mist").out, "fog.mist.svg\n");
    let one = svg(&place, "fog.mist.svg");
    for word in ["sigma_a", "mist: albedo", "mean free path", "log10 of the phase function"] {
        assert!(one.contains(word), "{word}");
    }
    place.ok("plot fog.pbrt -o all.svg --range 400:700");
    assert!(svg(&place, "all.svg").contains("ink: coefficients"));
    place.ok("plot lamp.spd --range 400:700");
    assert!(svg(&place, "lamp.svg").contains("lamp.spd"));
    place.ok("plot glass-BK7 -o glass.svg");
    assert!(svg(&place, "glass.svg").contains("refractive index"));
    place.ok("render fog.pbrt --spp 4 --bands 400:700:50 -o fog.exr");
    place.ok("plot fog.exr@3,2");
    assert!(svg(&place, "fog.3-2.svg").contains("mean and standard error"));
}

#[test]
fn what_cannot_be_drawn_is_told() {
    let place = Place::new();
    place.write("fog.pbrt", SCENE);
    place.write("odd.spd", "400 1 500");
    place.ok("render fog.pbrt --spp 1 -o plain.exr");
    for (line, words) in [
        ("plot fog.pbrt:smoke", "no medium \"smoke\""),
        ("plot nothing-D65", "no such file"),
        ("plot plain.exr@0,0", "no spectral channels"),
        ("plot odd.spd", "expected pairs"),
        ("plot fog.pbrt -o x.png", ".svg"),
        ("plot missing.exr@0,0", "missing.exr"),
    ] {
        let ran = place.run(line);
        assert!(ran.refusal().contains(words), "{line}: {}", ran.err);
    }
    place.ok("plot stdillum-A");
    assert!(place.run("plot stdillum-A").refusal().contains("is there already"));
    place.ok("plot stdillum-A --force");
}
