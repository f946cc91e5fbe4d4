//! What each technique buys: the defaults over the defaults with that technique changed.

use crate::{
    efficiency::Efficiency,
    mask,
    measure::{self, Task},
    scenes::BenchScene,
    setup::Setup,
    store,
    variants::{DEFAULTS, TECHNIQUES},
};
use serde_json::json;

/// Samples per pixel of the techniques' table.
pub const SPP: u32 = 16;

/// Measures every technique on the small scenes.
pub fn all(setup: &Setup) -> Result<(), String> {
    for scene in setup.scenes.iter().filter(|s| !s.large) {
        eprintln!("{}: techniques", scene.name);
        let (defaults, changed) = on(setup, scene)?;
        for (name, e) in changed {
            let (ratio, whole) = (defaults.headline / e.headline, defaults.whole / e.whole);
            let relative = (defaults.headline_se / defaults.headline).hypot(e.headline_se / e.headline);
            store::line(
                &setup.folder,
                &json!({
                    "kind": "technique", "scene": scene.name, "changed": name, "spp": SPP,
                    "resolution": setup.technique_resolution(), "seeds": setup.seeds, "ratio": ratio,
                    "ratio_se": ratio * relative, "ratio_whole": whole, "measured": e.json(),
                }),
            )?;
        }
    }
    Ok(())
}

type Changed = Vec<(&'static str, Efficiency)>;

/// The defaults, then every variant that the scene allows.
fn on(setup: &Setup, scene: &BenchScene) -> Result<(Efficiency, Changed), String> {
    let resolution = setup.technique_resolution();
    let variants: Vec<_> = std::iter::once(&DEFAULTS).chain(TECHNIQUES).filter(|v| scene.allows(v)).collect();
    let task = |&variant: &_| Task { scene, variant, resolution, spp: SPP, seeds: setup.seeds };
    let tasks: Vec<Task<'_>> = variants.iter().map(task).collect();
    let measured = measure::all(setup, &tasks)?;
    let mask = mask::lamp(setup, scene, resolution)?;
    let reference = measured[0].mean_picture();
    let all: Changed =
        variants.iter().zip(&measured).map(|(v, m)| (v.name, m.efficiency(&mask, &reference))).collect();
    Ok((all[0].1, all[1..].to_vec()))
}
