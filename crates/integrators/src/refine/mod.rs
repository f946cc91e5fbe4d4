//! More paths for the lowest orders of light in the few pixels where those vary most: at the rim of a lamp that the camera
//! sees, around a point of light in a medium, before a medium that is a light, and where a rough mirror shows a lamp.
//!
//! A sample of such a pixel takes its light of `from` and more scatterings from the path that all pixels have, and that of
//! fewer, which is short work, from `paths` paths of its own:
//!
//! ```text
//! L = sum_(n >= from) L_n(path)  +  1 / paths  sum_j  sum_(n < from) L_n(path_j)
//! ```
//!
//! The mean is the same whichever pixels are chosen. Which they are is decided before the first sample.

mod choose;
mod highlights;

use crate::{pilot::Orders, pixel::PixelPass, settings::Settings};
use tyndall_film::Weights;
use tyndall_transport::sampler::PathSampler;

/// Tells the numbers of these paths from those of the others.
const STREAM: u64 = 0x7269_6d73 << 32;

/// What a pixel takes from paths of its own.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Extra {
    /// Light of fewer scatterings than this.
    pub from: u32,
    /// How many paths a sample sends for it.
    pub paths: u32,
}

/// The pixels that take some light from paths of their own.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Refinement {
    /// By row and column.
    pixels: Vec<([u32; 2], Extra)>,
}

impl Refinement {
    /// What pixel (`x`, `y`) takes from paths of its own: nothing, for nearly all.
    #[inline]
    pub fn of(&self, x: u32, y: u32) -> Extra {
        if self.pixels.is_empty() {
            return Extra::default();
        }
        let found = self.pixels.binary_search_by_key(&[y, x], |(at, _)| *at);
        found.map_or(Extra::default(), |i| self.pixels[i].1)
    }

    /// Pixels and what they take, row by row.
    pub fn iter(&self) -> impl Iterator<Item = ((u32, u32), Extra)> {
        self.pixels.iter().map(|&([y, x], extra)| ((x, y), extra))
    }
}

impl PixelPass {
    /// Whether pixels may take light from paths of their own.
    pub(crate) fn may_refine(&self) -> bool {
        self.settings.refine
            && self.is_led_by_hero()
            && self.layers.is_empty()
            && self.filter.weights() == Weights::Unit
    }

    /// Adds to `values` what sample `sample` of pixel (`x`, `y`) takes from paths of its own.
    #[inline(never)]
    pub(crate) fn add_low_orders<const N: usize>(
        &self,
        (x, y): (u32, u32),
        sample: u32,
        extra: Extra,
        values: &mut [f32],
    ) {
        let settings = Settings { max_depth: extra.from - 1, ..self.settings.clone() };
        let mut part = vec![0.0; values.len()];
        // numbers of a net of their own, and the replicate of the sample
        let replicates = self.replicates.max(1);
        let (row, replicate) = (sample / replicates, sample % replicates);
        for j in 0..extra.paths {
            let index = (row * extra.paths + j) * replicates + replicate;
            let sampler =
                PathSampler::new(self.settings.sampler, self.seed ^ STREAM, x, y, index, self.replicates);
            let mut begin = self.begin(x, y, sampler, None);
            let w = self.wavelengths_of::<N>(&begin);
            let l = self.alone(&settings, &mut begin, &w, &mut Orders::none());
            self.channels.respond(&l, &w, &mut part);
            values.iter_mut().zip(&part).for_each(|(v, p)| *v += p / extra.paths as f32);
        }
    }
}
