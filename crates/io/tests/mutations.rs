//! Scenes with words changed: a scene or an error that can be told, never a panic, and never for long.
//!
//! The long version, behind `--ignored`, reads as many scenes as the environment's `TYNDALL_FUZZ` says.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use std::{
    panic::catch_unwind,
    path::Path,
    time::{Duration, Instant},
};
use tyndall_base::rng::Pcg32;
use tyndall_io::{LoadOptions, load_text};

/// Scenes in the short version.
const SHORT: u32 = 300;
/// In the long one unless told otherwise.
const LONG: u32 = 20_000;
/// Longest time for one of these tiny scenes.
const PATIENCE: Duration = Duration::from_secs(20);

/// A camera with its options, and a world; each is mixed with each.
const OPTIONS: &[&str] = &[
    r#"LookAt 0 0 5  0 0 0  0 1 0 Camera "perspective" "float fov" 40 "float lensradius" 0.1 "float focaldistance" 3
       Film "rgb" "integer xresolution" 8 "integer yresolution" 8 "float iso" 200 "string sensor" "canon_eos_5d_mkiv"
       Sampler "zsobol" "integer pixelsamples" 4 PixelFilter "gaussian" "float xradius" 2 "float sigma" 0.5"#,
    r#"Camera "spherical" "string mapping" "equirectangular" "float shutteropen" 0 "float shutterclose" 1
       Film "spectral" "integer nbuckets" 8 "float lambdamin" 400 "float lambdamax" 700 PixelFilter "mitchell" "float B" 0.3
       Integrator "volpath" "integer maxdepth" 9 "string lightsampler" "power" "string mediumlights" "always""#,
    r#"Camera "orthographic" "float screenwindow" [-1 1 -1 1] Film "gbuffer" "string coordinatesystem" "world"
       Sampler "stratified" "integer xsamples" 2 Integrator "analog" ColorSpace "rec2020" Option "integer seed" 7"#,
];
const WORLDS: &[&str] = &[
    r#"MakeNamedMedium "fog" "string type" "homogeneous" "spectrum sigma_a" [400 0.1 700 0.2] "rgb sigma_s" [1 2 3] "float g" 0.3
       "blackbody Le" 1800 "float Lescale" 2 "string phase" "draine" "float alpha" 1
       AttributeBegin MediumInterface "fog" "" Material "interface" Shape "sphere" "float radius" 1.5 "float zmin" -1 AttributeEnd
       LightSource "spot" "point3 from" [0 3 0] "point3 to" [0 0 0] "float coneangle" 30 "rgb I" [1 2 3] "float power" 3"#,
    r#"MakeNamedMedium "fire" "string type" "uniformgrid" "integer nx" 2 "integer ny" 2 "integer nz" 2 "float density" [0 1 2 3 4 5 6 7]
       "float temperature" [300 900 1500 2000 1200 800 100 50] "point3 p0" [-1 -1 -1] "point3 p1" [1 1 1] "string edge" "clamp"
       MakeNamedMedium "paint" "string type" "rgbgrid" "integer nx" 1 "integer ny" 1 "integer nz" 2 "rgb sigma_a" [1 2 3 4 5 6]
       "rgb sigma_s" [1 1 1 2 2 2] "rgb Le" [1 0 0 0 1 0] MakeNamedMedium "both" "string type" "mixture" "string media" ["fire" "paint"]
       AttributeBegin MediumInterface "both" "" Material "interface" Shape "disk" "float radius" 1 AttributeEnd"#,
    r#"MakeNamedMedium "bands" "string type" "spectralgrid" "integer nx" 1 "integer ny" 1 "integer nz" 2 "float bands" [360 550 830]
       "float sigma_a" [1 2 3 4] "float sigma_s" [1 1 1 1] MakeNamedMedium "sky" "string type" "cloud" "float density" 2 "float wispiness" 1
       AttributeBegin MediumInterface "bands" "sky" Shape "cylinder" "float radius" 0.5 "float phimax" 200 AttributeEnd
       LightSource "infinite" "rgb L" [1 2 3] "float illuminance" 10 LightSource "distant" "float scale" 2"#,
    r#"Texture "a" "spectrum" "checkerboard" "rgb tex1" [0.1 0.2 0.3] "string mapping" "planar" "vector3 v1" [2 0 0]
       Texture "b" "float" "fbm" "integer octaves" 4 "float roughness" 0.4 Texture "c" "spectrum" "marble" "float scale" 3
       Texture "d" "spectrum" "mix" "texture tex1" "a" "texture tex2" "c" "float amount" 0.3
       Material "subsurface" "texture reflectance" "d" "rgb mfp" [1 0.5 0.2] "float scale" 2 "float g" 0.5 Shape "sphere"
       Material "coateddiffuse" "texture reflectance" "a" "float thickness" 0.02 "integer nsamples" 2 "texture displacement" "b"
       Shape "loopsubdiv" "integer levels" 2 "integer indices" [0 1 2 0 2 3] "point3 P" [0 0 0 1 0 0 1 1 0 0 1 0]"#,
    r#"MakeNamedMaterial "m" "string type" "conductor" "spectrum eta" "metal-Cu-eta" "spectrum k" "metal-Cu-k" "float roughness" 0.1
       MakeNamedMaterial "n" "string type" "hair" "float eumelanin" 1.3 Material "mix" "string materials" ["m" "n"] "float amount" 0.5
       AreaLightSource "diffuse" "rgb L" [1 2 3] "bool twosided" true "float lines" [546 1]
       Shape "trianglemesh" "integer indices" [0 1 2] "point3 P" [0 0 0 1 0 0 0 1 0] "point2 uv" [0 0 1 0 0 1] "normal N" [0 0 1 0 0 1 0 0 1]"#,
    r#"ObjectBegin "thing" Shape "bilinearmesh" "point3 P" [0 0 0 1 0 0 0 1 0 1 1 0.5] "float alpha" 0.5 ObjectEnd
       TransformBegin Rotate 30 0 1 0 Translate 1 2 3 Scale 1 2 1 ObjectInstance "thing" TransformEnd
       ActiveTransform EndTime Translate 1 0 0 ActiveTransform All Attribute "shape" "float radius" 2
       Material "dielectric" "spectrum eta" "glass-BK7" Shape "curve" "point3 P" [0 0 0  1 1 0  2 0 0  3 1 0] "string type" "ribbon"
       "normal N" [0 0 1  0 1 0] "float width0" 0.1 "integer splitdepth" 1"#,
];
const NUMBERS: &[&str] = &[
    "0",
    "-1",
    "1",
    "2",
    "7",
    "0.5",
    "100",
    "1e30",
    "-1e38",
    "1e-38",
    "3.4e38",
    "1e39",
    "2147483647",
    "-2147483648",
    "1000000",
];
const WORDS: &[&str] = &[
    "[",
    "]",
    "[ ]",
    "nan",
    "\"\"",
    "true",
    "Identity",
    "AttributeEnd",
    "Transform [1 0 0 0 0 0 0 0 0 0 1 0 0 0 0 1]",
];

/// Quoted words, brackets and what lies between them.
fn words(text: &str) -> Vec<&str> {
    let pieces = text.split('"').enumerate().flat_map(|(i, piece)| {
        let inner: Box<dyn Iterator<Item = &str>> = if i % 2 == 1 {
            Box::new(std::iter::once(piece))
        } else {
            Box::new(piece.split_inclusive(['[', ']']).flat_map(str::split_whitespace))
        };
        inner.map(move |word| (i % 2 == 1, word))
    });
    // with its quotes, which lie around it in the text
    let whole = |word: &str| {
        let at = word.as_ptr() as usize - text.as_ptr() as usize;
        at - 1..at + word.len() + 1
    };
    pieces.map(|(quoted, word)| if quoted { &text[whole(word)] } else { word }).collect()
}

fn scene(options: usize, world: usize) -> String {
    let text = format!("{} WorldBegin {}", OPTIONS[options], WORLDS[world]);
    text.replace('[', " [ ").replace(']', " ] ")
}

fn mutated(rng: &mut Pcg32) -> String {
    let pick = |rng: &mut Pcg32, n: usize| rng.below(n as u32) as usize;
    let text = scene(pick(rng, OPTIONS.len()), pick(rng, WORLDS.len()));
    let mut words = words(&text);
    for _ in 0..1 + rng.below(3) {
        let at = pick(rng, words.len());
        let is_number = words[at].parse::<f64>().is_ok();
        match rng.below(12) {
            0 => words[at] = WORDS[pick(rng, WORDS.len())],
            1 => drop(words.remove(at)),
            2 => words.insert(at, words[pick(rng, words.len())]),
            3 => {
                let to = pick(rng, words.len());
                words.swap(at, to);
            }
            4 if words[at].starts_with('"') => {
                let quoted: Vec<&str> = words.iter().copied().filter(|w| w.starts_with('"')).collect();
                words[at] = quoted[pick(rng, quoted.len())];
            }
            _ if is_number => words[at] = NUMBERS[pick(rng, NUMBERS.len())],
            _ => {}
        }
    }
    words.join(" ")
}

#[test]
fn the_seeds_are_sound() {
    for options in 0..OPTIONS.len() {
        for world in 0..WORLDS.len() {
            let text = scene(options, world);
            assert_eq!(words(&text).join(" "), text.split_whitespace().collect::<Vec<_>>().join(" "));
            let read = load_text("seed", &text, Path::new("/nowhere"), &LoadOptions::default());
            assert!(read.is_ok(), "{options}, {world}: {}\n{text}", read.err().unwrap());
        }
    }
}

/// Found by changed scenes: a box that no number of f32 can measure.
#[test]
fn fires_without_measure_are_no_lights() {
    let cases = [("3.4e38 -1 -1", "both"), ("-1 1e38 1e38", "fire"), ("-1e-38 -1e-38 -1e-38", "fire")];
    for (corner, medium) in cases {
        let world = WORLDS[1].replacen("p0\" [-1 -1 -1]", &format!("p0\" [{corner}]"), 1);
        assert!(world.contains(corner), "a corner to replace");
        let world = world.replace("Interface \"both\"", &format!("Interface \"{medium}\""));
        let text = format!("{} WorldBegin {world}", OPTIONS[0]);
        let _ = load_text("fire", &text, Path::new("/nowhere"), &LoadOptions::default());
    }
}

fn survive(count: u32) {
    let mut rng = Pcg32::new(u64::from(count), 5);
    let mut loaded = 0;
    for n in 0..count {
        let text = mutated(&mut rng);
        let start = Instant::now();
        let read = || match load_text("mutated", &text, Path::new("/nowhere"), &LoadOptions::default()) {
            Ok(scene) => {
                scene.diagnostics.to_vec().iter().for_each(|d| drop(d.to_string()));
                true
            }
            Err(e) => {
                assert!(!e.to_string().is_empty());
                false
            }
        };
        loaded += u32::from(catch_unwind(read).unwrap_or_else(|_| panic!("scene {n} of {count}:\n{text}")));
        assert!(start.elapsed() < PATIENCE, "scene {n} of {count} took {:?}:\n{text}", start.elapsed());
    }
    // a test of mistakes alone would not get far
    assert!(loaded * 4 > count, "{loaded} of {count} scenes are sound");
}

#[test]
fn changed_scenes_do_no_harm() {
    survive(SHORT);
}

#[test]
#[ignore = "long: TYNDALL_FUZZ scenes"]
fn many_changed_scenes_do_no_harm() {
    survive(std::env::var("TYNDALL_FUZZ").map_or(LONG, |n| n.parse().unwrap()));
}
