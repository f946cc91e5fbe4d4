//! Samples of pixels: film position, wavelengths, camera ray, integrator, film response.

use crate::{
    analog,
    isa::{Isa, Set},
    layers::{Layers, Recorder},
    learn::learn,
    observer::PathObserver,
    opaw::{self, AllWavelengths},
    refine::Refinement,
    reuse::{Grouping, Level},
    settings::{Guiding, Settings},
    swc, volpath, wang_chern,
    weight::PathWeight,
};
use std::{cell::OnceCell, sync::Arc};
use tyndall_base::{Vec2, vec::vec2};
use tyndall_film::{Channels, Guide, Pass, Patch, PixelFilter, WorkUnit};
use tyndall_geometry::Ray;
use tyndall_spectral::{Spectrum, WavelengthSampler, Wavelengths};
use tyndall_transport::{Scene, camera::CameraSample, guiding::Field, sampler::PathSampler};

/// The path integrator to run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// [`crate::volpath`].
    #[default]
    Volpath,
    /// [`crate::analog`].
    Analog,
    /// [`crate::wang_chern`].
    WangChern,
}

impl Method {
    /// True for integrators whose paths carry one wavelength and no more.
    pub const fn is_single(self) -> bool {
        matches!(self, Self::Analog | Self::WangChern)
    }
}

/// Wavelengths a path carries.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Lanes {
    /// One path, one wavelength.
    One,
    /// Four.
    Four,
    /// Eight.
    #[default]
    Eight,
    /// Sixteen.
    Sixteen,
}

impl Lanes {
    /// The number of lanes.
    pub const fn count(self) -> u32 {
        match self {
            Self::One => 1,
            Self::Four => 4,
            Self::Eight => 8,
            Self::Sixteen => 16,
        }
    }

    /// The lanes for `n` wavelengths; `None` for a number that is not compiled.
    pub const fn from_count(n: u32) -> Option<Self> {
        match n {
            1 => Some(Self::One),
            4 => Some(Self::Four),
            8 => Some(Self::Eight),
            16 => Some(Self::Sixteen),
            _ => None,
        }
    }
}

/// How the wavelengths of a path share its decisions.
#[derive(Clone, Debug, Default)]
pub enum Sharing {
    /// The hero decides; spectral multiple importance sampling, or a single wavelength.
    #[default]
    Hero,
    /// Until they part: [`crate::swc`].
    Clusters,
    /// Means decide: [`crate::opaw`]. The wavelengths are those of the set, whatever the sampler draws.
    Means(Arc<AllWavelengths>),
}

impl Sharing {
    /// Lanes for a path of means over `count` wavelengths: all of them, or groups of 16.
    pub const fn lanes_for(count: usize) -> Lanes {
        match count {
            0..=4 => Lanes::Four,
            5..=8 => Lanes::Eight,
            _ => Lanes::Sixteen,
        }
    }
}

/// Everything that turns (pixel, sample) into numbers on the film.
#[derive(Clone, Debug)]
pub struct PixelPass {
    /// The scene.
    pub scene: Arc<Scene>,
    /// The integrator.
    pub method: Method,
    /// Its switches.
    pub settings: Settings,
    /// Wavelengths a path carries.
    pub lanes: Lanes,
    /// How they share its decisions.
    pub sharing: Sharing,
    /// How they are drawn.
    pub wavelengths: WavelengthSampler,
    /// The film's response curves.
    pub channels: Channels,
    /// Reconstruction filter, sampled.
    pub filter: PixelFilter,
    /// Layers beside the image.
    pub layers: Layers,
    /// Pixels of the whole image, of which the film may be a part.
    pub resolution: [u32; 2],
    /// The job's seed.
    pub seed: u64,
    /// Independent nets that a pixel's samples are dealt to.
    pub replicates: u32,
    /// Instructions to use: the bits are the same, as a test shows.
    pub isa: Isa,
    /// How pixels share paths, where that pays; known once the pass has learned.
    pub grouping: Option<Grouping>,
    /// What light they have in common; known then, too.
    pub level: Level,
    /// Which pixels take the lowest orders of light from more paths; known then, too.
    pub refinement: Refinement,
}

/// A sample on its way: where it started and what it draws from.
pub(crate) struct Start<const N: usize> {
    pub(crate) ray: Ray,
    /// What unit radiance along the ray gives the pixel.
    pub(crate) exposure: f32,
    weight: f32,
    pub(crate) first_distance: f32,
    /// Light of fewer scatterings comes from other paths.
    from: u32,
    pub(crate) w: Wavelengths<N>,
    pub(crate) sampler: PathSampler,
}

/// The same before its wavelengths are known.
pub(crate) struct Begin {
    pub(crate) ray: Ray,
    pub(crate) exposure: f32,
    pub(crate) filter: f32,
    /// Numbers for the wavelengths and the first distance.
    pub(crate) spectrum: Vec2,
    pub(crate) sampler: PathSampler,
}

impl<const N: usize> Start<N> {
    /// Radiance along the ray becomes the pixel's value.
    #[inline(always)]
    fn expose(&self, values: &mut [f32]) {
        if self.exposure != 1.0 {
            values.iter_mut().for_each(|v| *v *= self.exposure);
        }
    }
}

impl Pass for PixelPass {
    fn render(&self, unit: &WorkUnit, guide: &Guide, out: &mut Patch) {
        match (self.method, self.lanes) {
            (Method::Analog, _) | (_, Lanes::One) => self.dispatch::<1>(unit, guide, out),
            (_, Lanes::Four) => self.dispatch::<4>(unit, guide, out),
            (_, Lanes::Eight) => self.dispatch::<8>(unit, guide, out),
            (_, Lanes::Sixteen) => self.dispatch::<16>(unit, guide, out),
        }
    }
}

impl PixelPass {
    /// Where light comes from, for images of `resolution`; `None` where the settings do not ask for it or there is nothing
    /// to learn (see [`crate::learn`]).
    pub fn learned(&self, resolution: [u32; 2]) -> Option<Field> {
        // a shared path meets more light than a steered one, for less: measured, without media both together cost more than
        // they bring; in a mist steering keeps rare beams from being met by chance
        let surfaces = self.scene.media.is_empty();
        let spared = self.settings.guiding == Guiding::Auto && surfaces && self.shares_paths();
        let steers = self.is_led_by_hero() && !spared;
        let learn = || learn(&self.scene, &self.settings, &self.wavelengths, &self.channels, resolution);
        if steers { learn() } else { None }
    }

    /// Whether it is `volpath` with a hero, which alone shares paths, learns and refines pixels.
    pub(crate) fn is_led_by_hero(&self) -> bool {
        self.method == Method::Volpath && matches!(self.sharing, Sharing::Hero)
    }

    /// The pass with what it can learn: how paths are shared, and where light comes from.
    ///
    /// # Panics
    /// When the scene has another owner, too.
    #[must_use]
    pub fn learning(mut self, resolution: [u32; 2]) -> Self {
        let pilot = OnceCell::new();
        let pilot = || *pilot.get_or_init(|| self.pilot());
        let (grouping, refinement) = (self.choose_grouping(pilot), self.choose_refinement(pilot));
        (self.grouping, self.refinement) = (grouping, refinement);
        self.level = self.find_level();
        let field = self.learned(resolution);
        Arc::get_mut(&mut self.scene).expect("the pass alone has the scene").guiding = field;
        self
    }

    /// Every version runs the same operations; layers have the portable one alone.
    fn dispatch<const N: usize>(&self, unit: &WorkUnit, guide: &Guide, out: &mut Patch) {
        if !self.layers.is_empty() {
            return self.run_layered::<N>(unit, guide, out);
        }
        match self.isa.set() {
            Set::Portable => self.run::<N>(unit, guide, out),
            // SAFETY: a value of `Isa` exists only where the processor has its instructions.
            #[cfg(target_arch = "x86_64")]
            Set::Avx2 => unsafe { self.run_avx2::<N>(unit, guide, out) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            Set::Avx512 => unsafe { self.run_avx512::<N>(unit, guide, out) },
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt,avx512f,avx512vl,avx512dq,avx512bw,avx512cd")]
    fn run_avx512<const N: usize>(&self, unit: &WorkUnit, guide: &Guide, out: &mut Patch) {
        self.run::<N>(unit, guide, out);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
    fn run_avx2<const N: usize>(&self, unit: &WorkUnit, guide: &Guide, out: &mut Patch) {
        self.run::<N>(unit, guide, out);
    }

    #[inline(always)]
    fn run<const N: usize>(&self, unit: &WorkUnit, guide: &Guide, out: &mut Patch) {
        if self.shares_paths() {
            return self.run_shared::<N>(unit, guide, out);
        }
        let mut values = vec![0.0; self.channels.len()];
        for (x, y) in unit.window.pixels() {
            for sample in guide.samples_for(x, y, &unit.samples) {
                out.mark(x, y, sample);
                let weight = match &self.sharing {
                    Sharing::Means(all) => self.all_wavelengths::<N>(all, x, y, sample, &mut values),
                    _ => {
                        let mut start = self.start::<N>(x, y, sample);
                        let extra = self.refinement.of(x, y);
                        start.from = extra.from;
                        let l = self.li(&mut start, &mut ());
                        self.channels.respond(&l, &start.w, &mut values);
                        start.expose(&mut values);
                        if extra.paths > 0 {
                            self.add_low_orders::<N>((x, y), sample, extra, &mut values);
                        }
                        start.weight
                    }
                };
                out.add_sample(x, y, sample, weight, &values);
            }
        }
    }

    /// One path of means: the set in groups of N, all from the same random numbers. Returns the filter's weight.
    #[inline(always)]
    fn all_wavelengths<const N: usize>(
        &self,
        all: &AllWavelengths,
        x: u32,
        y: u32,
        sample: u32,
        values: &mut [f32],
    ) -> f32 {
        // responses are means over N lanes, the pixel's value is the mean over the set
        let share = N as f32 / all.set().lambda().len() as f32;
        let mut part = vec![0.0; values.len()];
        let mut weight = 0.0;
        values.fill(0.0);
        for g in 0..all.set().groups::<N>() {
            let mut start = self.start::<N>(x, y, sample);
            start.w = all.set().group(g);
            let l = self.li(&mut start, &mut ());
            self.channels.respond(&l, &start.w, &mut part);
            start.expose(&mut part);
            values.iter_mut().zip(&part).for_each(|(v, p)| *v += share * p);
            weight = start.weight;
        }
        weight
    }

    /// The same with layers: orders of scattering and AOVs behind the image's channels.
    fn run_layered<const N: usize>(&self, unit: &WorkUnit, guide: &Guide, out: &mut Patch) {
        let image = self.channels.len();
        let mut values = vec![0.0; image + self.layers.channels(image)];
        for (x, y) in unit.window.pixels() {
            for sample in guide.samples_for(x, y, &unit.samples) {
                out.mark(x, y, sample);
                let mut start = self.start::<N>(x, y, sample);
                let ray = start.ray;
                let mut seen = Recorder::new(&self.layers);
                let l = self.li(&mut start, &mut seen);
                let (main, layers) = values.split_at_mut(image);
                let response = self.channels.prepare(&start.w);
                self.channels.respond_prepared(&l, &response, main);
                self.layers.write(&self.scene, &ray, &start.w, &self.channels, &seen, layers);
                start.expose(main);
                start.expose(&mut layers[..image * self.layers.orders.len()]);
                out.add_sample(x, y, sample, start.weight, &values);
            }
        }
    }

    /// The path of one sample, watched.
    pub fn watch<const N: usize>(
        &self,
        x: u32,
        y: u32,
        sample: u32,
        seen: &mut impl PathObserver<N>,
    ) -> (Wavelengths<N>, Spectrum<N>) {
        let mut start = self.start::<N>(x, y, sample);
        let l = self.li(&mut start, seen);
        (start.w, l * start.exposure)
    }

    #[inline(always)]
    pub(crate) fn start<const N: usize>(&self, x: u32, y: u32, sample: u32) -> Start<N> {
        let sampler = self.sampler(x, y, sample);
        let begin = self.begin(x, y, sampler, None);
        let w = match &self.sharing {
            Sharing::Means(all) => all.set().group::<N>(0),
            _ => self.wavelengths_of::<N>(&begin),
        };
        let Begin { ray, exposure, filter, spectrum, sampler } = begin;
        Start { ray, exposure, weight: filter, first_distance: spectrum.y, from: 0, w, sampler }
    }

    /// The numbers that a sample draws.
    #[inline(always)]
    pub(crate) fn sampler(&self, x: u32, y: u32, sample: u32) -> PathSampler {
        PathSampler::new(self.settings.sampler, self.seed, x, y, sample, self.replicates)
    }

    /// The wavelengths of a path that begins so.
    #[inline(always)]
    pub(crate) fn wavelengths_of<const N: usize>(&self, begin: &Begin) -> Wavelengths<N> {
        self.wavelengths.sample::<N>(begin.spectrum.x)
    }

    /// The camera ray of a sample of pixel (`x`, `y`), at `time` or at one of its own.
    #[inline(always)]
    pub(crate) fn begin(&self, x: u32, y: u32, mut sampler: PathSampler, time: Option<f32>) -> Begin {
        let u_film = sampler.next_2d();
        let spectrum = sampler.next_2d();
        let lens = sampler.next_2d();
        let own = sampler.next_1d();
        let time = time.unwrap_or(own);
        let filter = self.filter.sample([u_film.x, u_film.y]);
        let film = vec2(x as f32 + 0.5 + filter.offset[0], y as f32 + 0.5 + filter.offset[1]);
        let (ray, exposure) = self.scene.camera.sample(&CameraSample { film, lens, time });
        Begin { ray, exposure, filter: filter.weight, spectrum, sampler }
    }

    #[inline(always)]
    fn li<const N: usize>(&self, start: &mut Start<N>, seen: &mut impl PathObserver<N>) -> Spectrum<N> {
        let Start { ray, first_distance, from, w, sampler, .. } = start;
        if start.exposure == 0.0 {
            return Spectrum::ZERO;
        }
        let (scene, settings, first) = (&*self.scene, &self.settings, *first_distance);
        match (&self.sharing, self.method) {
            (Sharing::Clusters, _) => return swc::li(scene, settings, *ray, first, w, sampler, seen),
            (Sharing::Means(all), _) => return opaw::li(scene, settings, all, *ray, first, w, sampler, seen),
            (_, Method::Analog) => return analog::li(scene, settings.max_depth, *ray, w, sampler, seen),
            (_, Method::WangChern) => return wang_chern::li(scene, settings, *ray, w, sampler, seen),
            (_, Method::Volpath) => {}
        }
        let begin = (PathWeight::START, scene.camera_medium, *from);
        volpath::li_from(scene, settings, begin, *ray, first, w, sampler, seen)
    }
}
