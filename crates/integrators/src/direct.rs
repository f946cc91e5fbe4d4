//! Light sampling at a vertex, combined with chance hits and with equiangular sampling.

use crate::{
    ember,
    equiangular::{Division, Segment},
    medium::Inside,
    settings::Settings,
    shadow::{End, Place, Shadow, shadow},
    weight::{Heuristic, PathWeight, combine},
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

impl<S, F, const N: usize> Scatterer<'_, '_, S, F, N>
where
    S: Fn(Vec3) -> (Vec3, MediumId),
{
    /// The shadow ray to `end`, which lies in the direction `wi`; `None` when something blocks it.
    #[inline(always)]
    pub fn shadow(
        &self,
        scene: &Scene,
        settings: &Settings,
        wi: Vec3,
        end: End,
        w: &Wavelengths<N>,
        sampler: &mut PathSampler,
    ) -> Option<Shadow<N>> {
        let (o, medium) = (self.spawn)(wi);
        let fresh;
        let inside = if medium == self.known.medium {
            self.known.inside
        } else {
            fresh = Inside::entered(scene, medium, self.surface, w);
            fresh.as_ref()
        };
        shadow(scene, settings, o, Place { medium, inside, time: self.known.time }, end, w, sampler)
    }
}

/// One light sample at `vertex`: light per lane.
#[inline]
pub fn sample<const N: usize, S, F>(
    scene: &Scene,
    settings: &Settings,
    vertex: &Scatterer<'_, '_, S, F, N>,
    weight: &PathWeight<N>,
    w: &Wavelengths<N>,
    sampler: &mut PathSampler,
) -> Spectrum<N>
where
    S: Fn(Vec3) -> (Vec3, MediumId),
    F: Fn(Vec3) -> (Spectrum<N>, Spectrum<N>),
{
    let u_light = sampler.next_1d();
    let u = sampler.next_2d();
    let Some(selected) = scene.lights.select_at(vertex.p, vertex.n, u_light) else { return Spectrum::ZERO };
    towards(scene, settings, vertex, selected, [u.x, u.y], weight, w, sampler)
}

/// `times` samples of each of a few lights at `vertex`: light per lane.
#[inline(never)]
pub fn each<const N: usize, S, F>(
    scene: &Scene,
    settings: &Settings,
    vertex: &Scatterer<'_, '_, S, F, N>,
    (lights, times): (&[LightId], u32),
    weight: &PathWeight<N>,
    w: &Wavelengths<N>,
    sampler: &mut PathSampler,
) -> Spectrum<N>
where
    S: Fn(Vec3) -> (Vec3, MediumId),
    F: Fn(Vec3) -> (Spectrum<N>, Spectrum<N>),
{
    let mut l = Spectrum::ZERO;
    for &id in lights {
        for _ in 0..times {
            let u = sampler.next_2d();
            // samples on average in place of a probability
            let selected = Selected { id, pmf: times as f32 };
            l += towards(scene, settings, vertex, selected, [u.x, u.y], weight, w, sampler);
        }
    }
    l
}

/// A sample of one light at `vertex`: light per lane.
#[expect(clippy::too_many_arguments, reason = "the state of a path and of a sample")]
#[inline(always)]
fn towards<const N: usize, S, F>(
    scene: &Scene,
    settings: &Settings,
    vertex: &Scatterer<'_, '_, S, F, N>,
    selected: Selected,
    u: [f32; 2],
    weight: &PathWeight<N>,
    w: &Wavelengths<N>,
    sampler: &mut PathSampler,
) -> Spectrum<N>
where
    S: Fn(Vec3) -> (Vec3, MediumId),
    F: Fn(Vec3) -> (Spectrum<N>, Spectrum<N>),
{
    let light = scene.lights.get(selected.id);
    if let Light::Volume(volume) = light {
        let choice = (&**volume, selected.pmf);
        let l = ember::sample(scene, settings, vertex, choice, u, weight, w, sampler);
        return l.unwrap_or(Spectrum::ZERO);
    }
    let Some(sample) = light.sample_li(&scene.accel, vertex.p, u, w) else { return Spectrum::ZERO };
    let (f, pdf) = (vertex.eval)(sample.wi);
    if f.is_zero() {
        return Spectrum::ZERO;
    }
    let end = sample.target.map_or(End::Infinity(sample.wi), End::At);
    let Some(s) = vertex.shadow(scene, settings, sample.wi, end, w, sampler) else { return Spectrum::ZERO };
    // densities of the techniques that make this path, lane by lane
    let by_light = s.r_l * (selected.pmf * sample.pdf);
    let by_chance = if sample.delta { Spectrum::ZERO } else { pdf * s.r_u };
    let by_rival = match (&vertex.rival, &sample.target) {
        (Some(rival), Some(target)) => weight.r_e * s.r_l * rival.density(scene, selected.id, target),
        _ => Spectrum::ZERO,
    };
    let mut l = sample.l;
    if let (Some(division), Some(target)) = (&vertex.division, &sample.target) {
        l *= division.of_flights(light, (target.p - vertex.p).length());
    }
    let heuristic = Heuristic::at(settings, vertex.known.inside);
    let (trust, others) = (heuristic.trust(), [weight.r_u * by_chance, by_rival]);
    combine(heuristic, weight.beta * f * s.t * l * trust, weight.r_u * by_light * trust, others)
}
