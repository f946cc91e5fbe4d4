//! The same bits for every number of threads, instruction set, shard and interruption, on a scene with every kind of medium.

mod common;

use common::Place;

/// Three tiles, so that there are units to be shuffled.
const OPTIONS: &str = "--quiet --bands 400:700:100 --resolution 33x4 --spp 8";

fn place() -> Place {
    let place = Place::new();
    place.write("media.pbrt", include_str!("data/media.pbrt"));
    place
}

const JOBS: [&str; 2] =
    ["--integrator analog --spectral opow", "--errors replicated --wavelengths 4 --max-depth 6"];

#[test]
fn threads_and_instruction_sets() {
    let place = place();
    for job in JOBS {
        let run = format!("render media.pbrt {OPTIONS} {job}");
        place.ok(&format!("{run} -o one.exr --threads 1 --force"));
        let mut ways: Vec<String> = [2, 3, 8].map(|n| format!("--threads {n}")).into();
        ways.extend(["portable", "avx2", "avx512"].map(|isa| format!("--threads 2 --isa {isa}")));
        for way in ways {
            let ran = place.run(&format!("{run} -o other.exr --force {way}"));
            if ran.code == 2 && way.contains("--isa avx") {
                println!("{way}: not on this processor");
                continue;
            }
            assert_eq!(ran.code, 0, "{job} {way}: {}", ran.err);
            for file in ["exr", "error.exr"] {
                let [a, b] = ["one", "other"].map(|name| place.read(&format!("{name}.{file}")));
                assert!(a == b, "{job} {way}: other bits in {file}");
            }
        }
    }
}

#[test]
fn shards_and_interruptions() {
    let place = place();
    let run = format!("render media.pbrt {OPTIONS}");
    place.ok(&format!("{run} -o one.exr --threads 1 --force"));
    for k in 1..=3 {
        place.ok(&format!("{run} --shard {k}/3 -o {k}.film --force"));
    }
    place.ok("merge 3.film 1.film 2.film -o merged.exr --force --quiet");
    assert!(place.ok("diff one.exr merged.exr").out.contains("identical, bit for bit"));
    // the time is up after the first round
    place.ok(&format!("{run} -o resumed.exr --time 1ms --force"));
    assert_eq!(place.json("resumed.run.json")["complete"], false);
    place.ok(&format!("{run} -o resumed.exr --resume --force"));
    assert!(place.read("one.exr") == place.read("resumed.exr"));
}
