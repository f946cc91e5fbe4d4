//! Pixels that see a lamp, and their neighbours.

use crate::{measure::picture, scenes::BenchScene};
use tyndall::{Options, Source, plan};

/// A picture of yes and no.
pub struct Mask {
    width: usize,
    hidden: Vec<bool>,
}

/// The mask of a scene: light that reaches a pixel without scattering, in any of 256 samples, dilated by one pixel.
pub fn lamp(scene: &BenchScene, resolution: u32) -> Result<Mask, String> {
    let options = Options {
        spp: Some(256),
        resolution: Some([resolution; 2]),
        max_depth: Some(0),
        ..Options::default()
    };
    let plan = plan(Source::File(&scene.path()), &options).map_err(|e| e.to_string())?;
    let seen = picture(&plan, 0)?.0;
    Ok(Mask::around(&seen.iter().map(|&y| y > 0.0).collect::<Vec<_>>(), resolution as usize))
}

impl Mask {
    fn around(seen: &[bool], width: usize) -> Self {
        let height = seen.len() / width;
        let near = |i: usize| {
            let (x, y) = (i % width, i / width);
            (y.saturating_sub(1)..(y + 2).min(height))
                .any(|v| (x.saturating_sub(1)..(x + 2).min(width)).any(|u| seen[v * width + u]))
        };
        Self { width, hidden: (0..seen.len()).map(near).collect() }
    }

    /// Whether the headline leaves the pixel out.
    pub fn hides(&self, pixel: usize) -> bool {
        self.hidden[pixel]
    }

    /// Plain PBM, for other programs.
    pub fn to_pbm(&self) -> String {
        let rows = self.hidden.chunks(self.width);
        let line = |row: &[bool]| row.iter().map(|&h| if h { "1 " } else { "0 " }).collect::<String>();
        let body: Vec<String> = rows.map(line).collect();
        format!("P1\n{} {}\n{}\n", self.width, self.hidden.len() / self.width, body.join("\n"))
    }
}
