//! Who shares paths: a pilot tells how much of the light is scattered more than once.

use std::path::Path;
use tyndall::{Options, Source, integrators::reuse::Grouping, plan};

/// How pixels share, inside a sphere that emits everywhere and reflects the part `rho`: light scattered n times has the
/// radiance `Le rho^n`, so that of all light scattered at all the part `rho` is scattered again.
fn grouping(rho: f32, resolution: u32, more: &str) -> Option<Grouping> {
    let text = format!(
        "LookAt 0 0 0  0 0 1  0 1 0
         Camera \"perspective\" \"float fov\" 60
         Film \"rgb\" \"integer xresolution\" {resolution} \"integer yresolution\" {resolution}
         Integrator \"volpath\" \"integer maxdepth\" 50 {more}
         WorldBegin
         AreaLightSource \"diffuse\" \"float scale\" 1 \"bool twosided\" true
         Material \"diffuse\" \"spectrum reflectance\" [360 {rho} 830 {rho}]
         Shape \"sphere\" \"float radius\" 2"
    );
    let plan = plan(Source::Text("sphere", &text, Path::new("")), &Options::default()).expect("a scene");
    assert_eq!(plan.job.film.square, plan.pass.shared_side());
    assert_eq!(plan.pass.shares_paths(), plan.pass.grouping.is_some());
    plan.pass.grouping
}

#[test]
fn more_share_where_more_light_is_scattered_again() {
    let some = |cells, cell| Some(Grouping { cells, cell });
    assert_eq!(grouping(0.06, 32, ""), None);
    assert_eq!(grouping(0.22, 32, ""), some(4, 1));
    assert_eq!(grouping(0.22, 300, ""), some(4, 2));
    assert_eq!(grouping(0.5, 32, ""), some(8, 1));
    assert_eq!(grouping(0.5, 300, ""), some(8, 1));
    assert_eq!(grouping(0.5, 32, "\"bool pathreuse\" false"), None);
}
