//! Paths that are shared through media that vary: links are weighed by coarse lengths, and the mean is the same.

use super::common::{
    Run, develop,
    judge::{self, Estimate, Family},
    scene,
};
use super::media::{self, ALBEDO, BANDS, REFLECTANCE};
use super::sparse;
use std::sync::Arc;
use tyndall::integrators::{pixel::PixelPass, reuse::Grouping};
use tyndall_film::Developed;

pub const FEW: Grouping = Grouping { cells: 4, cell: 1 };
pub const MANY: Grouping = Grouping { cells: 8, cell: 1 };

/// The cube between a floor and a wall, under a lamp and the sky.
fn lit(medium: &str) -> String {
    let lamp = media::lamp();
    let matt = scene::diffuse(&BANDS, &REFLECTANCE);
    let wall = "Shape \"bilinearmesh\" \"point3 P\" [-0.4 -3 -3  -0.4 3 -3  -0.4 -3 3  -0.4 3 3]\n";
    let (camera, sky, cube, floor) = (media::camera(), media::sky(), media::cube(), scene::plane(-0.1));
    format!("{camera}WorldBegin\n{sky}{medium}{cube}{lamp}{matt}{floor}{wall}")
}

/// Band means where paths are shared so, whatever the pilots say.
fn bands(run: &Run, text: &str, grouping: Option<Grouping>) -> Vec<Estimate> {
    let picture = picture(run, text, grouping, |pass| pass.level = pass.find_level());
    judge::pooled(&picture).split_off(3)
}

/// The picture where paths are shared so, of a pass that is changed besides.
pub fn picture(
    run: &Run,
    text: &str,
    grouping: Option<Grouping>,
    change: impl FnOnce(&mut PixelPass),
) -> Developed {
    let mut plan = run.plan(text);
    plan.pass.grouping = grouping;
    change(&mut plan.pass);
    assert_eq!(plan.pass.shares_paths(), grouping.is_some());
    Arc::make_mut(&mut plan.job.film).square = plan.pass.shared_side();
    develop(&plan)
}

/// Voxels of the cube are so rough and dense that coarse lengths are far from the exact ones.
#[test]
fn sharing_does_not_matter() {
    let dir = tempfile::tempdir().expect("a folder");
    let media = [("dense", media::uniform(&ALBEDO, "")), ("sparse", sparse::grid(dir.path(), 1, 2.0))];
    let mut family = Family::default();
    for (name, medium) in media {
        let text = lit(&medium);
        let run = |spp: u32| Run { side: 8, ..Run::new(BANDS, 16 * spp) };
        let alone = bands(&run(512).seed(7), &text, None);
        for (what, run, grouping) in [
            ("few", run(256), FEW),
            ("many", run(128).seed(2), MANY),
            ("four wavelengths", run(256).hero(4).seed(3), FEW),
            ("sixteen", run(128).hero(16).seed(4), FEW),
        ] {
            family.equal(&format!("{name}, {what}"), &bands(&run, &text, Some(grouping)), &alone);
        }
    }
    family.assert(0.05);
}

/// How paths are shared in a thin smoke or a dense cloud, on a film so fine.
fn grouping(density: f64, resolution: u32) -> Option<Grouping> {
    let smooth: Vec<f64> = (0..512).map(|i| density * (1.0 + 0.2 * (f64::from(i / 64) - 3.5))).collect();
    let dims = " \"integer nx\" 8 \"integer ny\" 8 \"integer nz\" 8";
    let white = " \"spectrum sigma_a\" [300 0 900 0] \"spectrum sigma_s\" [300 1 900 1]";
    let parameters = format!("{dims}{}{white}", media::numbers("density", &smooth));
    let run = Run { side: resolution, max_depth: 30, ..Run::new(BANDS, 1) };
    run.plan(&lit(&media::medium("uniformgrid", &parameters))).pass.grouping
}

#[test]
fn smoke_is_shared_and_what_is_dense_for_a_pixel_is_not() {
    assert!(grouping(1.0, 16).is_some());
    assert_eq!(grouping(200.0, 16), None);
}
