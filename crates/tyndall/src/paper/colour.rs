//! What a strategy gets wrong in colour: CIEDE2000 over blocks of pixels, where noise no longer counts.

use super::{figure6::white, shots::Taken};
use tyndall_base::hash::mix64;
use tyndall_spectral::colour::{ColourSpace, SpaceName, delta_e_2000, lab};

/// Side of the blocks \[pixels\].
pub const BLOCK: usize = 8;

/// Draws per block from which the share of noise is found.
const DRAWS: u32 = 16;

/// Colour differences between two pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// Mean over the blocks.
    pub mean: f64,
    /// 95th percentile.
    pub high: f64,
    /// The greatest.
    pub worst: f64,
    /// The mean that the standard errors of both pictures would make of no difference at all.
    pub noise: f64,
}

/// CIEDE2000 of two pictures, with the white of the second as white; blocks brighter than white show the lamp and are
/// left out.
pub fn difference(a: &Taken, b: &Taken) -> Difference {
    let (side, white) = (b.shot.side as usize, white(&b.rgb));
    let space = ColourSpace::get(SpaceName::Srgb);
    let d65 = space.xyz_from_rgb.apply([1.0; 3]);
    let in_lab = |rgb: [f64; 3]| lab(space.xyz_from_rgb.apply(rgb.map(|v| (v / white).max(0.0))), d65);
    let (mut all, mut noise) = (Vec::new(), Vec::new());
    for by in (0..side).step_by(BLOCK) {
        for bx in (0..side).step_by(BLOCK) {
            let mean = |image: &[[f64; 3]]| block(image, side, bx, by);
            let theirs = mean(&b.rgb);
            if space.xyz_from_rgb.apply(theirs)[1] > white {
                continue;
            }
            all.push(delta_e_2000(in_lab(mean(&a.rgb)), in_lab(theirs)));
            let index = by / BLOCK * side.div_ceil(BLOCK) + bx / BLOCK;
            let (ea, eb) = (a.block_error[index], b.block_error[index]);
            for draw in 0..DRAWS {
                let key = mix64((by * side + bx) as u64) ^ u64::from(draw);
                let moved =
                    std::array::from_fn(|c| theirs[c] + ea[c].hypot(eb[c]) * normal(mix64(key) ^ c as u64));
                noise.push(delta_e_2000(in_lab(moved), in_lab(theirs)));
            }
        }
    }
    all.sort_by(f64::total_cmp);
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len().max(1) as f64;
    let at = |share: f64| all.get((share * all.len() as f64) as usize).or(all.last()).copied().unwrap_or(0.0);
    Difference { mean: mean(&all), high: at(0.95), worst: at(1.0), noise: mean(&noise) }
}

/// About normal: twelve numbers of variance 1/12 less their mean.
fn normal(key: u64) -> f64 {
    let unit = |i: u64| (mix64(key.wrapping_mul(12).wrapping_add(i)) >> 11) as f64 / (1u64 << 53) as f64;
    (0..12).map(unit).sum::<f64>() - 6.0
}

/// Mean over a block.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        Spectral,
        paper::{Effort, Scene, Shot},
    };

    /// Two grey pictures that differ by noise of the told size, and by more than that in half of the blocks.
    #[test]
    fn noise_is_told_apart_from_colour() {
        let hero = Spectral::Hero { wavelengths: 8 };
        let taken = |seed: u64, tint: f64| {
            let shot = Shot::clean("grey", Scene::Fog, Effort::Quick, hero, 1.0);
            let pixels = u64::from(shot.side * shot.side);
            let value = |i: u64, c: u64| 0.5 + 0.05 * normal(seed * 1_000_003 + 3 * i + c);
            let rgb = (0..pixels).map(|i| [value(i, 0) * (1.0 + tint), value(i, 1), value(i, 2)]).collect();
            let blocks = (shot.side as usize).div_ceil(BLOCK).pow(2);
            let (error, block_error) =
                (vec![[0.05; 3]; pixels as usize], vec![[0.05 / BLOCK as f64; 3]; blocks]);
            Taken { shot, rgb, error, block_error, seconds: 1.0 }
        };
        let same = difference(&taken(1, 0.0), &taken(2, 0.0));
        // 64 blocks: a mean of as many differences is known to some 8 %
        assert!((same.mean / same.noise - 1.0).abs() < 0.4, "{same:?}");
        let tinted = difference(&taken(1, 0.1), &taken(2, 0.0));
        assert!(tinted.mean > 3.0 * tinted.noise, "{tinted:?}");
    }
}
