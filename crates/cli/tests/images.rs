//! `tyndall diff`, `tyndall develop`, `tyndall info`: what they say about images and scenes.

mod common;

use common::Place;
use serde_json::Value;

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|e| panic!("{e}: {text}"))
}

#[test]
fn two_seeds_agree_and_a_change_does_not() {
    let place = Place::new();
    let tiny = "render --resolution 16x16 --spp 16 --quiet --bands 400:700:100";
    place.ok(&format!("{tiny} -o a.exr"));
    place.ok(&format!("{tiny} --seed 1 -o b.exr"));
    place.ok(&format!("{tiny} --set fog.scale=0.5 -o thin.exr"));
    let agree = json(&place.ok("diff a.exr b.exr --json --exit-code").out);
    assert_eq!(agree["verdict"], "agree");
    let names: Vec<&str> =
        agree["channels"].as_array().expect("a list").iter().filter_map(|c| c["name"].as_str()).collect();
    assert_eq!(names, ["R", "G", "B", "S0.450,000000nm", "S0.550,000000nm", "S0.650,000000nm"]);
    let differ = place.run("diff a.exr thin.exr --exit-code");
    assert_eq!(differ.code, 1, "{}", differ.out);
    assert!(differ.out.contains("differ at level 0.01"), "{}", differ.out);
    std::fs::remove_file(place.path("a.error.exr")).expect("there");
    let one = place.ok("diff a.exr b.exr");
    assert!(one.out.contains("A counts as exact"), "{}", one.out);
}

#[test]
fn a_film_develops_to_the_file_of_its_render() {
    let place = Place::new();
    place.ok("render --resolution 16x16 --spp 4 --quiet --bands 400:700:100 -o a.film -o a.exr -o a.png");
    place.ok("develop a.film -o b.exr -o b.png");
    assert!(place.read("a.exr") == place.read("b.exr"));
    assert!(place.read("a.png") == place.read("b.png"));
    assert!(place.ok("diff a.film b.exr").out.contains("identical"));
    place.ok("develop a.exr -o band.png --band 450");
    place.ok("develop a.exr -o false.png --false-colour 1:100000");
    place.ok("develop a.exr -o wide.exr --colour-space rec2020 --exposure 1");
    place.ok("develop a.exr -o warm.png --white 3200K");
    place.ok("develop a.exr -o point.csv --probe 3,4");
    let table = String::from_utf8(place.read("point.csv")).expect("text");
    assert_eq!(table.lines().filter(|l| l.starts_with("3,4,")).count(), 1, "{table}");
    assert!(
        place
            .run("develop a.exr -o x.png --band 950")
            .refusal()
            .contains("--band 950: the image has bands around 450")
    );
    assert!(place.run("develop a.exr -o band.png").refusal().contains("exists"));
    assert!(place.run("develop a.exr -o y.csv --probe 99,0").refusal().contains("99,0 lies outside"));
}

/// In normalised scenes a constant light of scale 1 is 1 in every band and has Y = 1; in absolute ones its own value.
#[test]
fn bands_of_a_constant_light() {
    let place = Place::new();
    let film =
        "Film \"rgb\" \"integer xresolution\" 2 \"integer yresolution\" 2 PixelFilter \"box\"\nWorldBegin\n";
    place.write("n.pbrt", format!("{film}LightSource \"infinite\" \"spectrum L\" [300 7 900 7]\n"));
    place.write(
        "a.pbrt",
        format!("{film}LightSource \"infinite\" \"bool absolute\" true \"spectrum L\" [300 7 900 7]\n"),
    );
    for (scene, band, units) in [("n", 1.0, "pbrt-normalised"), ("a", 7.0, "W m^-2 sr^-1 nm^-1")] {
        place.ok(&format!("render {scene}.pbrt --spp 1024 --bands 400:700:150 --quiet -o {scene}.csv --wavelength-pdf uniform"));
        assert_eq!(place.json(&format!("{scene}.run.json"))["units"], units);
        let text = String::from_utf8(place.read(&format!("{scene}.csv"))).expect("text");
        assert!(text.contains("S0.475,000000nm"), "{text}");
        for row in text.lines().filter(|l| l.starts_with(|c: char| c.is_ascii_digit())) {
            let cells: Vec<f64> = row.split(',').map(|c| c.parse().expect("a number")).collect();
            // x, y, then R, G, B and two bands, each with its error
            for at in [8, 10] {
                let (value, se) = (cells[at], cells[at + 1]);
                assert!((value - band).abs() < 5.0 * se + 1e-4, "{scene}: {value} +- {se}");
            }
        }
    }
}

#[test]
fn info_accounts_for_every_parameter() {
    let place = Place::new();
    let info = json(&place.ok("info --json").out);
    let states: Vec<&str> =
        info["parameters"].as_array().expect("a list").iter().filter_map(|p| p["state"].as_str()).collect();
    assert!(states.len() > 20 && states.iter().all(|s| *s != "unread"), "{states:?}");
    assert_eq!(info["media"][0]["name"], "fog");
    assert_eq!(
        (&info["boundaries"]["contradictions"], &info["units"]),
        (&0.into(), &"W m^-2 sr^-1 nm^-1".into())
    );
    let text = place.ok("info").out;
    for word in
        ["sigma_t 0.6 to 1.0233333 1/m", "optical depth", "100.00 % of the power", "consumed", "ignored"]
    {
        assert!(text.contains(word), "{word}\n{text}");
    }
}

/// A camera inside a medium that nobody told of, and a sphere with its sides swapped.
#[test]
fn info_finds_contradicting_boundaries() {
    let place = Place::new();
    let scene = |camera: &str, inside: &str, outside: &str| {
        format!(
            "{camera}Camera \"perspective\"\nFilm \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\nWorldBegin\n\
             MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\nLightSource \"point\"\nMaterial \"interface\"\n\
             MediumInterface \"{inside}\" \"{outside}\"\nShape \"sphere\" \"float radius\" 2\n"
        )
    };
    let count = |text: String| {
        place.write("a.pbrt", text);
        json(&place.ok("info a.pbrt --json").out)["boundaries"]["contradictions"].as_u64().expect("a number")
    };
    assert!(count(scene("", "fog", "")) > 0, "the camera stands in undeclared fog");
    let told = "MakeNamedMedium \"haze\" \"string type\" \"homogeneous\"\nMediumInterface \"\" \"haze\"\n";
    assert_eq!(count(scene(told, "haze", "")), 0, "the camera's medium is declared");
    assert!(count(scene(told, "", "haze")) > 0, "the sides are swapped");
}
