//! Light sampling at a vertex, combined with chance hits and with equiangular sampling.

use crate::{
    equiangular::{Division, Segment},
    medium::Inside,
    settings::Settings,
    shadow::{End, Place, Shadow, shadow},
    weight::{PathWeight, combine},
};
use tyndall_base::Vec3;
use tyndall_geometry::SurfacePoint;
use tyndall_spectral::{Spectrum, Wavelengths};
use tyndall_transport::{
    LightId, MediumId, Scene,
    light::{Light, Selected, Target},
    sampler::PathSampler,
};

/// The equiangular technique that could have made a medium vertex, kept until the path scatters again.
#[derive(Clone, Copy, Debug)]
pub struct Rival {
    /// The segment on which the vertex lies.
    pub segment: Segment,
    /// Distance of the vertex on it.
    pub t: f32,
}

impl Rival {
    /// Density of the technique at the vertex and `target`; see [`Segment::density`].
    #[inline]
    pub fn density(&self, scene: &Scene, id: LightId, target: &Target) -> f32 {
        self.segment.density(scene, id, self.t, target)
    }
}

/// A vertex that scatters towards lights.
pub struct Scatterer<'a, 's, S, F, const N: usize> {
    /// The point \[m\], from which densities are measured.
    pub p: Vec3,
    /// Normal of the surface there, zero in a medium: what lights are chosen for.
    pub n: Vec3,
    /// Where a shadow ray along a direction starts and in which medium.
    pub spawn: S,
    /// The half of the sphere that light counts from, by its axis; zero for all of it.
    pub half: Vec3,
    /// `(f |cos|, density)` towards a direction, per lane.
    pub eval: F,
    /// Equiangular technique of a medium vertex.
    pub rival: Option<Rival>,
    /// How the light is divided between this vertex and equiangular samples, where these are no rivals.
    pub division: Option<Division>,
    /// Where a shadow ray enters another medium; `None` where it stays in that of the path.
    pub surface: Option<&'a SurfacePoint>,
    /// The medium that the path is in.
    pub known: Place<'a, 's, N>,
}

/// What sampling lights needs to know of the path that scatters.
#[derive(Clone, Copy)]
pub struct Arrival<'a, const N: usize> {
    /// The scene.
    pub scene: &'a Scene,
    /// Switches.
    pub settings: &'a Settings,
    /// The path's weight at the vertex.
    pub weight: &'a PathWeight<N>,
    /// Its wavelengths.
    pub w: &'a Wavelengths<N>,
}

impl<S, F, const N: usize> Scatterer<'_, '_, S, F, N>
where
    S: Fn(Vec3) -> (Vec3, MediumId),
    F: Fn(Vec3) -> (Spectrum<N>, Spectrum<N>),
{
    /// The shadow ray to `end`, which lies in the direction `wi`; `None` when something blocks it.
    #[inline(always)]
    pub fn shadow(
        &self,
        path: &Arrival<'_, N>,
        wi: Vec3,
        end: End,
        sampler: &mut PathSampler,
    ) -> Option<Shadow<N>> {
        let (o, medium) = (self.spawn)(wi);
        let fresh;
        let inside = if medium == self.known.medium {
            self.known.inside
        } else {
            fresh = Inside::entered(path.scene, medium, self.surface, path.w);
            fresh.as_ref()
        };
        let start = Place { medium, inside, time: self.known.time };
        shadow(path.scene, path.settings, o, start, end, path.w, sampler)
    }

    /// A sample of one light, which is drawn: light per lane.
    #[inline]
    pub fn sample(&self, path: &Arrival<'_, N>, sampler: &mut PathSampler) -> Spectrum<N> {
        let u_light = sampler.next_1d();
        let u = sampler.next_2d();
        match path.scene.lights.select_at(self.p, self.n, u_light) {
            Some(selected) => self.towards(path, selected, [u.x, u.y], sampler),
            None => Spectrum::ZERO,
        }
    }

    /// `times` samples of each of a few lights: light per lane.
    #[inline(never)]
    pub fn each(
        &self,
        path: &Arrival<'_, N>,
        (lights, times): (&[LightId], u32),
        sampler: &mut PathSampler,
    ) -> Spectrum<N> {
        let mut l = Spectrum::ZERO;
        for &id in lights {
            for _ in 0..times {
                let u = sampler.next_2d();
                // samples on average in place of a probability
                let selected = Selected { id, pmf: times as f32 };
                l += self.towards(path, selected, [u.x, u.y], sampler);
            }
        }
        l
    }

    /// A sample of one light: light per lane.
    #[inline(always)]
    fn towards(
        &self,
        path: &Arrival<'_, N>,
        selected: Selected,
        u: [f32; 2],
        sampler: &mut PathSampler,
    ) -> Spectrum<N> {
        let Arrival { scene, settings, weight, w } = *path;
        let light = scene.lights.get(selected.id);
        if let Light::Volume(volume) = light {
            return self.ember(path, (volume, selected.pmf), u, sampler).unwrap_or(Spectrum::ZERO);
        }
        let from = (self.p, self.half);
        let Some(sample) = light.sample_li_beside_chance(&scene.accel, from, u, w) else {
            return Spectrum::ZERO;
        };
        let (f, pdf) = (self.eval)(sample.wi);
        if f.is_zero() {
            return Spectrum::ZERO;
        }
        let end = sample.target.map_or(End::Infinity(sample.wi), End::At);
        let Some(s) = self.shadow(path, sample.wi, end, sampler) else { return Spectrum::ZERO };
        // densities of the techniques that make this path, lane by lane
        let by_light = s.r_l * (selected.pmf * sample.pdf);
        let by_chance = if sample.delta { Spectrum::ZERO } else { pdf * s.r_u };
        let by_rival = match (&self.rival, &sample.target) {
            (Some(rival), Some(target)) => weight.r_e * s.r_l * rival.density(scene, selected.id, target),
            _ => Spectrum::ZERO,
        };
        let mut l = sample.l;
        if let (Some(division), Some(target)) = (&self.division, &sample.target) {
            l *= division.of_flights(light, (target.p - self.p).length());
        }
        let heuristic = Inside::heuristic(self.known.inside, settings);
        let (trust, others) = (heuristic.trust(), [weight.r_u * by_chance, by_rival]);
        combine(heuristic, weight.beta * f * s.t * l * trust, weight.r_u * by_light * trust, others)
    }
}
