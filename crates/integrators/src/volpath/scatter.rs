//! Scattering: light sampling, the next direction, roulette.

use super::{MediumSite, SurfaceSite, Walk};
use crate::{
    direct::{self, Scatterer},
    observer::PathObserver,
    shadow::Place,
    steer::mixed,
};
use std::cell::Cell;
use tyndall_base::{Vec3, warp};
use tyndall_scatter::bsdf::BsdfFlags;
use tyndall_spectral::{Spectrum, Wavelengths};
use tyndall_transport::{MediumId, sampler::PathSampler};

/// Whom a scattering in a medium sends light to: the path alone, `()`, or several that come from different directions.
pub(crate) trait Audience<const N: usize> {
    /// `(phase function, density)` \[1/sr\] of going on towards `wi`, per lane.
    fn eval(&self, at: &MediumSite<'_, N>, wi: Vec3, w: &Wavelengths<N>) -> (Spectrum<N>, Spectrum<N>);

    /// The same where `wi` was drawn for the path alone, with its phase function known.
    fn drawn(
        &mut self,
        at: &MediumSite<'_, N>,
        wi: Vec3,
        phase: Spectrum<N>,
        w: &Wavelengths<N>,
    ) -> (Spectrum<N>, Spectrum<N>);

    /// Light sampling brought `value` from `wi`; returns what of it belongs to the path.
    fn lit(&mut self, wi: Vec3, value: Spectrum<N>) -> Spectrum<N>;
}

impl<const N: usize> Audience<N> for () {
    #[inline(always)]
    fn eval(&self, at: &MediumSite<'_, N>, wi: Vec3, w: &Wavelengths<N>) -> (Spectrum<N>, Spectrum<N>) {
        at.eval(wi, w)
    }

    #[inline(always)]
    fn drawn(
        &mut self,
        at: &MediumSite<'_, N>,
        wi: Vec3,
        phase: Spectrum<N>,
        _: &Wavelengths<N>,
    ) -> (Spectrum<N>, Spectrum<N>) {
        (phase, mixed(at.steering.as_ref(), phase, wi))
    }

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
                spawn: |_| (at.p, at.medium),
                eval: |wi| {
                    towards.set(wi);
                    audience.eval(at, wi, self.w)
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
        let (phase, pdf) = audience.drawn(at, wi, phase, self.w);
        if !self.weight.scatter(phase, pdf, false) {
            return false;
        }
        self.turn(at.p, wi);
        self.survives(sampler)
    }

    /// Scatters at a surface; false when the path ends.
    #[inline(always)]
    pub(super) fn scatter_surface(
        &mut self,
        at: &SurfaceSite<'s, N>,
        sampler: &mut PathSampler,
        seen: &mut impl PathObserver<N>,
    ) -> bool {
        if self.settings.light_sampling && !at.bsdf.is_delta() {
            let vertex = Scatterer {
                p: at.isect.surface.p,
                n: at.isect.surface.ng,
                spawn: |wi| at.spawn(wi),
                eval: |wi| at.eval(wi),
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
                    let (scene, settings) = (self.scene, self.settings);
                    let value = direct::each(scene, settings, &vertex, lights, &self.weight, self.w, sampler);
                    self.each = lights.1;
                    self.counted(self.depth, value, seen)
                }
            };
            self.l += value;
        }
        let uc = sampler.next_1d();
        let u = sampler.next_2d();
        let mut u = [u.x, u.y];
        let wi;
        if let Some(towards) = at.steering.and_then(|s| s.sample(&mut u)) {
            wi = towards;
            self.scattered_widely = true;
            let (f, pdf) = at.eval(wi);
            if !self.weight.scatter(f, pdf, false) {
                return false;
            }
        } else {
            let Some(s) = at.bsdf.sample(at.wo, uc, u) else { return false };
            wi = at.frame.from_local(s.wi);
            let delta = s.flags.contains(BsdfFlags::DELTA);
            self.scattered_widely |= !delta;
            let pdf = mixed(at.steering.as_ref(), s.pdf, wi);
            if !self.weight.scatter(s.f * s.wi.z.abs(), pdf, delta) {
                return false;
            }
            self.eta_scale *= s.eta * s.eta;
        }
        self.go(&at.isect, wi);
        self.survives(sampler)
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
        let value = direct::sample(self.scene, self.settings, vertex, &self.weight, self.w, sampler);
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
