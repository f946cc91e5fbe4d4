//! What must not matter: majorants, estimators, boxes, integrators, instruction sets; and a constant grid is homogeneous.

use super::common::{Run, develop, judge::Family, scene};
use super::known::with_integrator;
use super::media::{self, ALBEDO, BANDS};
use tyndall_film::ErrorMode;
use tyndall_geometry::Dispatch;

/// The cube over a grey floor under a lamp and the sky.
fn lit(medium: &str, cube: &str) -> String {
    let sky = "LightSource \"infinite\" \"bool absolute\" true \"spectrum L\" [300 2 900 1]\n";
    let floor = "Material \"diffuse\" \"spectrum reflectance\" [300 0.2 900 0.7]\n";
    format!(
        "{}WorldBegin\n{sky}{medium}{cube}{}{floor}{}",
        media::camera(),
        media::lamp(),
        scene::plane(-0.1)
    )
}

#[test]
fn analog_judges_volpath() {
    let mut family = Family::default();
    for (name, medium) in media::all("") {
        let text = lit(&medium, &media::cube());
        let judge = Run::new(BANDS, 3072).analog().seed(7).bands(&text);
        for (lanes, run) in [("8", Run::new(BANDS, 512)), ("4", Run::new(BANDS, 512).hero(4))] {
            family.equal(&format!("{name}, {lanes}"), &run.bands(&text), &judge);
        }
        family.equal(&format!("{name}, opow"), &Run::new(BANDS, 1024).opow().bands(&text), &judge);
    }
    family.assert(0.05);
}

#[test]
fn majorants_do_not_matter() {
    let mut family = Family::default();
    for (i, (name, medium)) in media::all("").into_iter().enumerate() {
        let reference = Run::new(BANDS, 512).bands(&lit(&medium, &media::cube()));
        for scale in [2, 10] {
            let wide = media::all(&format!(" \"float majorantscale\" {scale}")).swap_remove(i).1;
            let run = Run::new(BANDS, 512).seed(2 + scale);
            family.equal(&format!("{name} x {scale}"), &run.bands(&lit(&wide, &media::cube())), &reference);
        }
    }
    family.assert(0.05);
}

#[test]
fn estimators_do_not_matter() {
    let text = lit(&media::uniform(&ALBEDO, ""), &media::cube());
    let reference = Run::new(BANDS, 1024).bands(&text);
    let mut family = Family::default();
    let switches =
        ["residualratio=false", "exacttransmittance=false", "survival=false", "lightsampling=false"];
    for (i, switch) in switches.into_iter().enumerate() {
        let run = Run::new(BANDS, 1024).seed(20 + i as u64);
        family.equal(switch, &run.bands(&with_integrator(&text, switch)), &reference);
    }
    family.assert(0.05);
}

#[test]
fn two_boxes_are_one() {
    let medium = media::uniform(&ALBEDO, "");
    let one = Run::new(BANDS, 512).bands(&lit(&medium, &media::cube()));
    let twin = medium.replace("MakeNamedMedium \"m\"", "MakeNamedMedium \"n\"");
    let half = |name: &str, low: f64, high: f64| {
        let shape = scene::cuboid([low, 0.0, 0.0], [high, 1.0, 1.0]);
        format!(
            "AttributeBegin\nMediumInterface \"{name}\" \"\"\n{}\n{shape}AttributeEnd\n",
            scene::INTERFACE
        )
    };
    // a hair apart, so that no ray meets two faces at once
    let boxes = half("m", 0.0, 0.369_999) + &half("n", 0.37, 1.0);
    let two = Run::new(BANDS, 512).seed(3).bands(&lit(&(medium + &twin), &boxes));
    let mut family = Family::default();
    family.equal("two boxes", &two, &one);
    family.assert(0.05);
}

#[test]
fn a_constant_grid_is_homogeneous() {
    let spectra = format!("{}{}", media::spectra(&ALBEDO, 1.5), media::phase());
    let smooth = Run::new(BANDS, 1024).bands(&lit(&media::medium("homogeneous", &spectra), &media::cube()));
    let ones = media::numbers("density", &[1.0; 8]);
    let dims = " \"integer nx\" 2 \"integer ny\" 2 \"integer nz\" 2 \"string edge\" \"clamp\"";
    let grid = media::medium("uniformgrid", &format!("{dims}{ones}{spectra}"));
    let mut family = Family::default();
    let got = Run::new(BANDS, 512).seed(4).bands(&lit(&grid, &media::cube()));
    family.equal("clamp", &got, &smooth);
    // pbrt's grids are even only inside of the outermost half voxels: a grid that reaches further
    let wide = media::medium("uniformgrid", &format!("{}{ones}{spectra}", dims.replace("clamp", "fade")));
    let wide =
        wide.replace("\"string type\"", "\"point3 p0\" [-1 -1 -1] \"point3 p1\" [2 2 2] \"string type\"");
    family.equal("fade", &Run::new(BANDS, 512).seed(5).bands(&lit(&wide, &media::cube())), &smooth);
    family.assert(0.05);
}

#[test]
fn instruction_sets_agree_to_the_bit() {
    for (name, medium) in media::all("") {
        let text = lit(&medium, &media::cube());
        let bits = |dispatch| {
            let run = Run { dispatch, errors: ErrorMode::Conservative, ..Run::new(BANDS, 16) };
            let d = develop(&run.plan(&text));
            d.mean.concat().iter().map(|v| v.to_bits()).collect::<Vec<_>>()
        };
        assert_eq!(bits(Dispatch::Detect), bits(Dispatch::Portable), "{name}");
    }
}
