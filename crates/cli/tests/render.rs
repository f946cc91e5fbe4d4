//! `tyndall render` on the built-in scene: files, records, the same bits on every way.

mod common;

use common::Place;

/// The built-in scene in a size for tests.
const TINY: &str = "render --resolution 16x16 --spp 4 --quiet";

#[test]
fn the_first_command_writes_everything() {
    let place = Place::new();
    let ran = place.ok("render --resolution 16x16 --spp 4");
    for name in ["cornell-fog.exr", "cornell-fog.png", "cornell-fog.error.exr", "cornell-fog.run.json"] {
        assert!(place.has(name), "{name}");
    }
    assert!(!place.has("cornell-fog.ckpt"), "a finished job leaves no checkpoint");
    assert!(ran.err.contains("100 %") && ran.err.contains("4/4 spp"), "{}", ran.err);
    assert_eq!(std::fs::read_dir(place.folder()).expect("readable").count(), 4, "nothing else is left");
}

#[test]
fn the_record_has_exactly_its_keys() {
    let place = Place::new();
    place.ok(TINY);
    let record = place.json("cornell-fog.run.json");
    let keys = |v: &serde_json::Value| v.as_object().expect("an object").keys().cloned().collect::<Vec<_>>();
    let expected = "version command scene scene_hash seed integrator spectral wavelengths resolution spp \
                    seconds samples_per_second threads error non_finite range_nm units";
    assert_eq!(keys(&record), expected.split_whitespace().collect::<Vec<_>>());
    assert_eq!(keys(&record["seconds"]), ["load", "build", "render"]);
    assert_eq!(keys(&record["error"]), ["mode", "median_rel_se_y", "max_rel_se_y"]);
    assert_eq!(record["resolution"], serde_json::json!([16, 16]));
    assert_eq!(record["range_nm"], serde_json::json!([360.0, 830.0]));
    assert_eq!((record["spp"].as_f64(), record["wavelengths"].as_u64()), (Some(4.0), Some(8)));
    assert_eq!(record["units"], "W m^-2 sr^-1 nm^-1");
    assert!(record["command"].as_str().is_some_and(|c| c.contains("--resolution 16x16")));
    assert!(record["samples_per_second"].as_f64().is_some_and(|r| r > 0.0));
}

#[test]
fn any_number_of_threads_gives_the_same_file() {
    let place = Place::new();
    for threads in 1..=3 {
        place.ok(&format!("{TINY} --threads {threads} -o t{threads}.exr"));
    }
    assert!(place.read("t1.exr") == place.read("t2.exr"));
    assert!(place.read("t1.exr") == place.read("t3.exr"));
    assert!(place.read("t1.error.exr") == place.read("t2.error.exr"));
    place.ok(&format!("{TINY} --seed 1 -o other.exr"));
    assert!(place.read("t1.exr") != place.read("other.exr"), "another seed is another image");
}

#[test]
fn shards_merge_to_the_file_of_one_run() {
    let place = Place::new();
    let options = "--bands 400:700:100 --split-orders 0,1,2+ --aov depth,albedo";
    place.ok(&format!("{TINY} {options} -o whole.exr"));
    for k in 1..=3 {
        place.ok(&format!("{TINY} {options} --shard {k}/3"));
    }
    place.ok("merge cornell-fog.3-of-3.film cornell-fog.1-of-3.film cornell-fog.2-of-3.film -o merged.exr");
    assert!(place.read("whole.exr") == place.read("merged.exr"));
    assert!(place.read("whole.error.exr") == place.read("merged.error.exr"));
    let gap = place.run("merge cornell-fog.3-of-3.film cornell-fog.1-of-3.film -o gap.exr");
    assert!(gap.refusal().contains("in none of the films"), "{}", gap.err);
    let twice = place.run("merge cornell-fog.3-of-3.film cornell-fog.3-of-3.film -o twice.exr");
    assert!(twice.refusal().contains("both hold samples"), "{}", twice.err);
    place.ok(&format!("{TINY} --seed 5 --shard 1/3 -o stranger.film"));
    let stranger = place.run("merge cornell-fog.3-of-3.film stranger.film -o x.exr");
    assert!(stranger.refusal().contains("stranger.film: belongs to another job"), "{}", stranger.err);
    assert!(!place.has("gap.exr") && !place.has("twice.exr") && !place.has("x.exr"));
}

#[test]
fn results_are_replaced_by_their_own_job_or_by_force_only() {
    let place = Place::new();
    place.ok(TINY);
    let first = place.read("cornell-fog.exr");
    place.ok(TINY);
    assert!(place.read("cornell-fog.exr") == first);
    let refused = place.run("render --resolution 16x16 --spp 8 --quiet");
    assert!(
        refused.refusal().contains("cornell-fog.exr: exists and is not the result of this job"),
        "{}",
        refused.err
    );
    assert!(refused.err.contains("hint: --force"), "{}", refused.err);
    assert!(place.read("cornell-fog.exr") == first);
    place.ok("render --resolution 16x16 --spp 8 --quiet --force");
    assert!(place.read("cornell-fog.exr") != first);
    for name in ["mine.png", "mine.csv", "mine.film"] {
        place.write(name, "my own notes");
        let refused = place.run(&format!("{TINY} -o {name}"));
        assert!(refused.refusal().contains(&format!("{name}: exists")), "{}", refused.err);
        assert_eq!(place.read(name), b"my own notes");
        place.ok(&format!("{TINY} -o {name} --force"));
        place.ok(&format!("{TINY} -o {name}"));
    }
}

#[test]
fn orders_add_up_to_the_whole() {
    let place = Place::new();
    place.ok(&format!("{TINY} --split-orders 0,1,2+ -o a.csv"));
    let table = String::from_utf8(place.read("a.csv")).expect("text");
    let mut lines = table.lines().filter(|l| !l.starts_with('#'));
    let header: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let column = |name: &str| header.iter().position(|h| h.split(' ').next() == Some(name)).expect(name);
    for line in lines {
        let cells: Vec<f64> = line.split(',').map(|c| c.parse().expect("a number")).collect();
        for c in ["R", "G", "B"] {
            let orders = ["order0", "order1", "order2+"].map(|o| cells[column(&format!("{o}.{c}"))]);
            let (parts, whole) = (orders.iter().sum::<f64>(), cells[column(c)]);
            // rounding is that of the parts, which may be of both signs
            let size = orders.iter().map(|o| o.abs()).sum::<f64>();
            assert!((parts - whole).abs() <= 1e-5 * size.max(1e-3), "{c}: {parts} {whole} in {line}");
        }
    }
}

#[test]
fn a_path_can_be_replayed_alone() {
    let place = Place::new();
    let ran = place.ok("render --resolution 16x16 --pixel 8,8 --sample 3 --trace");
    for word in ["pixel 8,8 sample 3", "lambda [nm]", "throughput", "radiance", "film"] {
        assert!(ran.out.contains(word), "{word}\n{}", ran.out);
    }
    let json = place.ok("render --resolution 16x16 --pixel 8,8 --sample 3 --trace --log json");
    let trace: serde_json::Value = serde_json::from_str(&json.out).expect("JSON");
    assert_eq!(trace["lambda_nm"].as_array().map(Vec::len), Some(8));
    assert!(
        place
            .run("render --resolution 16x16 --pixel 16,0 --sample 0 --trace")
            .refusal()
            .contains("0,0 to 15,15")
    );
}

#[test]
fn all_strategies_and_integrators_run_and_say_so() {
    let place = Place::new();
    for (options, key, value) in [
        ("--spectral opow", "spectral", serde_json::json!("opow")),
        ("--spectral opow --wavelengths 5 --wavelength-rule endpoints", "wavelengths", serde_json::json!(5)),
        ("--spectral hero --wavelengths 4", "wavelengths", serde_json::json!(4)),
        ("--wavelength-pdf uniform --max-depth -1", "integrator", serde_json::json!("volpath")),
        ("--integrator analog", "integrator", serde_json::json!("analog")),
        ("--integrator path", "integrator", serde_json::json!("path")),
        ("--seed 18446744073709551615", "seed", serde_json::json!(u64::MAX)),
        ("--errors replicated", "spp", serde_json::json!(2)),
    ] {
        place.ok(&format!("render --resolution 8x8 --spp 2 --quiet --force {options} -o a.exr"));
        assert_eq!(place.json("a.run.json")[key], value, "{options}");
    }
}

#[test]
fn overrides_change_the_scene() {
    let place = Place::new();
    // pixels err together: replicates tell how much
    let known = "render --resolution 16x16 --spp 32 --quiet --errors replicated";
    place.ok(&format!("{known} -o fog.exr"));
    place.ok(&format!("{known} --set fog.scale=0 -o clear.exr"));
    let diff = place.ok("diff clear.exr fog.exr --json");
    let diff: serde_json::Value = serde_json::from_str(&diff.out).expect("JSON");
    assert_eq!(diff["verdict"], "differ");
    place.ok("render --quiet --set film.xresolution=8 --set film.yresolution=4 --set sampler.pixelsamples=2 -o s.exr");
    let record = place.json("s.run.json");
    assert_eq!((&record["resolution"], &record["spp"]), (&serde_json::json!([8, 4]), &serde_json::json!(2)));
}

#[test]
fn a_crop_holds_the_same_pixels() {
    let place = Place::new();
    place.ok(&format!("{TINY} -o whole.csv"));
    place.ok(&format!("{TINY} --crop 0.5,1,0,0.5 -o part.csv"));
    let rows = |name: &str| -> Vec<String> {
        let text = String::from_utf8(place.read(name)).expect("text");
        text.lines().filter(|l| l.starts_with(|c: char| c.is_ascii_digit())).map(str::to_owned).collect()
    };
    let (whole, part) = (rows("whole.csv"), rows("part.csv"));
    assert_eq!((whole.len(), part.len()), (256, 64));
    assert!(part.iter().all(|row| whole.contains(row)), "{}", part[0]);
}

#[test]
fn a_time_limit_ends_on_a_whole_round() {
    let place = Place::new();
    place.ok("render --resolution 16x16 --spp 1000000 --time 300ms --quiet -o timed.exr");
    let spp = place.json("timed.run.json")["spp"].as_f64().expect("a number");
    assert_eq!(spp.fract(), 0.0);
    place.ok(&format!("render --resolution 16x16 --spp {spp} --quiet -o counted.exr"));
    let ran = place.ok("diff timed.exr counted.exr");
    assert!(ran.out.contains("identical"), "{}", ran.out);
}

#[test]
fn shards_with_a_guide_give_the_numbers_of_the_run_it_comes_from() {
    let place = Place::new();
    let job = "render --resolution 8x8 --spp 512 --quiet --errors replicated";
    place.ok(&format!("{job} --until rel=20% -o until.exr -o until.film"));
    let record = place.json("until.run.json");
    assert_eq!(record["error"]["mode"], "replicated");
    for k in 1..=2 {
        place.ok(&format!("{job} --guide until.film --shard {k}/2 -o {k}.film"));
    }
    place.ok("merge 1.film 2.film -o merged.exr");
    assert_eq!(place.json("merged.run.json")["spp"], record["spp"]);
    let diff = place.ok("diff merged.exr until.exr");
    assert!(diff.out.contains("identical"), "{}", diff.out);
    let plain = place.run(&format!("{job} --guide 1.film -o x.exr"));
    assert_eq!(plain.code, 0, "a shard's film carries its guide: {}", plain.err);
    place.ok("render --resolution 8x8 --spp 2 --quiet -o none.film");
    assert!(place.run(&format!("{job} --guide none.film")).refusal().contains("has learned nothing"));
}

#[test]
fn json_logs_are_json() {
    let place = Place::new();
    let ran = place.ok("render --resolution 8x8 --spp 2 --log json");
    for line in ran.err.lines() {
        let value: serde_json::Value = serde_json::from_str(line).unwrap_or_else(|e| panic!("{line}: {e}"));
        assert!(value["message"].is_string());
    }
    assert!(ran.err.contains("samples_per_second"));
}
