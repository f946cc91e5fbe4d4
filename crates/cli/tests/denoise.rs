//! Pictures without grain: labelled, told, and never in place of numbers.

mod common;

use common::Place;
use tyndall::files::image::read_png_texts;

const TINY: &str = "render --resolution 32x24 --spp 8 --bands 400:700:100";

fn label(place: &Place, name: &str) -> Option<String> {
    read_png_texts(&place.path(name)).expect("readable").remove("tyndall:denoised")
}

#[test]
fn pictures_are_denoised_and_say_so_and_numbers_are_not() {
    let place = Place::new();
    // the built-in scene's film asks for it
    let told = place.ok(&format!("{TINY} -o a.exr -o a.png -o a.film")).err;
    assert!(told.contains("a.png is denoised, for looking at; a.exr holds the samples' means"), "{told}");
    let plain = place.ok(&format!("{TINY} --denoise off -o b.exr -o b.png")).err;
    assert!(!plain.contains("denoised"), "{plain}");
    assert!(label(&place, "a.png").is_some_and(|text| text.contains("for looking at")));
    assert_eq!(label(&place, "b.png"), None);
    assert!(place.read("a.png") != place.read("b.png"));
    assert!(
        place.read("a.exr") == place.read("b.exr") && place.read("a.error.exr") == place.read("b.error.exr")
    );
    // the same picture from the film and from the EXR with its errors, whatever the number of threads
    place.ok("develop a.film -o c.png --denoise");
    place.ok("develop b.exr -o d.png --denoise");
    place.ok(&format!("{TINY} --set film.denoise=true --threads 3 -o e.png"));
    for name in ["c.png", "d.png"] {
        assert!(place.read(name) == place.read("a.png"), "{name}");
    }
    assert!(label(&place, "e.png").is_some());
    place.ok("develop a.film -o band.png --band 550 --denoise");
    place.ok("develop a.film -o false.png --false-colour 1:1000 --denoise");
    assert!(label(&place, "band.png").is_some() && label(&place, "false.png").is_some());
}

#[test]
fn without_errors_there_is_a_reason() {
    let place = Place::new();
    let told = place.ok("render --resolution 8x8 --spp 1 -o a.exr -o a.png").err;
    assert!(
        told.contains("a.png is not denoised: the standard errors of 64 of 64 pixels are unknown"),
        "{told}"
    );
    assert_eq!(label(&place, "a.png"), None);
    assert!(place.run("develop a.exr -o b.png --denoise").refusal().contains("64 of 64 pixels are unknown"));
    std::fs::remove_file(place.path("a.error.exr")).expect("there");
    let refused = place.run("develop a.exr -o b.png --denoise");
    assert!(refused.refusal().contains("need standard errors, and the image has none"), "{}", refused.err);
    assert!(refused.err.contains("NAME.error.exr") && !place.has("b.png"), "{}", refused.err);
    place.ok("render --resolution 9x8 --spp 4 --quiet --force -o c.exr");
    std::fs::rename(place.path("c.error.exr"), place.path("a.error.exr")).expect("there");
    let other = place.run("develop a.exr -o b.png --denoise");
    assert!(other.refusal().contains("expected 64 of each, got 64 and 72"), "{}", other.err);
}

#[test]
fn merged_pictures_too() {
    let place = Place::new();
    for k in 1..=2 {
        place.ok(&format!("{TINY} --quiet --shard {k}/2"));
    }
    let films = "cornell-fog.1-of-2.film cornell-fog.2-of-2.film";
    let told = place.ok(&format!("merge {films} -o a.png --denoise")).err;
    assert!(told.contains("a.png is denoised, for looking at; -o NAME.exr writes"), "{told}");
    place.ok(&format!("merge {films} -o b.png"));
    assert!(label(&place, "a.png").is_some() && label(&place, "b.png").is_none());
}
