//! The part of the walk that lies in media that vary in space.

use super::{MediumSite, Site, Step, Walk};
use crate::{
    direct::Scatterer,
    ember::Ember,
    observer::{Event, PathObserver},
    shadow::Place,
    steer::{Steering, mixed},
    tracking::{Collision, Flight, Traveller, fly},
};
use tyndall_base::Vec3;
use tyndall_spectral::Spectrum;
use tyndall_transport::{media::Heterogeneous, sampler::PathSampler};

impl<'s, const N: usize> Walk<'s, N> {
    /// Crosses `medium` up to `t_max`; `None` when the path got through, else what that led to.
    #[inline(always)]
    pub(super) fn travel(
        &mut self,
        medium: &'s Heterogeneous,
        t_max: f32,
        sampler: &mut PathSampler,
        seen: &mut impl PathObserver<N>,
    ) -> Option<Step<'s, N>> {
        let mut emitted = Spectrum::ZERO;
        let by_light = self.settings.light_sampling && !self.weight.r_l.is_zero();
        let ember =
            if by_light { Ember::of(self.scene, self.medium, self.previous, self.facing) } else { None };
        let traveller = Traveller {
            ray: self.ray,
            known: self.inside.and_then(|inside| inside.of_density_one()),
            t_max,
            w: self.w,
            settings: self.settings,
            flight: &mut self.flight,
            weight: &mut self.weight,
            pilot: self.pilot,
            emitted: &mut emitted,
            ember,
            rng: sampler.stream(),
        };
        let flight = fly(medium, traveller);
        if !emitted.is_zero() {
            self.l += self.counted(self.depth, emitted, seen);
        }
        match flight {
            Flight::Through => None,
            Flight::Ended => Some(Step::End),
            Flight::Scattered(collision) => {
                if !self.arrive(&collision, sampler, seen) {
                    return Some(Step::End);
                }
                if self.open
                    && let Some(inside) = self.inside
                {
                    let (p, medium) = (self.previous, self.medium);
                    let steering =
                        Steering::in_mixture((self.scene, self.settings), p, &collision.scattering, self.w);
                    let wo = -self.ray.d;
                    return Some(Step::Site(Site::Medium(MediumSite { p, wo, medium, inside, steering })));
                }
                let goes_on = self.scatter_varying(&collision, sampler, seen);
                Some(if goes_on { Step::On } else { Step::End })
            }
        }
    }

    /// At a scattering whose flight is in the weight already; false where the path ends.
    #[inline(always)]
    fn arrive(
        &mut self,
        collision: &Collision<'s, N>,
        sampler: &mut PathSampler,
        seen: &mut impl PathObserver<N>,
    ) -> bool {
        let p = self.ray.at(collision.t);
        self.watch(Event::Medium, p, Vec3::ZERO, collision.t, collision.albedo, seen);
        if self.depth >= self.settings.max_depth {
            return false;
        }
        self.depth += 1;
        sampler.seek_vertex(self.depth - 1);
        self.weight.r_e = Spectrum::ZERO;
        self.rival = None;
        self.divided = None;
        self.at(p, Vec3::ZERO);
        self.scattered_widely = true;
        true
    }

    /// Scatters there; false when the path ends.
    #[inline(always)]
    fn scatter_varying(
        &mut self,
        collision: &Collision<'s, N>,
        sampler: &mut PathSampler,
        seen: &mut impl PathObserver<N>,
    ) -> bool {
        let p = self.previous;
        let wo = -self.ray.d;
        let scattering = &collision.scattering;
        let steering = Steering::in_mixture((self.scene, self.settings), p, scattering, self.w);
        if self.settings.light_sampling {
            let (medium, inside) = (self.medium, self.inside);
            let vertex = Scatterer {
                p,
                n: Vec3::ZERO,
                half: Vec3::ZERO,
                spawn: |_| (p, medium),
                eval: |wi| {
                    let phase = scattering.eval(wo, wi, self.w);
                    (phase, mixed(steering.as_ref(), phase, wi))
                },
                rival: None,
                division: None,
                surface: None,
                known: Place { medium, inside: inside.as_ref(), time: self.ray.time },
            };
            let value = self.direct(&vertex, sampler, seen);
            self.l += value;
        }
        let uc = sampler.next_1d();
        let u = sampler.next_2d();
        let mut u = [u.x, u.y];
        let (wi, phase) = if let Some(wi) = steering.and_then(|s| s.sample(&mut u)) {
            (wi, scattering.eval(wo, wi, self.w))
        } else {
            let Some(s) = scattering.sample(wo, uc, u, self.w) else { return false };
            (s.wi, s.p)
        };
        if !self.weight.scatter(phase, mixed(steering.as_ref(), phase, wi), false) {
            return false;
        }
        self.turn(p, wi);
        self.survives(sampler)
    }
}
