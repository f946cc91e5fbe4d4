//! Pixels that take the lowest orders of light from paths of their own: which they are, and what it brings.

mod common;

use common::develop;
use std::path::Path;
use tyndall::{Options, Plan, Source, plan};
use tyndall_film::{Developed, ErrorMode};

const SIDE: u32 = 64;
/// Of the lamp [m]: some three pixels.
const RADIUS: f32 = 0.15;

/// A grey floor under a sky, seen with `more` before it.
fn picture(integrator: &str, more: &str) -> Plan {
    let text = format!(
        "LookAt 0 0 4  0 0 0  0 1 0
         Camera \"perspective\" \"float fov\" 40
         Film \"rgb\" \"integer xresolution\" {SIDE} \"integer yresolution\" {SIDE}
         PixelFilter \"box\"
         Integrator \"volpath\" \"integer maxdepth\" 3 {integrator}
         WorldBegin
         LightSource \"infinite\" \"float scale\" 0.5
         Material \"diffuse\" \"spectrum reflectance\" [360 0.5 830 0.5]
         Shape \"bilinearmesh\" \"point3 P\" [-9 -1 -9  9 -1 -9  -9 -1 9  9 -1 9]
         {more}"
    );
    let options = Options { spp: Some(64), errors: ErrorMode::REPLICATED, ..Options::default() };
    plan(Source::Text("picture", &text, Path::new("")), &options).expect("a scene")
}

/// A lamp of this radius and radiance that fills a disk in the middle of the picture.
fn lamp(radius: f32, radiance: f32) -> String {
    format!("AreaLightSource \"diffuse\" \"float scale\" {radiance} Shape \"disk\" \"float radius\" {radius}")
}

/// A thin mist around everything, the camera in it, with a point of light in the middle of the pixel beside the picture's.
const MIST: &str = "
    MakeNamedMedium \"mist\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [.1 .1 .1] \"rgb sigma_a\" [0 0 0]
    MediumInterface \"mist\" \"\"
    Material \"interface\"
    Shape \"sphere\" \"float radius\" 3
    LightSource \"point\" \"point3 from\" [0.02 -0.02 0] \"float scale\" 50";

/// A plate of rough metal in the middle of the picture, which mirrors a small lamp behind the camera.
const MIRROR: &str = "
    AttributeBegin
      AreaLightSource \"diffuse\" \"float scale\" 4000
      Translate 0 0 6
      Shape \"sphere\" \"float radius\" 0.05
    AttributeEnd
    Material \"conductor\" \"bool remaproughness\" false \"float roughness\" 0.03
    Shape \"disk\" \"float radius\" 0.6";

/// Distance of a pixel's centre from that of the picture \[pixels\].
fn from_centre((x, y): (u32, u32)) -> f32 {
    let d = |k: u32| k as f32 + 0.5 - SIDE as f32 / 2.0;
    d(x).hypot(d(y))
}

#[test]
fn the_rim_of_a_bright_lamp_is_refined_and_what_lies_apart_is_not() {
    let pass = picture("", &lamp(RADIUS, 300.0)).pass;
    // tan of half the angle of view times the distance is half the picture
    let radius = RADIUS / (4.0 * 20f32.to_radians().tan()) * SIDE as f32 / 2.0;
    let apart = |at| (from_centre(at) - radius).abs();
    for (at, extra) in pass.refinement.iter() {
        assert!(from_centre(at) < radius + 0.8 && extra.from == 1 && extra.paths >= 2, "{at:?}: {extra:?}");
    }
    for x in 0..SIDE {
        for y in 0..SIDE {
            let split = apart((x, y)) < 0.2;
            assert!(!split || pass.refinement.of(x, y).paths >= 2, "({x}, {y}) holds the rim");
        }
    }
    assert_eq!(picture("\"bool refine\" false", &lamp(RADIUS, 300.0)).pass.refinement.iter().count(), 0);
    assert_eq!(picture("", "").pass.refinement.iter().count(), 0, "no lamp");
}

#[test]
fn a_point_of_light_in_a_mist_is_refined_where_it_shows() {
    let pass = picture("", MIST).pass;
    let middle = pass.refinement.of(SIDE / 2, SIDE / 2);
    assert!(middle.from == 2 && middle.paths >= 8, "{middle:?}");
    assert!(pass.refinement.iter().all(|(at, _)| from_centre(at) < 3.0));
    let clear = MIST.replace("[.1 .1 .1]", "[0 0 0]");
    assert_eq!(picture("", &clear).pass.refinement.iter().count(), 0, "nothing there scatters");
}

#[test]
fn a_lamp_in_a_rough_mirror_is_refined() {
    let pass = picture("", MIRROR).pass;
    let middle = pass.refinement.of(SIDE / 2, SIDE / 2);
    assert!(middle.from == 2 && middle.paths >= 4, "{middle:?}");
    // the mirror's rim is at 6.6 pixels
    let rim = 0.6 / (4.0 * 20f32.to_radians().tan()) * SIDE as f32 / 2.0;
    assert!(pass.refinement.iter().all(|(at, _)| from_centre(at) < rim + 1.0));
    let matte =
        MIRROR.replace("\"conductor\" \"bool remaproughness\" false \"float roughness\" 0.03", "\"diffuse\"");
    assert_eq!(picture("", &matte).pass.refinement.iter().count(), 0, "a matte disk");
}

#[test]
fn refined_pixels_have_the_same_means_and_less_variance() {
    for more in [lamp(RADIUS, 300.0), MIST.into(), MIRROR.into()] {
        for reuse in ["", " \"bool pathreuse\" false"] {
            let mut plans =
                [reuse.to_owned(), format!("\"bool refine\" false{reuse}")].map(|i| picture(&i, &more));
            plans[1].pass.seed = 1;
            let [fine, coarse] = [0, 1].map(|i| develop(&plans[i]));
            for channel in 0..3 {
                let [a, b] = [&fine, &coarse].map(|film| film.mean_over(channel, film.bounds));
                let error = (a.1.variance + b.1.variance).sqrt();
                // eighteen scores
                assert!((a.0 - b.0).abs() < 4.5 * error, "{reuse}: {} and {} +- {error}", a.0, b.0);
                assert!(error < 0.02 * b.0, "too coarse to tell: {} +- {error}", b.0);
                let variance = |film: &Developed| -> f32 {
                    let at = |((x, y), _)| film.bounds.index(x, y);
                    plans[0].pass.refinement.iter().map(|p| film.error[channel][at(p)].powi(2)).sum()
                };
                let ratio = variance(&fine) / variance(&coarse);
                assert!(ratio < 0.2, "{reuse}: variance of the refined pixels falls to {ratio} alone");
            }
        }
    }
}
