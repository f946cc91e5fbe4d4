//! A few paths that tell what kind of picture it will be.

use crate::{
    observer::{PathObserver, Vertex},
    pixel::{Begin, PixelPass},
    settings::Settings,
    volpath,
};
use tyndall_base::sobol;
use tyndall_spectral::{Spectrum, Wavelengths};
use tyndall_transport::sampler::{PathSampler, SamplerKind};

/// Paths of the pilot.
const PATHS: u32 = 512;
/// Their stream of numbers, apart from those of all pixels and the same for all seeds.
const SEED: u64 = 0x0070_696c_6f74;
/// A path counts for this many times the mean at most, so that few bright ones do not decide alone.
const MOST: f32 = 8.0;

/// What they tell: a pure function of scene, settings, wavelengths and the size of the image.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pilot {
    /// Mean of the light that was scattered, over the image; see [`PixelPass::brightness`].
    pub scattered: f32,
    /// The part of it that was scattered more than once.
    pub again: f32,
}

impl PixelPass {
    /// Sends the pilot's paths.
    pub(crate) fn pilot(&self) -> Pilot {
        let mut light = Vec::with_capacity(PATHS as usize);
        for index in 0..PATHS {
            let at = sobol::sobol_2d(index, SEED as u32);
            let pixel = |k: usize| (at[k] * self.resolution[k] as f32) as u32;
            let sampler = PathSampler::new(SamplerKind::OwenSobol, SEED, pixel(0), pixel(1), index, 1);
            let mut begin = self.begin(pixel(0), pixel(1), sampler, None);
            let w = self.wavelengths_of::<8>(&begin);
            let mut seen = Orders::none();
            self.alone(&self.settings, &mut begin, &w, &mut seen);
            light.push([seen.once, seen.again].map(|l| self.brightness(&l, &w)));
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
        Pilot { scattered: total / PATHS as f32, again: if total > 0.0 { part / total } else { 0.0 } }
    }

    /// The path that begins so, by itself and with these settings; for paths that are few: it is compiled once, without wide
    /// registers. The same bits.
    #[inline(never)]
    pub(crate) fn alone<const N: usize>(
        &self,
        settings: &Settings,
        begin: &mut Begin,
        w: &Wavelengths<N>,
        seen: &mut Orders<N>,
    ) -> Spectrum<N> {
        if begin.exposure == 0.0 {
            return Spectrum::ZERO;
        }
        let Begin { ray, spectrum, sampler, exposure, .. } = begin;
        volpath::li(&self.scene, settings, *ray, spectrum.y, w, sampler, seen) * *exposure
    }

    /// One number for a spectrum: the sum of the magnitudes of what the film's channels make of it.
    pub(crate) fn brightness<const N: usize>(&self, l: &Spectrum<N>, w: &Wavelengths<N>) -> f32 {
        let mut response = vec![0.0; self.channels.len()];
        self.channels.respond(l, w, &mut response);
        response.iter().map(|r| r.abs()).sum()
    }
}

/// Light by the number of its scatterings.
pub(crate) struct Orders<const N: usize> {
    pub once: Spectrum<N>,
    pub again: Spectrum<N>,
}

impl<const N: usize> Orders<N> {
    pub const fn none() -> Self {
        Self { once: Spectrum::ZERO, again: Spectrum::ZERO }
    }
}

impl<const N: usize> PathObserver<N> for Orders<N> {
    const WANTS_VERTICES: bool = false;

    fn contribution(&mut self, order: u32, value: &Spectrum<N>) {
        match order {
            0 => {}
            1 => self.once += *value,
            _ => self.again += *value,
        }
    }

    fn vertex(&mut self, _: &Vertex<N>) {}
}
