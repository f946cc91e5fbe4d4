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
    // four squares of pixels that share paths: replicates tell their errors, bounds would hide the change
    let tiny = "render --resolution 16x16 --spp 16 --quiet --bands 400:700:100 --errors replicated";
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
    let tiny = "render --resolution 16x16 --spp 4 --quiet --bands 400:700:100";
    place.ok(&format!("{tiny} --denoise off -o a.film -o a.exr -o a.png"));
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

/// The rows of a table, and the index of a column.
fn table(place: &Place, name: &str) -> (Vec<Vec<f64>>, Vec<String>) {
    let text = String::from_utf8(place.read(name)).expect("text");
    let mut lines = text.lines().filter(|l| !l.starts_with('#'));
    let header = lines.next().expect("a header").split(',').map(str::to_owned).collect();
    (lines.map(|l| l.split(',').map(|c| c.parse().expect("a number")).collect()).collect(), header)
}

fn column(header: &[String], name: &str) -> usize {
    header.iter().position(|h| h == name).unwrap_or_else(|| panic!("{name} in {header:?}"))
}

#[test]
fn what_is_known_of_errors_is_told() {
    let place = Place::new();
    let ran = place.ok("render --resolution 16x16 --spp 4 --errors replicated -o a.exr -o a.csv");
    assert!(
        ran.err.contains("256 of 256 pixels have too few samples for errors of their own"),
        "{}",
        ran.err
    );
    let (rows, header) = table(&place, "a.csv");
    let all = |name: &str, value: f64| rows.iter().all(|r| r[column(&header, name)] == value);
    assert!(all("statistics.samples [1]", 4.0) && all("statistics.pooled [1]", 1.0));
    place.ok("render --resolution 16x16 --spp 64 -o b.exr -o b.csv");
    let (rows, header) = table(&place, "b.csv");
    let at = column(&header, "statistics.dominated [1]");
    let flagged = rows.iter().filter(|r| r[at] == 1.0).count();
    assert!(flagged > 0, "64 samples a pixel leave pixels that one sample dominates");
    let diff = place.ok("diff a.exr b.exr");
    assert!(diff.out.contains(&format!(", {flagged} of B")), "{}", diff.out);
    assert!(diff.out.contains("errors are pooled over tiles in 256 pixels of A, 0 of B"), "{}", diff.out);
}

#[test]
fn regions_are_means_with_their_errors() {
    let place = Place::new();
    place.ok("render --resolution 16x16 --spp 16 --quiet -o a.exr -o a.csv");
    place.ok("develop a.exr -o r.csv --region 2,5,3,9 --probe 7,8");
    let ((rows, header), (regions, names)) = (table(&place, "a.csv"), table(&place, "r.csv"));
    let inside = |r: &&Vec<f64>| (2.0..5.0).contains(&r[0]) && (3.0..9.0).contains(&r[1]);
    let (value, se) = (column(&header, "G [W m^-2 sr^-1]"), column(&header, "G se"));
    let sum: f64 = rows.iter().filter(inside).map(|r| r[value]).sum();
    // pixels of a square of 8 x 8 share paths: without replicates they count as if they erred as one
    let square =
        |i: usize| rows.iter().filter(inside).filter(move |r| r[1] as usize / 8 * 2 + r[0] as usize / 8 == i);
    let squares: f64 = (0..4).map(|i| square(i).map(|r| r[se]).sum::<f64>().powi(2)).sum();
    let cell = |row: usize, name: &str| regions[row][column(&names, name)];
    assert_eq!([cell(1, "x0"), cell(1, "x1"), cell(1, "y0"), cell(1, "y1")], [2.0, 5.0, 3.0, 9.0]);
    assert_eq!((cell(1, "pixels"), cell(1, "statistics.samples [1]")), (18.0, 288.0));
    assert!((cell(1, "G [W m^-2 sr^-1]") / (sum / 18.0) - 1.0).abs() < 1e-6);
    assert!((cell(1, "G se") / (squares.sqrt() / 18.0) - 1.0).abs() < 1e-6);
    let pixel = rows.iter().find(|r| (r[0], r[1]) == (7.0, 8.0)).expect("inside");
    assert_eq!((cell(0, "pixels"), cell(0, "G se")), (1.0, pixel[se]));
    let outside = place.run("develop a.exr -o x.csv --region 8,17,0,4");
    assert!(outside.refusal().contains("region 8,17,0,4 lies outside"), "{}", outside.err);
}

/// With replicates the errors of whole squares of pixels are known, in the film and in what is made of it.
#[test]
fn regions_of_whole_squares_are_exact() {
    let place = Place::new();
    place.ok("render --resolution 16x16 --spp 16 --errors replicated --quiet -o a.exr -o a.film -o a.csv");
    let se = |input: &str, region: &str| {
        place.ok(&format!("develop {input} -o r.csv --force --region {region}"));
        let (rows, header) = table(&place, "r.csv");
        rows[0][column(&header, "G se")]
    };
    let (rows, header) = table(&place, "a.csv");
    let all: f64 = rows.iter().map(|r| r[column(&header, "G se")]).sum::<f64>() / 256.0;
    let exact = se("a.film", "0,16,8,16");
    assert_eq!(se("a.exr", "0,16,8,16"), exact);
    assert!(exact < all, "below the errors of pixels: {exact}, {all}");
    // seven rows of two squares, as if their pixels erred as one, and the same columns as squares
    assert!(se("a.exr", "0,16,9,16") > exact);
    let text = String::from_utf8(place.read("r.csv")).expect("text");
    assert!(text.contains("squares of 8 x 8") || text.contains("a square of 8 x 8"), "{text}");
    let diff = place.ok("diff a.exr a.film --json");
    assert!(diff.out.contains("identical"), "{}", diff.out);
}

#[test]
fn spectral_cubes_as_netcdf() {
    let place = Place::new();
    let job = "render --resolution 8x8 --spp 4 --quiet --bands 400:700:100 --split-orders 0,1+ --aov depth";
    place.ok(&format!("{job} -o a.nc -o a.film -o a.exr"));
    let cube = place.read("a.nc");
    for name in [
        "wavelength_bounds",
        "radiance_se",
        "order1plus_radiance",
        "depth_Z",
        "statistics_samples",
        "W m^-2 sr^-1 nm^-1",
    ] {
        assert!(cube.windows(name.len()).any(|w| w == name.as_bytes()), "{name}");
    }
    // the same from the film, and from EXR
    for source in ["a.film", "a.exr"] {
        place.ok(&format!("develop {source} -o b.nc --force"));
        assert!(place.read("b.nc") == cube, "{source}");
    }
    place.ok(&format!("{job} -o a.nc"));
    let refused = place.run(&format!("{job} --seed 9 -o a.nc"));
    assert!(refused.refusal().contains("a.nc: exists and is not the result of this job"), "{}", refused.err);
}
