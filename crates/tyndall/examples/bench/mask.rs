//! Pixels that see a lamp, and their neighbours.

use crate::{measure, scenes::BenchScene, setup::Setup};
use tyndall::{Options, Source, plan};

/// A picture of yes and no.
#[derive(Clone, Debug)]
pub struct Mask {
    hidden: Vec<bool>,
}

/// The mask of a scene: light that reaches a pixel without scattering, in any of 256 samples, dilated by one pixel.
/// Nothing under a sky, where the lamp is out of view.
pub fn lamp(setup: &Setup, scene: &BenchScene, resolution: u32) -> Result<Mask, String> {
    if scene.open {
        return Ok(Mask { hidden: vec![false; (resolution * resolution) as usize] });
    }
    let options = Options {
        spp: Some(256),
        resolution: Some([resolution; 2]),
        max_depth: Some(0),
        ..Options::default()
    };
    let path = scene.path(&setup.scene_folder());
    let plan = plan(Source::File(&path), &options).map_err(|e| e.to_string())?;
    let seen = measure::picture(&plan, 0)?.0;
    let seen: Vec<bool> = seen.iter().map(|&y| y > 0.0).collect();
    Ok(Mask::around(&seen, resolution as usize))
}

impl Mask {
    /// These pixels.
    #[cfg(test)]
    pub fn of(hidden: Vec<bool>) -> Self {
        Self { hidden }
    }

    fn around(seen: &[bool], width: usize) -> Self {
        let height = seen.len() / width;
        let near = |i: usize| {
            let (x, y) = (i % width, i / width);
            (y.saturating_sub(1)..(y + 2).min(height))
                .any(|v| (x.saturating_sub(1)..(x + 2).min(width)).any(|u| seen[v * width + u]))
        };
        Self { hidden: (0..seen.len()).map(near).collect() }
    }

    /// Whether the headline leaves the pixel out.
    pub fn hides(&self, pixel: usize) -> bool {
        self.hidden[pixel]
    }
}
