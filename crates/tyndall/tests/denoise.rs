//! Noise that light made: the built-in box of fog at 16 samples a pixel, against 1280.
//!
//! `data/cornell-fog-64.exr` is this program's own: the box at 512 x 512, 20 samples a pixel, seed 0, by means over 8 x 8.

use std::path::Path;
use tyndall::files::image::read_image;
use tyndall::{Image, Look, Options, Provenance, RunOptions, Source, engine::Silent, picture, plan, render};

/// Brighter than this many means is the lamp, whose rim 64 x 64 pixels do not resolve.
const LAMP: f64 = 8.0;

fn reference() -> Vec<Vec<f32>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/cornell-fog-64.exr");
    let image = read_image(&path).expect("the reference");
    image.rgb().expect("R, G, B").map(<[f32]>::to_vec).to_vec()
}

/// Root of the mean square difference of each channel, without the lamp.
fn rms(picture: [&[f32]; 3], reference: &[Vec<f32>]) -> [f64; 3] {
    let mean = |p: &[f32]| p.iter().map(|v| f64::from(*v)).sum::<f64>() / p.len() as f64;
    let bright = LAMP * mean(&reference[1]);
    let dark: Vec<usize> = (0..reference[1].len()).filter(|&p| f64::from(reference[1][p]) < bright).collect();
    [0, 1, 2].map(|c| {
        let square = |&p: &usize| f64::from(picture[c][p] - reference[c][p]).powi(2);
        (dark.iter().map(square).sum::<f64>() / dark.len() as f64).sqrt()
    })
}

/// Errors before and after, of the built-in box at 64 x 64.
fn cleaned(set: &[&str]) -> [[f64; 3]; 2] {
    let set = set.iter().map(|s| (*s).into()).collect();
    let options =
        Options { resolution: Some([64, 64]), spp: Some(16), seed: Some(1), set, ..Options::default() };
    let plan = plan(Source::BuiltIn, &options).expect("plans");
    let outcome = render(&plan, &RunOptions::default(), &mut Silent).expect("renders");
    let image = Image::of_film(&outcome.state.film, &Provenance::of(&plan).expect("known")).expect("planes");
    let look = Look { exposure: Some(0.0), denoise: Some(2), ..Look::default() };
    let clean = picture(&image, &look, image.space()).expect("there are errors");
    let reference = reference();
    let before = rms(image.values.rgb().expect("R, G, B"), &reference);
    let after = rms(clean.pixels.rgb().expect("R, G, B"), &reference);
    println!("{before:?} to {after:?}");
    [before, after]
}

#[test]
fn a_box_of_fog_has_less_than_half_of_its_error() {
    let [before, after] = cleaned(&["integrator.pathreuse=false"]);
    for c in 0..3 {
        assert!(after[c] < 0.5 * before[c], "channel {c}: {before:?} to {after:?}");
    }
}

/// Shared paths leave less noise where much is scattered again, but it is alike in neighbours, where no mean over neighbours
/// finds it. Red light, little of which is scattered, has the noise of the wavelengths that a square shares.
#[test]
fn noise_that_neighbours_share_is_taken_out_as_far_as_it_can_be_told() {
    let ([before, after], [alone, _]) = (cleaned(&[]), cleaned(&["integrator.pathreuse=false"]));
    for c in 0..3 {
        assert!(after[c] < before[c], "channel {c}: {before:?} to {after:?}");
    }
    for c in 1..3 {
        assert!(before[c] < 0.75 * alone[c], "channel {c}: {before:?} shared, {alone:?} alone");
    }
}
