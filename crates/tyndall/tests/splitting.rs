//! A medium that is cut into pieces is the same medium.

mod common;

use common::{Bands, Run, judge::Family, scene};

const BANDS: Bands = Bands::new(8);
const TAU: [f64; 8] = [0.5, 2.0, 1.0, 0.4, 3.0, 0.8, 1.5, 0.6];
const ALBEDO: [f64; 8] = [0.9, 0.99, 0.5, 1.0, 0.95, 0.3, 0.8, 0.7];
const G: [f64; 8] = [0.5, -0.3, 0.6, 0.0, 0.7, -0.2, -0.5, 0.3];

fn medium(name: &str) -> String {
    scene::medium(&BANDS, name, &TAU, &ALBEDO, &scene::asymmetry(&BANDS, &G))
}

/// The sun on the layers, or the sky above them over black ground.
fn lit(slabs: &str, sun: bool) -> String {
    let media = medium("m") + &medium("other");
    if !sun {
        return scene::seen_from_above(&BANDS, 0.6, &media, slabs, -2.5);
    }
    let camera = scene::camera(&BANDS, [3.0, 0.0, 4.0], [0.0; 3], 0.01);
    format!("{camera}WorldBegin\n{}{media}{slabs}", scene::sun(BANDS.dialect, 0.6))
}

#[test]
fn layers_of_one_medium_are_one_layer() {
    let whole = scene::layers(&[(0.0, "m"), (-2.0, "")]);
    let split = [
        ("two layers", scene::layers(&[(0.0, "m"), (-0.7, "other"), (-2.0, "")])),
        ("a face within", scene::layers(&[(0.0, "m"), (-0.5, "m"), (-1.9, "m"), (-2.0, "")])),
        ("a ball within", whole.clone() + &within("Translate 0 0 -1\nScale 0.6 0.6 0.6\n")),
        ("two boxes", two_boxes()),
    ];
    let mut family = Family::default();
    for sun in [false, true] {
        let run = |seed: u64| Run::new(BANDS, 2048).seed(seed);
        let one = run(1).bands(&lit(&whole, sun));
        for (i, (name, slabs)) in split.iter().enumerate() {
            let seed = 10 + 10 * i as u64;
            let text = lit(slabs, sun);
            family.equal(&format!("{name}, hero, sun {sun}"), &run(seed).bands(&text), &one);
            family.equal(&format!("{name}, opow, sun {sun}"), &run(seed + 1).opow().bands(&text), &one);
            if !sun {
                family.equal(&format!("{name}, analog"), &run(seed + 2).analog().bands(&text), &one);
            }
        }
    }
    family.assert(0.1);
}

/// A sphere of the same medium inside.
fn within(place: &str) -> String {
    format!(
        "AttributeBegin\n{place}MediumInterface \"other\" \"m\"\n{}\nShape \"sphere\"\nAttributeEnd\n",
        scene::INTERFACE
    )
}

/// The layer cut through the middle of the picture: both halves as boxes without the face they share, and that face.
fn two_boxes() -> String {
    let wide = 2000.0;
    let face = |inside: &str, outside: &str, p: [[f64; 3]; 4]| {
        let points: Vec<String> = p.iter().flatten().map(f64::to_string).collect();
        format!(
            "AttributeBegin\nMediumInterface \"{inside}\" \"{outside}\"\n{}\nShape \"bilinearmesh\" \"point3 P\" [{}]\n\
             AttributeEnd\n",
            scene::INTERFACE,
            points.join(" ")
        )
    };
    // normals: upwards, upwards, towards +x; the sides at the far ends are left out
    let level = |z: f64, x: [f64; 2]| [[x[0], -wide, z], [x[1], -wide, z], [x[0], wide, z], [x[1], wide, z]];
    let (left, right) = ([-wide, 0.0], [0.0, wide]);
    [
        face("m", "", level(0.0, left)),
        face("", "m", level(-2.0, left)),
        face("other", "", level(0.0, right)),
        face("", "other", level(-2.0, right)),
        face("m", "other", [[0.0, -wide, -2.0], [0.0, wide, -2.0], [0.0, -wide, 0.0], [0.0, wide, 0.0]]),
    ]
    .concat()
}
