//! Which pixels take light from paths of their own, and from how many.
//!
//! Candidates are the pixels onto which lamps, points of light and media that are lights are projected, and those of [`highlights`](super::highlights). A few paths each tell how much the lowest
//! orders vary there; what varies by less than the rest of the picture stays as it is.

use super::{Extra, Refinement};
use crate::{
    pilot::{Orders, Pilot},
    pixel::PixelPass,
    settings::Settings,
};
use std::collections::BTreeMap;
use tyndall_base::Vec3;
use tyndall_transport::{
    light::Light,
    sampler::{PathSampler, SamplerKind},
};

/// The stream of numbers of the paths that measure, the same for all seeds.
pub(super) const SEED: u64 = 0x7269_6d73;
/// Paths that measure, all pixels of lamps together, and as many for all with highlights, at least; they are short.
const PATHS: u64 = 16_384;
/// And this many times fewer than there are pixels, where that is more; but no more than this.
const PIXELS_PER_PATH: u64 = 8;
const MOST_PATHS: u64 = 1 << 20;
/// Paths for one pixel, at least and at most.
const FEW: u64 = 4;
const MANY: u64 = 256;
/// And for one with a highlight.
const SOME: u64 = 8;
/// Lights beyond this number are not looked at.
const LIGHTS: usize = 4096;
/// Pixels may be looked at this many times, where lamps overlap.
const OVERLAP: u64 = 4;
/// Variance of one path of an ordinary pixel, over the square of the picture's mean: measured, 0.01 to 0.3.
const USUAL: f32 = 0.1;
/// Most paths for one sample.
const MOST: u32 = 1024;
/// All of them together are this many times fewer than the pixels, at least; a path for light that is scattered once counts
/// for three.
const SHARE: u64 = 2;
/// Pixels around that of a point of light.
const AROUND: f32 = 1.0;

impl PixelPass {
    /// The pixels that take light from paths of their own: a pure function of scene, settings and wavelengths.
    pub(crate) fn choose_refinement(&self, pilot: impl FnOnce() -> Pilot) -> Refinement {
        if !self.may_refine() {
            return Refinement::default();
        }
        let pixels = u64::from(self.resolution[0]) * u64::from(self.resolution[1]);
        let (room, budget) = (pixels / SHARE, (pixels / PIXELS_PER_PATH).clamp(PATHS, MOST_PATHS));
        let rims = self.candidates(room.min(budget / FEW));
        if rims.is_empty() && !self.may_have_highlights() {
            return Refinement::default();
        }
        let pilot = pilot();
        let highlights = self.highlights(room.min(budget / SOME), &pilot);
        let each = (budget / (rims.len() as u64).max(1)).min(MANY) as u32;
        let mut candidates: BTreeMap<_, _> =
            highlights.into_iter().map(|at| (at, (2, SOME as u32))).collect();
        for (at, from) in rims {
            // a pixel may be both
            let entry = candidates.entry(at).or_insert((from, each));
            *entry = (entry.0.max(from), entry.1.max(each));
        }
        let usual = USUAL * pilot.scattered.powi(2);
        let varying = candidates.into_iter().filter_map(|(at, (from, each))| {
            let variance = self.variance(at, from, each);
            // the least variance for the work: in proportion to the root of variance over cost
            let n = (variance / (usual * cost_of(from) as f32)).sqrt();
            (n >= 2.0).then(|| (at, from, n.min(MOST as f32)))
        });
        let varying: Vec<_> = varying.collect();
        // as many as there is room for
        let cost = |shift: u32| -> u64 {
            let costs = varying.iter().map(|&(_, from, n)| match paths(n, shift) {
                0 | 1 => 0,
                n => u64::from(cost_of(from)) * u64::from(n),
            });
            costs.sum()
        };
        let shift = (0..=MOST.ilog2()).find(|&shift| cost(shift) <= room).unwrap_or(u32::MAX);
        let chosen = varying.iter().map(|&(at, from, n)| (at, Extra { from, paths: paths(n, shift) }));
        Refinement { pixels: chosen.filter(|(_, extra)| extra.paths > 1).collect() }
    }

    /// Pixels, by row and column, onto which something bright is projected, and the orders of light that vary there: up to
    /// `most`, or none.
    fn candidates(&self, most: u64) -> BTreeMap<[u32; 2], u32> {
        let (mut found, mut seen) = (BTreeMap::new(), 0);
        let scene = &*self.scene;
        let deep = self.settings.max_depth >= 1 && !scene.media.is_empty();
        let [rx, ry] = self.filter.radius();
        for light in scene.lights.iter().take(LIGHTS) {
            let (from, margin) = match light {
                Light::Area(_) => (1, 0.0),
                // its points are drawn along the ray, and those behind shine through it
                Light::Volume(_) => (1 + u32::from(deep), 0.0),
                _ if deep && light.has_place() && light.is_delta() => (2, AROUND),
                _ => continue,
            };
            let Some(bounds) = light.bounds(&scene.accel) else { continue };
            let Some([low, high]) = self.projected(bounds.lo, bounds.hi) else { continue };
            let range = |k: usize, radius: f32| {
                let last = self.resolution[k] as f32 - 1.0;
                // the pixels whose filters reach there
                let first = (low[k] - radius - margin - 0.5).ceil().max(0.0);
                let end = (high[k] + radius + margin - 0.5).floor().min(last);
                (first <= end).then_some(first as u32..=end as u32)
            };
            let (Some(columns), Some(rows)) = (range(0, rx), range(1, ry)) else { continue };
            let count =
                u64::from(columns.end() - columns.start() + 1) * u64::from(rows.end() - rows.start() + 1);
            if count > most {
                continue;
            }
            seen += count;
            if seen > OVERLAP * most {
                return BTreeMap::new();
            }
            for y in rows {
                for x in columns.clone() {
                    let entry = found.entry([y, x]).or_insert(from);
                    *entry = (*entry).max(from);
                }
            }
        }
        if found.len() as u64 > most { BTreeMap::new() } else { found }
    }

    /// The rectangle of the film that a box is projected into; `None` where a corner lies behind the camera.
    fn projected(&self, lo: Vec3, hi: Vec3) -> Option<[[f32; 2]; 2]> {
        let (mut low, mut high) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]);
        for corner in 0..8 {
            let pick = |bit: u32, lo: f32, hi: f32| if corner >> bit & 1 == 0 { lo } else { hi };
            let p = Vec3 { x: pick(0, lo.x, hi.x), y: pick(1, lo.y, hi.y), z: pick(2, lo.z, hi.z) };
            let film = self.scene.camera.project(p)?;
            for (k, f) in [film.x, film.y].into_iter().enumerate() {
                low[k] = low[k].min(f);
                high[k] = high[k].max(f);
            }
        }
        Some([low, high])
    }

    /// Variance, from `n` paths, of the light of fewer than `from` scatterings, at wavelengths that are the same for all.
    fn variance(&self, [y, x]: [u32; 2], from: u32, n: u32) -> f32 {
        let settings = Settings { max_depth: from - 1, ..self.settings.clone() };
        let (mut sum, mut squares) = (0.0, 0.0);
        for index in 0..n {
            let sampler = PathSampler::new(SamplerKind::OwenSobol, SEED, x, y, index, 1);
            let mut begin = self.begin(x, y, sampler, None);
            let w = self.wavelengths_of::<8>(&begin);
            let l = self.alone(&settings, &mut begin, &w, &mut Orders::none());
            let l = f64::from(self.brightness(&l, &w));
            if l.is_finite() {
                sum += l;
                squares += l * l;
            }
        }
        let n = f64::from(n);
        ((squares - sum * sum / n) / (n - 1.0)) as f32
    }
}

/// What a path for light of fewer than `from` scatterings costs.
fn cost_of(from: u32) -> u32 {
    2 * from - 1
}

/// A power of two not above `n`, halved `shift` times; at least one.
fn paths(n: f32, shift: u32) -> u32 {
    let whole = n.max(1.0) as u32;
    (1 << whole.ilog2()) >> shift.min(31)
}
