//! Equiangular samples along a segment, and how its light is divided between them and flights.

use super::Walk;
use crate::{
    equiangular::{self, Division, Segment},
    medium::Inside,
    observer::PathObserver,
    settings::Equiangular,
};
use tyndall_transport::sampler::PathSampler;

impl<'s, const N: usize> Walk<'s, N> {
    /// A sample of the equiangular technique; returns the segment for the free flight's weights.
    #[inline(always)]
    pub(super) fn equiangular(
        &mut self,
        inside: &Inside<'s, N>,
        t_max: f32,
        sampler: &mut PathSampler,
        seen: &mut impl PathObserver<N>,
    ) -> Option<Segment> {
        if self.depth >= self.settings.max_depth {
            return None;
        }
        if self.is_deep(self.depth) {
            return None;
        }
        let mut segment = Segment::new(self.scene, self.settings, &self.ray, t_max, inside)?;
        let division = self.division(inside, self.depth);
        if self.company > 0 {
            division?;
            segment = segment.always();
        }
        let at = equiangular::Origin {
            medium: self.medium,
            inside,
            weight: &self.weight,
            lamp: self.lamp,
            order: self.depth + 1,
            time: self.ray.time,
            anew: self.anew,
            division,
        };
        let value = equiangular::sample(self.scene, self.settings, &segment, &at, self.w, sampler);
        self.l += self.counted(at.order, value, seen);
        if self.company > 0 { None } else { Some(segment) }
    }

    /// Whether equiangular samples are left out of a segment behind so many scatterings.
    #[inline(always)]
    fn is_deep(&self, scatterings: u32) -> bool {
        self.settings.equiangular == Equiangular::Auto && scatterings > self.settings.equiangular_depth
    }

    /// How the light of a segment behind so many scatterings is divided, if it is.
    #[inline(always)]
    pub(super) fn division(&self, inside: &Inside<'s, N>, scatterings: u32) -> Option<Division> {
        if self.company == 0 || self.is_deep(scatterings) {
            return None;
        }
        Division::new(self.scene, self.settings, inside, self.company)
    }
}
