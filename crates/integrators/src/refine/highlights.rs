//! Pixels in which a rough mirror shows a lamp: what they get depends on where in the pixel and where on the lamp it is taken.

use super::choose::SEED;
use crate::{
    pilot::{Orders, Pilot},
    pixel::PixelPass,
    settings::Settings,
};
use tyndall_geometry::Ray;
use tyndall_scatter::bsdf::BsdfFlags;
use tyndall_spectral::Wavelengths;
use tyndall_transport::{
    material::Material,
    sampler::{PathSampler, SamplerKind},
};

/// Squares of pixels are looked at by one ray each, this many at most.
const LOOKS: u64 = 1 << 16;

impl PixelPass {
    /// Pixels of squares in which a surface reflects about as a mirror does, and light comes of it that is brighter than the
    /// picture's mean: the brightest first, up to `most`.
    pub(super) fn highlights(&self, most: u64, pilot: &Pilot) -> Vec<[u32; 2]> {
        let [columns, rows] = self.resolution;
        if !self.may_have_highlights() {
            return Vec::new();
        }
        let side = (1..).find(|&s| squares(columns, s) * squares(rows, s) <= LOOKS).unwrap_or(u32::MAX);
        let settings = Settings { max_depth: 1, ..self.settings.clone() };
        let mut bright = Vec::new();
        for y in (0..rows).step_by(side as usize) {
            for x in (0..columns).step_by(side as usize) {
                let centre = |from: u32, end: u32| (from + side / 2).min(end - 1);
                let (cx, cy) = (centre(x, columns), centre(y, rows));
                let sampler = PathSampler::new(SamplerKind::OwenSobol, SEED, cx, cy, 0, 1);
                let mut begin = self.begin(cx, cy, sampler, None);
                let w = self.wavelengths_of::<8>(&begin);
                if !self.is_glossy(&begin.ray, &w) {
                    continue;
                }
                let l = self.alone(&settings, &mut begin, &w, &mut Orders::none());
                let l = self.brightness(&l, &w);
                if l > pilot.scattered && l.is_finite() {
                    bright.push((l, [y, x]));
                }
            }
        }
        bright.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        bright.truncate((most / (u64::from(side) * u64::from(side))) as usize);
        let pixels = bright.iter().flat_map(|&(_, [y, x])| {
            let range = move |from: u32, end: u32| from..(from + side).min(end);
            range(y, rows).flat_map(move |y| range(x, columns).map(move |x| [y, x]))
        });
        pixels.collect()
    }

    /// Whether anything in the scene could have one.
    pub(super) fn may_have_highlights(&self) -> bool {
        self.settings.max_depth >= 1 && !self.scene.materials.iter().all(Material::is_matte)
    }

    /// Whether the surface that `ray` meets spreads reflected light, but not evenly.
    fn is_glossy(&self, ray: &Ray, w: &Wavelengths<8>) -> bool {
        let scene = &*self.scene;
        let Some(hit) = scene.intersect_noting(ray).0 else { return false };
        let isect = scene.interaction(ray, &hit);
        if isect.material.is_interface() {
            return false;
        }
        let flags = scene.materials[isect.material.index()].shade(&isect.surface, w).1.flags();
        flags.contains(BsdfFlags::GLOSSY)
    }
}

fn squares(length: u32, side: u32) -> u64 {
    u64::from(length.div_ceil(side))
}
