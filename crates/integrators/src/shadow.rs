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
    if settings.exact_transmittance
        && boundary
        && let Some(hits) = boundaries.in_order()
        && let Some(s) = through(scene, settings, &ray, hits, (start, known), w)
    {
        return Some(s);
    }
    let mut s = Shadow::open(start.medium);
    let mut inside = start.inside.copied();
    loop {
        let hit = if boundary { scene.next_boundary(&ray) } else { None };
        let t = hit.as_ref().map_or(ray.t_max, |h| h.t);
        if let Some(inside) = &inside {
            match inside.tracked(settings) {
                None => {
                    attenuate(&mut s, inside, inside.length(&ray, [0.0, t], settings), settings, sampler)?
                }
                Some(m) => tracking::transmit(m, &ray, t, w, settings, sampler.stream(), &mut s)?,
            }
        }
        let Some(hit) = hit else { return Some(s) };
        let isect = scene.interaction(&ray, &hit);
        s.end = isect.medium_towards(ray.d, s.end);
        inside = Inside::entered(scene, s.end, Some(&isect.surface), w);
        let Some(rest) = towards(isect.surface.origin(ray.d), &end, start.time) else { return Some(s) };
        ray = rest;
    }
}

/// Transmittance in closed form through boundaries that lie apart; `None` where some medium on the way has none.
#[inline(always)]
fn through<const N: usize>(
    scene: &Scene,
    settings: &Settings,
    ray: &Ray,
    hits: &[Hit],
    (start, known): (Place<'_, '_, N>, Option<Known<'_, '_, N>>),
    w: &Wavelengths<N>,
) -> Option<Shadow<N>> {
    let mut s = Shadow::open(start.medium);
    let mut inside = start.inside.copied();
    let mut from = 0.0;
    for k in 0..=hits.len() {
        let to = if k < hits.len() { hits[k].t } else { ray.t_max };
        if let Some(inside) = &inside {
            if inside.tracked(settings).is_some() {
                return None;
            }
            s.attenuate(inside, inside.length(ray, [from, to], settings), settings);
        }
        if k < hits.len() {
            s.end = scene.medium_behind(ray, &hits[k], s.end);
            if matches!(scene.medium(s.end), Some(Medium::Painted(_))) {
                return None;
            }
            inside = match known {
                Some((medium, inside)) if medium == s.end => Some(*inside),
                _ => Inside::of(scene, s.end, w),
            };
            from = to;
        }
    }
    Some(s)
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
