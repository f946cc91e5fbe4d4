//! `tyndall validate`: exit codes, files, scenes for others.

mod common;

use common::Place;

#[test]
fn a_family_passes_and_leaves_a_table_and_a_page() {
    let place = Place::new();
    let ran = place.ok("validate --quick --family beer-lambert --rows -o out");
    for word in ["expected", "mean of z", "beer-lambert", "hero 8", "by rounding"] {
        assert!(ran.out.contains(word), "{word}\n{}", ran.out);
    }
    let csv = String::from_utf8(place.read("out/rows.csv")).expect("text");
    let rows = csv.lines().count() - 1;
    assert!(rows > 100 && csv.lines().skip(1).all(|l| l.ends_with(",true")), "{csv}");
    let page = String::from_utf8(place.read("out/index.html")).expect("text");
    assert!(page.contains("<svg") && page.contains("--family beer-lambert") && !page.contains("src=\"http"));
    assert_eq!(page.matches("<tr").count(), rows + 1 + 1 + 2, "a line a row, a family, all, and two headers");
}

#[test]
fn unknown_families_are_refused_with_the_names_of_the_others() {
    let ran = Place::new().run("validate --family slabs");
    assert!(ran.refusal().contains("--family slabs"), "{}", ran.err);
    assert!(ran.err.contains("slab-flux"), "{}", ran.err);
}

/// What is written for others is the same scene: rendered by hand it gives the answer that `expected.csv` tells.
#[test]
fn scenes_for_others() {
    let place = Place::new();
    let ran = place.ok("validate --scene-dir cases --family beer-lambert --family slab-flux");
    assert!(ran.out.contains("plain format"), "{}", ran.out);
    let table = String::from_utf8(place.read("cases/expected.csv")).expect("text");
    let line = table
        .lines()
        .find(|l| l.contains("beer-lambert/sky_mu=1.pbrt") && l.contains("tau 1.42"))
        .expect("a row");
    assert!(line.contains(",true,band,"), "{line}");
    let fields: Vec<&str> = line.split(',').collect();
    let expected: f64 = fields.iter().rev().nth(3).and_then(|f| f.parse().ok()).expect("a number");
    assert!((expected - (-1.42f64).exp()).abs() < 1e-12);
    let (from, to) = (fields[3], fields[4]);
    let scene = place.read("cases/beer-lambert/sky_mu=1.pbrt");
    assert!(!String::from_utf8_lossy(&scene).contains("absolute"), "plain pbrt-v4");
    place.ok(&format!(
        "render cases/beer-lambert/sky_mu=1.pbrt --spp 1024 --bands {from}:{to}:16 --range {from}:{to} -o x.csv"
    ));
    let csv = String::from_utf8(place.read("x.csv")).expect("text");
    let rows = csv.lines().filter(|l| l.starts_with(|c: char| c.is_ascii_digit()));
    let means: Vec<f64> =
        rows.map(|l| l.split(',').nth(8).and_then(|f| f.parse().ok()).expect("a number")).collect();
    let mean = means.iter().sum::<f64>() / means.len() as f64;
    // 16 pixels of 1024 samples: sqrt(e (1 - e) / 16384) is 0.0034
    assert!((mean - expected).abs() < 0.02, "{mean} against {expected}");
}
