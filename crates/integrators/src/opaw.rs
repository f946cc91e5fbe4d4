//! OPAW, one path all wavelengths: the strategy that Wang and Chern (2001) argue against.
//!
//! A path carries a whole set of wavelengths. Every random decision (distance, event, roulette, direction) is made once,
//! with the mean extinction and the mean albedo of the set, and each wavelength keeps only its own albedo and
//! reflectance as weight. Nothing corrects for `T(lambda_j)` being another than the one that was drawn from, so what
//! the paths compute is the scene with
//!
//! ```text
//! sigma_t(lambda)  replaced by  mean sigma_t,    sigma_s(lambda) / sigma_t(lambda)  kept:
//! ```
//!
//! exact in grey media, biased in chromatic ones by just that. Phase functions and directions at surfaces are those of
//! one wavelength, the middle of the set: dispersion is lost with the rest. The same decisions corrected by `T_j / p` and
//! multiple importance sampling over the wavelengths are `hero`.

use crate::{
    connect::{self, Last, Vertex},
    observer::{self, Event, PathObserver},
    settings::Settings,
};
use std::sync::Arc;
use tyndall_base::{Vec3, warp};
use tyndall_geometry::{Hit, Ray};
use tyndall_scatter::{
    bsdf::{BsdfFlags, BsdfSample},
    phase::PhaseFunction,
};
use tyndall_spectral::{Spectrum, Wavelengths, strategy::FixedSet};
use tyndall_transport::{MediumId, Scene, media::MediumProperties, sampler::PathSampler};

/// Boundaries that a path may cross; more means a cycle of rounding.
const MAX_CROSSINGS: u32 = 10_000;

/// A set of wavelengths and the means over it that decide.
#[derive(Clone, Debug)]
pub struct AllWavelengths {
    set: Arc<FixedSet>,
    media: Vec<Mean>,
    /// The wavelength whose directions the path takes.
    guide: Wavelengths<1>,
}

/// Means over the set in one medium.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Mean {
    /// \[1/m\]
    sigma_t: f32,
    albedo: f32,
}

impl AllWavelengths {
    /// The means of all media of the scene, which must be homogeneous, over `set`.
    pub fn new(scene: &Scene, set: Arc<FixedSet>) -> Self {
        let lambda = set.lambda();
        let at = |l: f32| Wavelengths::continuum([l], [1.0]);
        let count = lambda.len() as f32;
        let media = scene.media.iter().map(|m| {
            let mut mean = Mean::default();
            for &l in lambda {
                let Some(m) = m.homogeneous(&at(l)) else { continue };
                mean.sigma_t += m.sigma_t()[0] / count;
                mean.albedo += m.sigma_s.safe_div(m.sigma_t())[0] / count;
            }
            mean
        });
        Self { media: media.collect(), guide: at(lambda[lambda.len() / 2]), set }
    }

    /// The set.
    pub fn set(&self) -> &FixedSet {
        &self.set
    }

    fn mean(&self, id: MediumId) -> Mean {
        if id.is_vacuum() { Mean::default() } else { self.media[id.index()] }
    }
}

/// Radiance along `ray` at wavelengths `w` of the set; `first` is the random number of the first flight.
#[inline(never)]
pub fn li<const N: usize>(
    scene: &Scene,
    settings: &Settings,
    all: &AllWavelengths,
    ray: Ray,
    first: f32,
    w: &Wavelengths<N>,
    sampler: &mut PathSampler,
    seen: &mut impl PathObserver<N>,
) -> Spectrum<N> {
    let mut path = Path {
        scene,
        settings,
        all,
        w,
        ray,
        from: ray.o,
        medium: scene.camera_medium,
        flight: warp::sample_exponential(first, 1.0),
        beta: Spectrum::ONE,
        mean_beta: 1.0,
        depth: 0,
        crossings: 0,
        last: None,
        l: Spectrum::ZERO,
    };
    while path.step(sampler, seen) {}
    path.l
}

struct Path<'s, const N: usize> {
    scene: &'s Scene,
    settings: &'s Settings,
    all: &'s AllWavelengths,
    w: &'s Wavelengths<N>,
    ray: Ray,
    /// Where the ray took its direction.
    from: Vec3,
    medium: MediumId,
    /// Optical distance to the next collision by the mean extinction.
    flight: f32,
    /// Product of albedos and reflectances per wavelength.
    beta: Spectrum<N>,
    /// The same of the means: what roulette looks at, equal in all groups of a large set.
    mean_beta: f32,
    depth: u32,
    crossings: u32,
    last: Option<Last>,
    l: Spectrum<N>,
}

impl<'s, const N: usize> Path<'s, N> {
    #[inline(always)]
    fn step<O: PathObserver<N>>(&mut self, sampler: &mut PathSampler, seen: &mut O) -> bool {
        let hit = self.scene.intersect(&self.ray);
        let d = hit.as_ref().map_or(f32::INFINITY, |h| h.t);
        if let Some(m) = self.scene.medium(self.medium).and_then(|m| m.homogeneous(self.w)) {
            let sigma_t = self.all.mean(self.medium).sigma_t;
            let tau = if sigma_t > 0.0 { sigma_t * d } else { 0.0 };
            if self.flight < tau {
                let t = self.flight / sigma_t;
                return self.scatter(&m, t, sampler, seen);
            }
            self.flight -= tau;
        }
        match hit {
            Some(hit) => self.surface(&hit, sampler, seen),
            None => {
                let far = self.ray.o + self.ray.d;
                self.watch(Event::Escape, far, Vec3::ZERO, f32::INFINITY, Spectrum::ZERO, seen);
                self.add(connect::sky(self.scene, self.from, self.ray.d, self.last, self.w), seen);
                false
            }
        }
    }

    /// A collision at distance `t`: each wavelength keeps its own albedo.
    #[inline(always)]
    fn scatter<O: PathObserver<N>>(
        &mut self,
        m: &MediumProperties<'s, N>,
        t: f32,
        sampler: &mut PathSampler,
        seen: &mut O,
    ) -> bool {
        let p = self.ray.at(t);
        let albedo = m.sigma_s.safe_div(m.sigma_t());
        self.watch(Event::Medium, p, Vec3::ZERO, t, albedo, seen);
        self.add(m.sigma_a.safe_div(m.sigma_t()) * m.le, seen);
        if self.depth >= self.settings.max_depth {
            return false;
        }
        self.depth += 1;
        sampler.seek_vertex(self.depth - 1);
        self.beta *= albedo;
        self.mean_beta *= self.all.mean(self.medium).albedo;
        let (wo, medium, guide) = (-self.ray.d, self.medium, &self.all.guide);
        if self.settings.light_sampling {
            let phase: &PhaseFunction = m.phase;
            let eval = |wi: Vec3| {
                let p = phase.eval(wo, wi, guide).hero();
                (Spectrum::splat(p), p)
            };
            self.direct(&Vertex { p, time: self.ray.time, spawn: |_| (p, medium), eval }, sampler, seen);
        }
        let u = sampler.next_2d();
        let s = m.phase.sample(wo, [u.x, u.y], guide);
        self.last = self.settings.light_sampling.then_some(Last { p, pdf: s.p.hero() });
        self.from = p;
        self.ray = Ray { time: self.ray.time, ..Ray::new(p, s.wi) };
        self.survives(sampler)
    }

    #[inline(always)]
    fn surface<O: PathObserver<N>>(&mut self, hit: &Hit, sampler: &mut PathSampler, seen: &mut O) -> bool {
        let isect = self.scene.interaction(&self.ray, hit);
        let s = &isect.surface;
        self.add(connect::emitted(self.scene, &self.ray, hit, &isect, self.last, self.w), seen);
        let medium = self.medium;
        if isect.material.is_interface() {
            self.watch(Event::Boundary, s.p, s.ng, hit.t, Spectrum::ONE, seen);
            self.go(s.origin(self.ray.d), self.ray.d, isect.medium_towards(self.ray.d, medium));
            self.crossings += 1;
            return self.crossings <= MAX_CROSSINGS;
        }
        let material = &self.scene.materials[isect.material.index()];
        let (frame, bsdf) = material.shade(s, self.w);
        if O::WANTS_VERTICES {
            self.watch(Event::Surface, s.p, frame.z, hit.t, material.albedo(s, self.w), seen);
        }
        if self.depth >= self.settings.max_depth {
            return false;
        }
        self.depth += 1;
        sampler.seek_vertex(self.depth - 1);
        let (_, guide) = material.shade(s, &self.all.guide);
        let wo = frame.to_local(-self.ray.d);
        if self.settings.light_sampling && !guide.is_delta() {
            let spawn = |wi: Vec3| (s.origin(wi), isect.medium_towards(wi, medium));
            let eval = |wi: Vec3| {
                let wi = frame.to_local(wi);
                (bsdf.eval(wo, wi) * wi.z.abs(), guide.pdf(wo, wi).hero())
            };
            self.direct(&Vertex { p: s.p, time: self.ray.time, spawn, eval }, sampler, seen);
        }
        let uc = sampler.next_1d();
        let u = sampler.next_2d();
        let u = [u.x, u.y];
        let Some(b) = guide.sample(wo, uc, u) else { return false };
        let delta = b.flags.contains(BsdfFlags::DELTA);
        let f = if delta {
            self.delta(&b, |w| material.shade(s, w).1.sample(wo, uc, u))
        } else {
            bsdf.eval(wo, b.wi)
        };
        let cos_over_pdf = b.wi.z.abs() / b.pdf.hero();
        self.beta *= f * cos_over_pdf;
        self.mean_beta *= b.f.hero() * cos_over_pdf * b.eta * b.eta;
        let sampled = self.settings.light_sampling && !delta;
        self.last = sampled.then_some(Last { p: s.p, pdf: b.pdf.hero() });
        let wi = frame.from_local(b.wi);
        self.go(s.origin(wi), wi, isect.medium_towards(wi, medium));
        self.survives(sampler)
    }

    /// Reflectances of all wavelengths for the mirror direction `b` that the guide takes. A sample tells those of lanes
    /// beside its hero, so the guide stands in for one lane, and for that lane in another.
    #[inline(never)]
    fn delta(
        &self,
        b: &BsdfSample<1>,
        sample: impl Fn(&Wavelengths<N>) -> Option<BsdfSample<N>>,
    ) -> Spectrum<N> {
        let led = |replaced: usize| {
            let mut w = *self.w;
            (w.lambda[replaced], w.lambda[0]) = (w.lambda[0], self.all.guide.lambda[0]);
            sample(&w)
        };
        let f = |s: Option<BsdfSample<N>>, lane: usize| match s {
            // where dispersion parts a lane from the guide, it goes along all the same
            Some(s) if s.pdf[lane] > 0.0 => s.f[lane],
            _ => b.f.hero(),
        };
        let (others, first) = (led(0), led(N - 1));
        Spectrum::from_fn(|k| if k == 0 { f(first, N - 1) } else { f(others, k) })
    }

    #[inline(always)]
    fn direct<O: PathObserver<N>, S, F>(
        &mut self,
        vertex: &Vertex<S, F>,
        sampler: &mut PathSampler,
        seen: &mut O,
    ) where
        S: Fn(Vec3) -> (Vec3, MediumId),
        F: Fn(Vec3) -> (Spectrum<N>, f32),
    {
        let sigma_t = |id| Spectrum::splat(self.all.mean(id).sigma_t);
        let value = vertex.sample(self.scene, sigma_t, self.w, sampler);
        self.add(value, seen);
    }

    #[inline(always)]
    fn add<O: PathObserver<N>>(&mut self, l: Spectrum<N>, seen: &mut O) {
        let value = self.beta * l;
        seen.contribution(self.depth, &value);
        self.l += value;
    }

    #[inline(always)]
    fn go(&mut self, o: Vec3, d: Vec3, medium: MediumId) {
        if d != self.ray.d {
            self.from = o;
        }
        self.ray = Ray { time: self.ray.time, ..Ray::new(o, d) };
        self.medium = medium;
    }

    /// Roulette on the mean weight, and the next flight.
    #[inline(always)]
    fn survives(&mut self, sampler: &mut PathSampler) -> bool {
        self.flight = warp::sample_exponential(sampler.next_1d(), 1.0);
        if self.depth <= self.settings.roulette_depth {
            return !self.beta.is_zero();
        }
        // a wavelength may weigh more than the mean: a floor keeps its weight in bounds
        let q = (self.mean_beta / self.settings.roulette_threshold).max(0.05);
        if q >= 1.0 {
            return !self.beta.is_zero();
        }
        self.beta *= 1.0 / q;
        self.mean_beta /= q;
        sampler.next_1d() < q && !self.beta.is_zero()
    }

    #[inline(always)]
    fn watch<O: PathObserver<N>>(
        &self,
        event: Event,
        p: Vec3,
        n: Vec3,
        distance: f32,
        albedo: Spectrum<N>,
        seen: &mut O,
    ) {
        if O::WANTS_VERTICES {
            let (depth, medium, throughput) = (self.depth, self.medium, self.beta);
            seen.vertex(&observer::Vertex { event, p, n, distance, depth, medium, albedo, throughput });
        }
    }
}
