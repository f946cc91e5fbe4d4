//! Visibility and transmittance between two points, through boundaries that do not bend light.

use crate::{medium::Inside, settings::Settings, tracking};
use tyndall_base::Vec3;
use tyndall_geometry::{Hit, Notes, Ray};
use tyndall_spectral::{Spectrum, Wavelengths};
use tyndall_transport::{MediumId, Scene, light::Target, media::Medium, sampler::PathSampler};

/// The estimate of transmittance along a shadow ray, with what it does to the densities of the techniques.
#[derive(Clone, Copy, Debug)]
pub struct Shadow<const N: usize> {
    /// Estimate of the transmittance, over the hero's probability of the estimate.
    pub t: Spectrum<N>,
    /// Lanes' densities of this estimate over the hero's: 1 where the transmittance is exact.
    pub r_l: Spectrum<N>,
    /// Density of a path of chance that gets through, over the hero's density of this estimate.
    pub r_u: Spectrum<N>,
    /// The medium that the far end lies in.
    pub end: MediumId,
}

impl<const N: usize> Shadow<N> {
    /// Nothing between two points of a medium.
    #[inline(always)]
    pub fn open(end: MediumId) -> Self {
        Self { t: Spectrum::ONE, r_l: Spectrum::ONE, r_u: Spectrum::ONE, end }
    }

    /// Passes a medium, with its exact transmittance over a length.
    #[inline(always)]
    fn attenuate(&mut self, inside: &Inside<'_, N>, distance: f32, settings: &Settings) {
        let t = inside.transmittance(distance);
        self.t *= t;
        if !inside.only_absorbs(settings) {
            self.r_u *= t;
        }
    }
}

/// The medium that a shadow ray starts in, with its coefficients, which the path knows already.
#[derive(Clone, Copy, Debug)]
pub struct Place<'a, 's, const N: usize> {
    /// The medium.
    pub medium: MediumId,
    /// Its coefficients; `None` in vacuum.
    pub inside: Option<&'a Inside<'s, N>>,
    /// The path's time within the shutter.
    pub time: f32,
}

/// A medium with its coefficients.
pub type Known<'a, 's, const N: usize> = (MediumId, &'a Inside<'s, N>);

/// The far end of a shadow ray: a point on a light, or a direction to infinity.
#[derive(Clone, Copy, Debug)]
pub enum End {
    /// Stops short of the point.
    At(Target),
    /// Leaves the scene.
    Infinity(Vec3),
}

/// Follows the shadow ray from `o` (already moved off its surface); `None` when a surface blocks it.
#[inline]
pub fn shadow<const N: usize>(
    scene: &Scene,
    settings: &Settings,
    o: Vec3,
    start: Place<'_, '_, N>,
    end: End,
    w: &Wavelengths<N>,
    sampler: &mut PathSampler,
) -> Option<Shadow<N>> {
    // one query decides whether anything blocks the whole way; boundaries are looked for only where there are some
    let Some(ray) = towards(o, &end, start.time) else { return Some(Shadow::open(start.medium)) };
    let obstacles = scene.obstacles(&ray);
    if obstacles.blocked {
        return None;
    }
    past(scene, settings, ray, obstacles.boundaries, (start, None), end, w, sampler)
}

/// The same along a ray to `end` that nothing blocks, with the boundaries that it crosses; a medium on the way may be known.
#[expect(clippy::too_many_arguments, reason = "the state of a path and of a ray")]
#[inline(always)]
pub fn past<const N: usize>(
    scene: &Scene,
    settings: &Settings,
    mut ray: Ray,
    mut boundaries: Notes,
    (start, known): (Place<'_, '_, N>, Option<Known<'_, '_, N>>),
    end: End,
    w: &Wavelengths<N>,
    sampler: &mut PathSampler,
) -> Option<Shadow<N>> {
    let boundary = !boundaries.is_empty();
    if boundary
        && let Some(hits) = boundaries.in_order()
        && let Some(media) = behind(scene, &ray, hits, start.medium)
    {
        let mut s = Shadow::open(start.medium);
        let mut inside = start.inside.copied();
        let mut from = 0.0;
        for (hit, medium) in hits.iter().zip(media) {
            if let Some(inside) = &inside {
                stretch(&mut s, inside, &ray, [from, hit.t], w, settings, sampler)?;
            }
            inside = match known {
                Some((known, inside)) if known == medium => Some(*inside),
                _ => Inside::of(scene, medium, w),
            };
            (from, s.end) = (hit.t, medium);
        }
        if let Some(inside) = &inside {
            stretch(&mut s, inside, &ray, [from, ray.t_max], w, settings, sampler)?;
        }
        return Some(s);
    }
    let mut s = Shadow::open(start.medium);
    let mut inside = start.inside.copied();
    loop {
        let hit = if boundary { scene.next_boundary(&ray) } else { None };
        let t = hit.as_ref().map_or(ray.t_max, |h| h.t);
        if let Some(inside) = &inside {
            stretch(&mut s, inside, &ray, [0.0, t], w, settings, sampler)?;
        }
        let Some(hit) = hit else { return Some(s) };
        let isect = scene.interaction(&ray, &hit);
        s.end = isect.medium_towards(ray.d, s.end);
        inside = Inside::entered(scene, s.end, Some(&isect.surface), w);
        let Some(rest) = towards(isect.surface.origin(ray.d), &end, start.time) else { return Some(s) };
        ray = rest;
    }
}

/// The media behind each of a few boundaries in their order; `None` where one depends on how it is entered.
#[inline(always)]
fn behind(scene: &Scene, ray: &Ray, hits: &[Hit], start: MediumId) -> Option<[MediumId; Notes::MOST]> {
    let mut media = [start; Notes::MOST];
    let mut medium = start;
    for (hit, behind) in hits.iter().zip(&mut media) {
        medium = scene.medium_behind(ray, hit, medium);
        if matches!(scene.medium(medium), Some(Medium::Painted(_))) {
            return None;
        }
        *behind = medium;
    }
    Some(media)
}

/// Passes what lies of one medium between two distances along the ray; `None` when nothing gets through.
#[inline(always)]
fn stretch<const N: usize>(
    s: &mut Shadow<N>,
    inside: &Inside<'_, N>,
    ray: &Ray,
    [from, to]: [f32; 2],
    w: &Wavelengths<N>,
    settings: &Settings,
    sampler: &mut PathSampler,
) -> Option<()> {
    match inside.tracked(settings) {
        None => attenuate(s, inside, inside.length(ray, [from, to], settings), settings, sampler),
        Some(m) => {
            let rest = Ray::new(ray.at(from), ray.d);
            let known = inside.of_density_one();
            tracking::transmit((m, known), &rest, to - from, w, settings, sampler.stream(), s)
        }
    }
}

/// The remaining ray; `None` when nothing remains.
#[inline(always)]
fn towards(o: Vec3, end: &End, time: f32) -> Option<Ray> {
    match end {
        End::Infinity(d) => Some(Ray { time, ..Ray::new(o, *d) }),
        End::At(target) => target.ray_from(o, time),
    }
}

#[inline(always)]
fn attenuate<const N: usize>(
    s: &mut Shadow<N>,
    inside: &Inside<'_, N>,
    distance: f32,
    settings: &Settings,
    sampler: &mut PathSampler,
) -> Option<()> {
    if settings.exact_transmittance {
        s.attenuate(inside, distance, settings);
        return Some(());
    }
    // a free flight at the hero's wavelength that gets through or does not
    let hero = inside.sigma_t.hero();
    let flight = tyndall_base::warp::sample_exponential(sampler.next_1d(), 1.0);
    if flight < hero * distance {
        return None;
    }
    let ratio = inside.transmittance_over_hero(distance);
    s.t *= ratio;
    s.r_l *= ratio;
    s.r_u *= ratio;
    Some(())
}
