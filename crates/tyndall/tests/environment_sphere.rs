//! A sphere of medium in a uniform sky: the mean over its disc against an integral equation.

mod common;

use common::{Bands, Run, judge::Family, scene, table::Table};
use std::f64::consts::FRAC_PI_4;

#[test]
fn mean_radiance_of_the_disc() {
    let table = Table::parse(include_str!("../data/tests/sphere_uniform_environment.csv"));
    let bands = Bands { count: table.len() };
    let medium = scene::medium(&bands, "m", &table.column("tau_radius"), &table.column("albedo"), "");
    let camera = scene::camera([0.0, 0.0, 5.0], [0.0; 3], 1.0);
    let text = format!("{camera}WorldBegin\n{}{medium}{}", scene::SKY, scene::ball("m", scene::INTERFACE));
    // the picture is the square around the disc, its corners are sky
    let expected: Vec<f64> =
        table.column("mean_radiance_over_disc_env=1").iter().map(|l| 1.0 + FRAC_PI_4 * (l - 1.0)).collect();
    let mut family = Family::default();
    family.bands("hero 8", &Run::new(bands, 4096).bands(&text), &expected);
    family.bands("hero 16", &Run::new(bands, 4096).hero(16).bands(&text), &expected);
    family.bands("opow", &Run::new(bands, 4096).opow().bands(&text), &expected);
    family.bands("analog", &Run::new(bands, 4096).analog().bands(&text), &expected);
    family.assert(0.05);
}
