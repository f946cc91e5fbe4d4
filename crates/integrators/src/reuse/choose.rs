//! Whether sharing pays, and among how many: a few paths tell how much of the light is scattered more than once.

use super::{Grouping, MANY, SOME};
use crate::{
    observer::{PathObserver, Vertex},
    pixel::{Begin, PixelPass},
    volpath,
};
use tyndall_base::sobol;
use tyndall_spectral::Spectrum;
use tyndall_transport::sampler::{PathSampler, SamplerKind};

/// Paths of the pilot.
const PATHS: u32 = 512;
/// Their stream of numbers, apart from those of all pixels and the same for all seeds.
const SEED: u64 = 0x0070_696c_6f74;
/// A path counts for this many times the mean at most, so that few bright ones do not decide alone.
const MOST: f32 = 8.0;

impl PixelPass {
    /// How paths are shared, if that pays: a pure function of scene, settings and wavelengths.
    pub(crate) fn choose_grouping(&self) -> Option<Grouping> {
        if !self.may_share_paths() {
            return None;
        }
        match self.scattered_again() {
            share if share < SOME => None,
            share => Some(Grouping::new(self.resolution, share >= MANY)),
        }
    }

    /// The part of the light that was scattered more than once.
    fn scattered_again(&self) -> f32 {
        let mut light = Vec::with_capacity(PATHS as usize);
        let mut response = vec![0.0; self.channels.len()];
        for index in 0..PATHS {
            let at = sobol::sobol_2d(index, SEED as u32);
            let pixel = |k: usize| (at[k] * self.resolution[k] as f32) as u32;
            let sampler = PathSampler::new(SamplerKind::OwenSobol, SEED, pixel(0), pixel(1), index, 1);
            let Begin { ray, exposure, spectrum, mut sampler, .. } =
                self.begin(pixel(0), pixel(1), sampler, None);
            if exposure == 0.0 {
                continue;
            }
            let w = self.wavelengths.sample::<8>(spectrum.x);
            let mut seen = Orders { once: Spectrum::ZERO, again: Spectrum::ZERO };
            let (scene, settings) = (&*self.scene, &self.settings);
            volpath::li(scene, settings, ray, spectrum.y, &w, &mut sampler, &mut seen);
            light.push([seen.once, seen.again].map(|l| {
                self.channels.respond(&l, &w, &mut response);
                response.iter().map(|r| r.abs()).sum::<f32>()
            }));
        }
        let most = MOST * light.iter().map(|[once, again]| once + again).sum::<f32>() / PATHS as f32;
        let (mut total, mut part) = (0.0, 0.0);
        for [once, again] in light {
            let all = once + again;
            if all > 0.0 && all.is_finite() {
                let counts = all.min(most);
                total += counts;
                part += counts * again / all;
            }
        }
        if total > 0.0 { part / total } else { 0.0 }
    }
}

/// Light by the number of its scatterings.
struct Orders {
    once: Spectrum<8>,
    again: Spectrum<8>,
}

impl PathObserver<8> for Orders {
    const WANTS_VERTICES: bool = false;

    fn contribution(&mut self, order: u32, value: &Spectrum<8>) {
        match order {
            0 => {}
            1 => self.once += *value,
            _ => self.again += *value,
        }
    }

    fn vertex(&mut self, _: &Vertex<8>) {}
}
