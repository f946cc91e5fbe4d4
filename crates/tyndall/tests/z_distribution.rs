//! The errors themselves: over many seeds, differences from the truth over their errors follow the normal law.

mod common;

use common::{Bands, Run, judge::Family, scene, table::Table};
use std::sync::Arc;
use tyndall::{Options, Plan, Source, plan};
use tyndall_film::ErrorMode;
use tyndall_testkit::{Welford, distribution::normal_cdf, ks_test, z_max};

const BANDS: Bands = Bands::new(8);
const FLUX: &str = include_str!("../data/validate/slab_flux.csv");
const SEEDS: std::ops::Range<u64> = 1000..1100;

/// Differences and normal scores of one family at `seed`: plane albedo and transmittance of eight Rayleigh slabs.
fn family(seed: u64, opow: bool) -> Vec<[f64; 2]> {
    let table = Table::parse(FLUX).only("phase", "rayleigh").only("mu0", "0.5");
    let phase = " \"string phase\" \"rayleigh\"";
    let medium = scene::medium(&BANDS, "m", &table.column("tau"), &table.column("albedo"), phase);
    let slab = scene::slab("m", scene::INTERFACE);
    let run = Run::new(BANDS, 512).seed(seed);
    let run = if opow { run.opow() } else { run };
    let mut family = Family::default();
    family.bands("R", &run.bands(&scene::reflectance(&BANDS, 0.5, &medium, &slab)), &table.column("R"));
    family.bands(
        "T",
        &run.bands(&scene::transmittance(&BANDS, 0.5, &medium, &slab)),
        &table.column("T_total"),
    );
    family.differences()
}

#[test]
#[ignore = "100 seeds"]
fn scores_of_a_hundred_seeds_are_normal() {
    for opow in [false, true] {
        let seeds: Vec<_> = SEEDS.map(|seed| family(seed, opow)).collect();
        let all: Welford = seeds.iter().flatten().map(|[_, z]| *z).collect();
        println!("opow {opow}: mean {:.3}, variance {:.3} of {} scores", all.mean(), all.variance(), all.n());
        for row in 0..seeds[0].len() {
            let score = || seeds.iter().map(|rows| rows[row][1]);
            let (w, bias): (Welford, Welford) =
                (score().collect(), seeds.iter().map(|rows| rows[row][0]).collect());
            let bias = bias.z_test(0.0);
            println!(
                "  row {row:2}: scores' mean {:6.3}, variance {:.3}; all seeds together z = {:.2}",
                w.mean(),
                w.variance(),
                bias.z
            );
            // seeds are independent, rows of one seed are not
            bias.assert_ok("mean of all seeds", 32);
            ks_test(score(), normal_cdf).assert_ok("distribution of scores", 32);
            let spread = (w.variance() - 1.0) / (2.0 / (w.n() - 1) as f64).sqrt();
            assert!(spread.abs() < z_max(32), "row {row}: variance {}", w.variance());
        }
    }
}

/// Mean of G over the box of fog with its standard error, from one plan; `square` is what the film is told of its pixels.
fn fog(plan: &mut Plan, seed: u64, square: u32) -> [f64; 2] {
    plan.pass.seed = seed;
    let film = Arc::make_mut(&mut plan.job.film);
    (film.seed, film.square) = (seed, square);
    let d = common::develop(plan);
    let (mean, error) = d.mean_over(1, d.bounds);
    [mean, error.variance.sqrt()]
}

/// Pixels of a square go on from each other's scatterings: the whole picture has the error of its squares.
#[test]
#[ignore = "80 seeds"]
fn scores_of_pixels_that_share_paths_have_variance_one() {
    let options = Options {
        resolution: Some([12, 12]),
        spp: Some(64),
        errors: ErrorMode::REPLICATED,
        ..Options::default()
    };
    let mut plan = plan(Source::BuiltIn, &options).expect("plans");
    assert_eq!(plan.job.film.square, 4, "the box shares paths");
    let mut spread = |square: u32| {
        let all: Vec<[f64; 2]> = (1..=80).map(|seed| fog(&mut plan, seed, square)).collect();
        let mean = all.iter().map(|[m, _]| m).sum::<f64>() / all.len() as f64;
        let squares: Welford = all.iter().map(|[m, se]| ((m - mean) / se).powi(2)).collect();
        squares.mean()
    };
    let (right, naive) = (spread(4), spread(1));
    println!("mean square of scores: {right:.2} with squares, {naive:.2} without");
    // 80 squares of about normal scores: their mean is known to 16 %
    assert!((right - 1.0).abs() < 0.7, "{right}");
    assert!(naive > right);
}
