//! `wang-chern`: the algorithm of C.-M. Wang and J.-R. Chern, *Spectral rendering of global illumination models with
//! presence of participating media*, 2001. Equation numbers are those of the paper.
//!
//! An eye path carries one wavelength (OPOW, one path one wavelength), drawn uniformly from a fixed set or from the
//! continuum. At every ray a random choice (eq. 8, after Rushmeier) takes either the surface at its end or a point in the
//! medium; the point is drawn from the truncated exponential, the direction from the isotropic phase function (eq. 10),
//! and the albedo is the only weight. Light is met by chance: importance sampling of lights is future work in the
//! paper, and here the switch `light_sampling`, off unless asked for.
//!
//! Beyond the paper: media emit (the term of eq. 1 and 2 that its algorithm leaves out); media with another phase
//! function than eq. 10 draw from that, so that no scene is rendered as another one; surfaces reflect by any BSDF; and
//! Russian roulette ends paths, which the paper does not tell how to end. Media must be homogeneous: eq. 8 and 9 need the
//! optical depth in closed form.

use crate::{
    connect::{self, Last, Vertex, extinction},
    observer::{self, Event, PathObserver},
    settings::Settings,
};
use tyndall_base::{Vec3, math::exp, warp};
use tyndall_geometry::{Hit, Ray};
use tyndall_scatter::bsdf::BsdfFlags;
use tyndall_spectral::{Spectrum, Wavelengths};
use tyndall_transport::{MediumId, Scene, media::MediumProperties, sampler::PathSampler};

/// First dimension after a boundary; choices behind it have no place among those of a vertex.
const CROSSING: u32 = 1 << 24;
/// Boundaries that a path may cross; more means a cycle of rounding.
const MAX_CROSSINGS: u32 = 10_000;

/// Radiance along `ray` at the hero's wavelength; other lanes are zero.
#[inline(never)]
pub fn li<const N: usize>(
    scene: &Scene,
    settings: &Settings,
    ray: Ray,
    w: &Wavelengths<N>,
    sampler: &mut PathSampler,
    seen: &mut impl PathObserver<N>,
) -> Spectrum<N> {
    let medium = scene.camera_medium;
    let mut path = Path {
        scene,
        settings,
        w,
        ray,
        from: ray.o,
        medium,
        beta: 1.0,
        depth: 0,
        crossings: 0,
        eta: 1.0,
        last: None,
        l: 0.0,
    };
    while path.step(sampler, seen) {}
    hero(path.l)
}

/// A value of the hero.
#[inline(always)]
fn hero<const N: usize>(value: f32) -> Spectrum<N> {
    Spectrum::from_fn(|k| if k == 0 { value } else { 0.0 })
}

/// An eye path.
struct Path<'s, const N: usize> {
    scene: &'s Scene,
    settings: &'s Settings,
    w: &'s Wavelengths<N>,
    ray: Ray,
    /// Where the ray took its direction.
    from: Vec3,
    medium: MediumId,
    /// Product of albedos and reflectances.
    beta: f32,
    depth: u32,
    crossings: u32,
    /// Squared relative index of refraction along the path: undoes the compression of radiance in roulette.
    eta: f32,
    /// Where a light sample was taken.
    last: Option<Last>,
    l: f32,
}

impl<'s, const N: usize> Path<'s, N> {
    /// One ray: `L = tau S + M` (eq. 1), of which one term is taken.
    #[inline(always)]
    fn step<O: PathObserver<N>>(&mut self, sampler: &mut PathSampler, seen: &mut O) -> bool {
        let hit = self.scene.intersect(&self.ray);
        let d = hit.as_ref().map_or(f32::INFINITY, |h| h.t);
        if let Some(m) = self.scene.medium(self.medium).and_then(|m| m.homogeneous(self.w)) {
            let sigma_t = m.sigma_t().hero(); // eq. 2: absorption and out-scattering
            // eq. 3 and 9: tau = exp(-sigma_t d); no extinction is no collision, over any way
            let tau = if sigma_t > 0.0 { exp(-sigma_t * d) } else { 1.0 };
            // eq. 8: with xi <= tau the surface term S, else the medium term M / (1 - tau)
            let xi = sampler.next_1d();
            if xi >= tau {
                let t = warp::sample_truncated_exponential(sampler.next_1d(), sigma_t, d);
                return self.medium_term(&m, t, sampler, seen);
            }
        }
        match hit {
            Some(hit) => self.surface_term(&hit, sampler, seen),
            None => {
                let far = self.ray.o + self.ray.d;
                self.watch(Event::Escape, far, Vec3::ZERO, f32::INFINITY, 0.0, seen);
                self.add(connect::sky(self.scene, self.from, self.ray.d, self.last, self.w).hero(), seen);
                false
            }
        }
    }

    /// `M / (1 - tau)`: `sigma_t tau(t)` over the density of t is 1 - tau, which cancels the choice's, and what remains is
    /// the albedo.
    #[inline(always)]
    fn medium_term<O: PathObserver<N>>(
        &mut self,
        m: &MediumProperties<'s, N>,
        t: f32,
        sampler: &mut PathSampler,
        seen: &mut O,
    ) -> bool {
        let p = self.ray.at(t);
        let albedo = m.sigma_s.hero() / m.sigma_t().hero();
        self.watch(Event::Medium, p, Vec3::ZERO, t, albedo, seen);
        // eq. 1 and 2, emission of the medium: sigma_a Le over sigma_t
        self.add((1.0 - albedo) * m.le.hero(), seen);
        if self.depth >= self.settings.max_depth {
            return false;
        }
        self.depth += 1;
        sampler.seek_vertex(self.depth - 1);
        self.beta *= albedo;
        let (wo, medium) = (-self.ray.d, self.medium);
        if self.settings.light_sampling {
            let eval = |wi: Vec3| {
                let phase = m.phase.eval(wo, wi, self.w);
                (phase, phase.hero())
            };
            self.direct(&Vertex { p, time: self.ray.time, spawn: |_| (p, medium), eval }, sampler, seen);
        }
        // eq. 10: the phase function is its own density
        let u = sampler.next_2d();
        let s = m.phase.sample(wo, [u.x, u.y], self.w);
        self.last = self.settings.light_sampling.then_some(Last { p, pdf: s.p.hero() });
        self.from = p;
        self.ray = Ray { time: self.ray.time, ..Ray::new(p, s.wi) };
        self.survives(sampler)
    }

    /// S: emission and reflection of the surface.
    #[inline(always)]
    fn surface_term<O: PathObserver<N>>(
        &mut self,
        hit: &Hit,
        sampler: &mut PathSampler,
        seen: &mut O,
    ) -> bool {
        let isect = self.scene.interaction(&self.ray, hit);
        let s = &isect.surface;
        self.add(connect::emitted(self.scene, &self.ray, hit, &isect, self.last, self.w).hero(), seen);
        if isect.material.is_interface() {
            self.watch(Event::Boundary, s.p, s.ng, hit.t, 1.0, seen);
            self.go(s.origin(self.ray.d), self.ray.d, isect.medium_towards(self.ray.d, self.medium));
            self.crossings += 1;
            sampler.seek(CROSSING + 2 * self.crossings);
            return self.crossings <= MAX_CROSSINGS;
        }
        let material = &self.scene.materials[isect.material.index()];
        let (frame, bsdf) = material.shade(s, self.w);
        if O::WANTS_VERTICES {
            self.watch(Event::Surface, s.p, frame.z, hit.t, material.albedo(s, self.w).hero(), seen);
        }
        if self.depth >= self.settings.max_depth {
            return false;
        }
        self.depth += 1;
        sampler.seek_vertex(self.depth - 1);
        let wo = frame.to_local(-self.ray.d);
        let medium = self.medium;
        if self.settings.light_sampling && !bsdf.is_delta() {
            let spawn = |wi: Vec3| (s.origin(wi), isect.medium_towards(wi, medium));
            let eval = |wi: Vec3| {
                let wi = frame.to_local(wi);
                (bsdf.eval(wo, wi) * wi.z.abs(), bsdf.pdf(wo, wi).hero())
            };
            self.direct(&Vertex { p: s.p, time: self.ray.time, spawn, eval }, sampler, seen);
        }
        let uc = sampler.next_1d();
        let u = sampler.next_2d();
        let Some(b) = bsdf.sample(wo, uc, [u.x, u.y]) else { return false };
        self.beta *= b.f.hero() * b.wi.z.abs() / b.pdf.hero();
        self.eta *= b.eta * b.eta;
        let sampled = self.settings.light_sampling && !b.flags.contains(BsdfFlags::DELTA);
        self.last = sampled.then_some(Last { p: s.p, pdf: b.pdf.hero() });
        let wi = frame.from_local(b.wi);
        self.go(s.origin(wi), wi, isect.medium_towards(wi, self.medium));
        self.survives(sampler)
    }

    /// One light sample: what the paper leaves to the future.
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
        let value = vertex.sample(self.scene, |id| extinction(self.scene, id, self.w), self.w, sampler);
        self.add(value.hero(), seen);
    }

    /// The path's weight times `l` goes to the pixel (eq. 4 and 11 follow on the film).
    #[inline(always)]
    fn add<O: PathObserver<N>>(&mut self, l: f32, seen: &mut O) {
        let value = self.beta * l;
        seen.contribution(self.depth, &hero(value));
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

    /// Russian roulette on the path's weight.
    #[inline(always)]
    fn survives(&mut self, sampler: &mut PathSampler) -> bool {
        if self.beta <= 0.0 || self.depth <= self.settings.roulette_depth {
            return self.beta > 0.0;
        }
        let q = self.beta * self.eta / self.settings.roulette_threshold;
        if q >= 1.0 {
            return true;
        }
        self.beta /= q;
        sampler.next_1d() < q
    }

    #[inline(always)]
    fn watch<O: PathObserver<N>>(
        &self,
        event: Event,
        p: Vec3,
        n: Vec3,
        distance: f32,
        albedo: f32,
        seen: &mut O,
    ) {
        if O::WANTS_VERTICES {
            let (depth, medium) = (self.depth, self.medium);
            let (albedo, throughput) = (Spectrum::splat(albedo), hero(self.beta));
            seen.vertex(&observer::Vertex { event, p, n, distance, depth, medium, albedo, throughput });
        }
    }
}
