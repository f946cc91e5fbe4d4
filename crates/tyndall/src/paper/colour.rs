//! What a strategy gets wrong in colour: CIEDE2000 over blocks of pixels, where noise no longer counts.

use super::{figure6::white, shots::Taken};
use tyndall_spectral::colour::{ColourSpace, SpaceName, delta_e_2000, lab};

/// Side of the blocks \[pixels\].
pub const BLOCK: usize = 8;

/// Colour differences between two pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// Mean over the blocks.
    pub mean: f64,
    /// 95th percentile.
    pub high: f64,
    /// The greatest.
    pub worst: f64,
}

/// CIEDE2000 of two pictures, with the white of the second as white; blocks brighter than white show the lamp and are
/// left out.
pub fn difference(a: &Taken, b: &Taken) -> Difference {
    let (side, white) = (b.shot.side as usize, white(&b.rgb));
    let space = ColourSpace::get(SpaceName::Srgb);
    let d65 = space.xyz_from_rgb.apply([1.0; 3]);
    let mut all: Vec<f64> = Vec::new();
    for by in (0..side).step_by(BLOCK) {
        for bx in (0..side).step_by(BLOCK) {
            let xyz = |image: &[[f64; 3]]| {
                let sum = block(image, side, bx, by);
                space.xyz_from_rgb.apply(sum.map(|v| (v / white).max(0.0)))
            };
            let (ours, theirs) = (xyz(&a.rgb), xyz(&b.rgb));
            if theirs[1] <= 1.0 {
                all.push(delta_e_2000(lab(ours, d65), lab(theirs, d65)));
            }
        }
    }
    all.sort_by(f64::total_cmp);
    let mean = all.iter().sum::<f64>() / all.len().max(1) as f64;
    let at = |share: f64| all.get((share * all.len() as f64) as usize).or(all.last()).copied().unwrap_or(0.0);
    Difference { mean, high: at(0.95), worst: at(1.0) }
}

fn block(image: &[[f64; 3]], side: usize, bx: usize, by: usize) -> [f64; 3] {
    let (mut sum, mut count) = ([0.0; 3], 0.0);
    for y in by..(by + BLOCK).min(side) {
        for rgb in &image[y * side + bx..y * side + (bx + BLOCK).min(side)] {
            (0..3).for_each(|c| sum[c] += rgb[c]);
            count += 1.0;
        }
    }
    sum.map(|v| v / count)
}
