//! Scattering: light sampling, the next direction, roulette.

use super::{MediumSite, SurfaceSite, Walk, site::Scatters};
use crate::{
    direct::{Arrival, Scatterer},
    observer::PathObserver,
    shadow::Place,
    steer::mixed,
};
use std::cell::Cell;
use tyndall_base::{Vec3, warp};
use tyndall_scatter::bsdf::BsdfFlags;
use tyndall_spectral::{Spectrum, Wavelengths};
use tyndall_transport::{MediumId, sampler::PathSampler};

/// Whom a scattering sends light to: the path alone, `()`, or several that come from different directions.
pub(crate) trait Audience<const N: usize> {
    /// `(f |cos|, density)` \[1/sr\] of going on towards `wi`, per lane; `alone` gives those of the path alone.
    fn eval(
        &self,
        at: &impl Scatters<N>,
        wi: Vec3,
        alone: impl FnOnce() -> (Spectrum<N>, Spectrum<N>),
        w: &Wavelengths<N>,
    ) -> (Spectrum<N>, Spectrum<N>);

    /// The path goes on towards `wi`.
    fn drawn(&mut self, wi: Vec3);

    /// Light sampling brought `value` from `wi`; returns what of it belongs to the path.
    fn lit(&mut self, wi: Vec3, value: Spectrum<N>) -> Spectrum<N>;
}

impl<const N: usize> Audience<N> for () {
    #[inline(always)]
    fn eval(
        &self,
        _: &impl Scatters<N>,
        _: Vec3,
        alone: impl FnOnce() -> (Spectrum<N>, Spectrum<N>),
        _: &Wavelengths<N>,
    ) -> (Spectrum<N>, Spectrum<N>) {
        alone()
    }

    #[inline(always)]
    fn drawn(&mut self, _: Vec3) {}

    #[inline(always)]
    fn lit(&mut self, _: Vec3, value: Spectrum<N>) -> Spectrum<N> {
        value
    }
}

impl<'s, const N: usize> Walk<'s, N> {
    /// Scatters in a medium; false when the path ends.
    #[inline(always)]
    pub(crate) fn scatter_medium(
        &mut self,
        at: &MediumSite<'s, N>,
        audience: &mut impl Audience<N>,
        sampler: &mut PathSampler,
        seen: &mut impl PathObserver<N>,
    ) -> bool {
        if self.settings.light_sampling {
            let towards = Cell::new(Vec3::ZERO);
            let vertex = Scatterer {
                p: at.p,
                n: Vec3::ZERO,
                half: Vec3::ZERO,
                spawn: |_| (at.p, at.medium),
                eval: |wi| {
                    towards.set(wi);
                    audience.eval(at, wi, || at.eval(wi, self.w), self.w)
                },
                rival: self.rival,
                division: self.divided,
                surface: None,
                known: Place { medium: at.medium, inside: Some(&at.inside), time: self.ray.time },
            };
            let value = self.direct(&vertex, sampler, seen);
            self.l += audience.lit(towards.get(), value);
        }
        let u = sampler.next_2d();
        let mut u = [u.x, u.y];
        let (wi, phase) = if let Some(wi) = at.steering.and_then(|s| s.sample(&mut u)) {
            (wi, at.inside.phase.eval(at.wo, wi, self.w))
        } else {
            let s = at.inside.phase.sample(at.wo, u, self.w);
            (s.wi, s.p)
        };
        audience.drawn(wi);
        let alone = || (phase, mixed(at.steering.as_ref(), phase, wi));
        let (phase, pdf) = audience.eval(at, wi, alone, self.w);
        if !self.weight.scatter(phase, pdf, false) {
            return false;
        }
        self.turn(at.p, wi);
        self.survives(sampler)
    }

    /// Scatters at a surface; false when the path ends.
    #[inline(always)]
    pub(crate) fn scatter_surface(
        &mut self,
        at: &SurfaceSite<'s, N>,
        audience: &mut impl Audience<N>,
        sampler: &mut PathSampler,
        seen: &mut impl PathObserver<N>,
    ) -> bool {
        if self.settings.light_sampling && !at.bsdf.is_delta() {
            let towards = Cell::new(Vec3::ZERO);
            let vertex = Scatterer {
                p: at.isect.surface.p,
                n: at.isect.surface.ng,
                half: at.half(),
                spawn: |wi| at.spawn(wi),
                eval: |wi| {
                    towards.set(wi);
                    audience.eval(at, wi, || at.eval(wi), self.w)
                },
                rival: None,
                division: None,
                surface: Some(&at.isect.surface),
                known: Place { medium: at.medium, inside: at.inside.as_ref(), time: self.ray.time },
            };
            let few =
                if self.depth == 1 && self.settings.each_light { self.scene.lights.few() } else { None };
            let value = match few {
                None => self.direct(&vertex, sampler, seen),
                Some(lights) => {
                    let value = vertex.each(&self.arrival(), lights, sampler);
                    self.each = lights.1;
                    self.counted(self.depth, value, seen)
                }
            };
            self.l += audience.lit(towards.get(), value);
        }
        let uc = sampler.next_1d();
        let u = sampler.next_2d();
        let mut u = [u.x, u.y];
        let wi;
        if let Some(towards) = at.steering.and_then(|s| s.sample(&mut u)) {
            wi = towards;
            self.scattered_widely = true;
            audience.drawn(wi);
            let (f, pdf) = audience.eval(at, wi, || at.eval(wi), self.w);
            if !self.weight.scatter(f, pdf, false) {
                return false;
            }
        } else {
            let Some(s) = at.bsdf.sample(at.wo, uc, u) else { return false };
            wi = at.frame.from_local(s.wi);
            let delta = s.flags.contains(BsdfFlags::DELTA);
            self.scattered_widely |= !delta;
            audience.drawn(wi);
            let alone = || (s.f * s.wi.z.abs(), mixed(at.steering.as_ref(), s.pdf, wi));
            let (f, pdf) = audience.eval(at, wi, alone, self.w);
            if !self.weight.scatter(f, pdf, delta) {
                return false;
            }
            self.eta_scale *= s.eta * s.eta;
        }
        self.go(&at.isect, wi);
        self.survives(sampler)
    }

    /// The path as light sampling knows it.
    #[inline(always)]
    fn arrival(&self) -> Arrival<'_, N> {
        Arrival { scene: self.scene, settings: self.settings, weight: &self.weight, w: self.w }
    }

    /// What light sampling brings at a vertex.
    #[inline(always)]
    pub(super) fn direct<S, F>(
        &mut self,
        vertex: &Scatterer<'_, '_, S, F, N>,
        sampler: &mut PathSampler,
        seen: &mut impl PathObserver<N>,
    ) -> Spectrum<N>
    where
        S: Fn(Vec3) -> (Vec3, MediumId),
        F: Fn(Vec3) -> (Spectrum<N>, Spectrum<N>),
    {
        let value = vertex.sample(&self.arrival(), sampler);
        self.counted(self.depth, value, seen)
    }

    /// Russian roulette on the throughput the lanes agree on, and the next flight.
    #[inline(always)]
    pub(super) fn survives(&mut self, sampler: &mut PathSampler) -> bool {
        self.flight = warp::sample_exponential(sampler.next_1d(), 1.0);
        self.drawn = self.flight;
        if self.depth <= self.settings.roulette_depth {
            return true;
        }
        let q = self.weight.throughput().max_lane() * self.eta_scale / self.settings.roulette_threshold;
        if q >= 1.0 {
            return true;
        }
        if sampler.next_1d() >= q {
            return false;
        }
        self.weight.survive(q);
        true
    }
}
