//! Skies: what light sampling leaves to chance does not move the mean, nor what shared points leave to a pixel's own path.

use super::common::{
    Run,
    judge::{self, Estimate, Family},
    scene,
};
use super::media::{self, ALBEDO, BANDS, REFLECTANCE};
use super::shared;
use std::path::Path;
use tyndall::integrators::reuse::{Grouping, Level};
use tyndall_film::Developed;

/// A sky from an image of 8 x 8 texels, of which `texel` gives red, green and blue.
fn image(dir: &Path, name: &str, texel: impl Fn(usize) -> [f32; 3]) -> String {
    let file = dir.join(name);
    let mut bytes = b"PF\n8 8\n-1.0\n".to_vec();
    bytes.extend((0..64).flat_map(texel).flat_map(f32::to_le_bytes));
    std::fs::write(&file, bytes).expect("a folder to write to");
    format!("LightSource \"infinite\" \"bool absolute\" true \"string filename\" \"{}\"\n", file.display())
}

/// The cube of `medium` over a floor, with other light.
fn outdoors(medium: &str, light: &str) -> String {
    let matt = scene::diffuse(&BANDS, &REFLECTANCE);
    format!("{}WorldBegin\n{light}{medium}{}{matt}{}", media::camera(), media::cube(), scene::plane(-0.1))
}

/// A ball on a floor.
fn solid(light: &str) -> String {
    let matt = scene::diffuse(&BANDS, &REFLECTANCE);
    let ball = "AttributeBegin\nTranslate 0.5 0.3 0.5\nShape \"sphere\" \"float radius\" 0.4\nAttributeEnd\n";
    format!("{}WorldBegin\n{light}{matt}{}{ball}", media::camera(), scene::plane(-0.1))
}

/// In a medium that does not vary, where paths are shared, in one that does, and without one; from skies alone and beside a
/// lamp.
#[test]
fn what_is_left_to_chance_does_not_matter() {
    let dir = tempfile::tempdir().expect("a folder");
    let sun = |i: usize| if i == 27 { [40.0, 30.0, 9.0] } else { [0.2, 0.01 * i as f32, 0.5] };
    let skies = [
        ("one radiance", media::sky()),
        ("one radiance and a lamp", media::sky() + &media::lamp()),
        ("a sun in an image", image(dir.path(), "sun.pfm", sun)),
        ("an image without one", image(dir.path(), "even.pfm", |_| [0.5, 0.5, 0.5]) + &media::lamp()),
    ];
    let homogeneous = media::medium("homogeneous", &media::spectra(&ALBEDO, 1.0));
    let mut family = Family::default();
    for (name, sky) in skies {
        let grid = media::uniform(&ALBEDO, "");
        let scenes =
            [("even", outdoors(&homogeneous, &sky)), ("grid", outdoors(&grid, &sky)), ("solid", solid(&sky))];
        for (kind, text) in scenes {
            let always =
                Run::new(BANDS, 768).bands(&media::with_parameters(&text, "\"string skies\" \"always\""));
            let label = format!("{name}, {kind}");
            family.equal(&label, &Run::new(BANDS, 768).seed(2).bands(&text), &always);
        }
    }
    family.assert(0.06);
}

/// The picture where paths are shared so, with the level of the scene or without.
fn picture(run: &Run, text: &str, grouping: Grouping, level: bool) -> Developed {
    shared::picture(run, text, Some(grouping), |pass| {
        pass.settings.level = level;
        pass.level = pass.find_level();
        assert_eq!(pass.level != Level::NONE, level);
    })
}

fn bands(run: &Run, text: &str, grouping: Grouping, level: bool) -> Vec<Estimate> {
    judge::pooled(&picture(run, text, grouping, level)).split_off(3)
}

#[test]
fn light_in_common_does_not_matter() {
    let homogeneous = media::medium("homogeneous", &media::spectra(&ALBEDO, 1.0));
    let mut family = Family::default();
    for (kind, medium) in [("even", &homogeneous), ("grid", &media::uniform(&ALBEDO, ""))] {
        let text = outdoors(medium, &(media::sky() + &media::lamp()));
        for (n, grouping) in [shared::FEW, shared::MANY].into_iter().enumerate() {
            let run = Run { side: 8, ..Run::new(BANDS, 2048) }.seed(n as u64);
            let without = bands(&run, &text, grouping, false);
            for (lanes, seed) in [(4, 5), (8, 6), (16, 7)] {
                let with = bands(&run.clone().hero(lanes).seed(seed), &text, grouping, true);
                family.equal(&format!("{kind}, {n}, {lanes} wavelengths"), &with, &without);
            }
        }
    }
    family.assert(0.06);
}

/// Fog under a sky alone: much the same comes from everywhere. What a square gets in all is the same, but each pixel's part
/// varies less; a thousand pixels know the ratio to a few per cent.
#[test]
fn light_in_common_takes_noise_away() {
    let fog = media::medium("homogeneous", &media::spectra(&ALBEDO, 1.0));
    let text = outdoors(&fog, &media::sky());
    let run = Run { side: 32, ..Run::new(BANDS, 64) };
    let variance = |level| -> f64 {
        let d = picture(&run, &text, shared::FEW, level);
        d.y_error.iter().map(|&e| f64::from(e).powi(2)).sum()
    };
    let ratio = variance(true) / variance(false);
    assert!(ratio < 0.6, "variance with the level is {ratio} of that without");
}
