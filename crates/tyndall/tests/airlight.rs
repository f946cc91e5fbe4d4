//! The airlight of a point light with and without equiangular samples.

mod common;

use common::{Dialect, Run, judge::Family};
use tyndall::validate::FAMILIES;

#[test]
fn equiangular_sampling_leaves_the_mean_alone() {
    let airlight = FAMILIES.iter().find(|f| f.name == "airlight").expect("a family of that name");
    let mut family = Family::default();
    for case in (airlight.cases)(Dialect::Own) {
        for equiangular in ["always", "off"] {
            // without equiangular samples the vertices near the light are rare and heavy
            let spp = if equiangular == "off" { 16384 } else { 2048 };
            if case.name.contains("h=0.1") && equiangular == "off" {
                continue;
            }
            let word = format!("\"volpath\" \"string equiangular\" \"{equiangular}\"");
            let text = case.text.replace("\"volpath\"", &word);
            assert_ne!(text, case.text);
            let run = Run { max_depth: 1, ..Run::new(case.bands, spp) };
            family.bands(&format!("{}, {equiangular}", case.name), &run.bands(&text), &case.expected);
        }
    }
    family.assert(0.1);
}
