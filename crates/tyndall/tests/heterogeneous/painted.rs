//! Bodies whose coefficients are textures of their boundary.

use super::common::{Run, develop, judge::Family, scene};
use super::media::{self, BANDS};
use tyndall_film::PixelBounds;

const LEFT: [&str; 4] = [
    "[300 0.2 600 0.1 900 1.5]",
    "[300 6 550 3 900 4]",
    "[300 0.3 550 0.8 900 0.6]",
    "[300 0.2 600 0.4 900 0.3]",
];
const RIGHT: [&str; 4] =
    ["[300 2 500 0.5 900 0.1]", "[300 2 900 5]", "[300 0.9 500 0.5 900 0.2]", "[300 0.5 900 0.2]"];
const NAMES: [&str; 4] = ["sigma_a", "sigma_s", "reflectance", "mfp"];

/// What is given of [`NAMES`].
const COEFFICIENTS: [usize; 2] = [0, 1];
const COLOUR: [usize; 2] = [2, 3];

/// A thick plate in the sky, seen from above at `x`, one half-width `half` of it.
fn plate(textures: &str, material: &str, x: f64, half: f64) -> String {
    let camera = scene::camera(&BANDS, [x, 0.1, 5.0], [x, 0.1, 0.0], half);
    let material = format!("Material \"subsurface\" \"float g\" 0.4 \"float eta\" 1.3{material}\n");
    let shape = scene::cuboid([-40.0, -40.0, -1.0], [40.0, 40.0, 0.0]);
    format!("{camera}WorldBegin\n{}{textures}{material}{shape}", media::sky())
}

/// One of the two for negative and the other for positive x.
fn painted(which: [usize; 2], left: [&str; 4], right: [&str; 4], more: &str) -> (String, String) {
    let texture = |i: usize| {
        format!(
            "Texture \"{}\" \"spectrum\" \"checkerboard\" \"string mapping\" \"planar\" \"vector3 v1\" [0.01 0 0] \
             \"vector3 v2\" [0 0 0] \"spectrum tex1\" {} \"spectrum tex2\" {}\n",
            NAMES[i], right[i], left[i]
        )
    };
    let named = |i: usize| format!(" \"texture {}\" \"{}\"", NAMES[i], NAMES[i]);
    (which.map(texture).concat(), which.map(named).concat() + more)
}

fn even(which: [usize; 2], values: [&str; 4], more: &str) -> (String, String) {
    (String::new(), which.map(|i| format!(" \"spectrum {}\" {}", NAMES[i], values[i])).concat() + more)
}

fn bits(text: &str) -> Vec<u32> {
    let d = Run::new(BANDS, 32).develop(text);
    d.mean.concat().iter().map(|v| v.to_bits()).collect()
}

/// A path that enters on the one side never sees the other: the picture of each half is that of a body that is all of it,
/// to the bit.
#[test]
fn each_half_has_its_own_coefficients() {
    for more in ["", " \"float scale\" 2"] {
        let (textures, both) = painted(COEFFICIENTS, LEFT, RIGHT, more);
        for (x, values) in [(-0.5, LEFT), (0.5, RIGHT)] {
            let (_, alone) = even(COEFFICIENTS, values, more);
            let (got, expected) = (plate(&textures, &both, x, 0.3), plate("", &alone, x, 0.3));
            assert_eq!(bits(&got), bits(&expected), "at {x}{more}");
        }
    }
}

/// Colours are inverted at each wavelength here and by a table there: the same within the noise.
#[test]
fn each_half_has_its_own_colour() {
    let mut family = Family::default();
    for (i, more) in ["", " \"float scale\" 0.5"].into_iter().enumerate() {
        let (textures, both) = painted(COLOUR, LEFT, RIGHT, more);
        for (x, values) in [(-0.5, LEFT), (0.5, RIGHT)] {
            let (_, alone) = even(COLOUR, values, more);
            let got = Run::new(BANDS, 1024).bands(&plate(&textures, &both, x, 0.3));
            let expected = Run::new(BANDS, 1024).seed(2 + i as u64).bands(&plate("", &alone, x, 0.3));
            family.equal(&format!("at {x}{more}"), &got, &expected);
        }
    }
    family.assert(0.05);
}

/// Across the seam, with light sampling through a rough boundary too.
#[test]
fn analog_judges_painted_bodies() {
    let mut family = Family::default();
    for (name, which) in [("coefficients", COEFFICIENTS), ("colour", COLOUR)] {
        let (textures, both) = painted(which, LEFT, RIGHT, " \"float roughness\" 0.3");
        let text = plate(&textures, &both, 0.1, 0.5);
        let judge = Run::new(BANDS, 4096).analog().seed(7).bands(&text);
        family.equal(name, &Run::new(BANDS, 1024).bands(&text), &judge);
        family.equal(&format!("{name}, opow"), &Run::new(BANDS, 2048).opow().bands(&text), &judge);
    }
    family.assert(0.05);
}

/// Left and right of the seam apart: a shared point inside would have the coefficients of one for both.
#[test]
fn textures_do_not_bleed_where_paths_are_shared() {
    let (textures, both) = painted(COEFFICIENTS, LEFT, RIGHT, " \"float roughness\" 0.3");
    let text = plate(&textures, &both, 0.0, 0.5);
    let mut plans = [1, 2].map(|seed| Run::new(BANDS, 4096).seed(seed).plan(&text));
    assert!(plans[0].pass.shares_paths());
    plans[1].pass.settings.reuse = false;
    let [shared, alone] = plans.map(|plan| develop(&plan));
    let all = shared.bounds;
    let middle = all.x0 + all.width() / 2;
    let halves = [PixelBounds { x1: middle, ..all }, PixelBounds { x0: middle, ..all }];
    for (half, name) in halves.into_iter().zip(["left", "right"]) {
        // the bands, behind R, G, B
        for channel in 3..shared.names.len() {
            let [a, b] = [&shared, &alone].map(|film| film.mean_over(channel, half));
            let error = (a.1.variance + b.1.variance).sqrt();
            assert!(error < 0.03 * b.0, "{name}, {channel}: too coarse to tell: {} +- {error}", b.0);
            assert!((a.0 - b.0).abs() < 5.0 * error, "{name}, {channel}: {} and {} +- {error}", a.0, b.0);
        }
    }
}
