//! Light sampling for paths that one density draws: the paper's algorithm, OPAW and wavelength clusters.
//!
//! A direction towards a light is drawn with density `p_l`, a direction by chance with density `p_d`, both per solid
//! angle and the same for all wavelengths of the path. Each way counts with the balance heuristic, `p / (p_l + p_d)`
//! (Veach, Guibas 1995). Coefficients come from the caller, so that OPAW can take its mean.

use tyndall_base::Vec3;
use tyndall_geometry::{Hit, Ray};
use tyndall_spectral::{Spectrum, Wavelengths};
use tyndall_transport::{Interaction, LightId, MediumId, Scene, light::Target, sampler::PathSampler};

/// The last scattering of a path, which a light sample competes with.
#[derive(Clone, Copy, Debug)]
pub struct Last {
    /// Where \[m\].
    pub p: Vec3,
    /// Density with which the direction was drawn \[1/sr\].
    pub pdf: f32,
}

impl Last {
    /// Weight of meeting light `id` by chance along `d`; the `target` is where an area light was met.
    #[inline]
    pub fn by_chance(&self, scene: &Scene, id: LightId, d: Vec3, target: Option<&Target>) -> f32 {
        let light = scene.lights.get(id);
        let pdf = match target {
            Some(target) => light.pdf_li(&scene.accel, self.p, d, target),
            None => light.pdf_infinite(self.p, d),
        };
        self.pdf / (self.pdf + scene.lights.pmf(id) * pdf)
    }
}

/// A vertex that scatters towards a light.
pub struct Vertex<S, F> {
    /// The point \[m\].
    pub p: Vec3,
    /// Time of the path.
    pub time: f32,
    /// Where a shadow ray along a direction starts, and in which medium.
    pub spawn: S,
    /// `f |cos|` per wavelength and the density \[1/sr\] of drawing the direction by chance.
    pub eval: F,
}

impl<S: Fn(Vec3) -> (Vec3, MediumId), F> Vertex<S, F> {
    /// Light of one light sample that the vertex scatters, per wavelength; `sigma_t` is the extinction of a medium.
    #[inline]
    pub fn sample<const N: usize>(
        &self,
        scene: &Scene,
        sigma_t: impl Fn(MediumId) -> Spectrum<N>,
        w: &Wavelengths<N>,
        sampler: &mut PathSampler,
    ) -> Spectrum<N>
    where
        F: Fn(Vec3) -> (Spectrum<N>, f32),
    {
        let u_light = sampler.next_1d();
        let u = sampler.next_2d();
        let Some(selected) = scene.lights.select(u_light) else { return Spectrum::ZERO };
        let light = scene.lights.get(selected.id);
        let Some(s) = light.sample_li(&scene.accel, self.p, [u.x, u.y], w) else { return Spectrum::ZERO };
        let (f, chance) = (self.eval)(s.wi);
        if f.is_zero() {
            return Spectrum::ZERO;
        }
        let pdf = selected.pmf * s.pdf;
        let density = if s.delta { pdf } else { pdf + chance };
        let (o, medium) = (self.spawn)(s.wi);
        transmittance(scene, (o, self.time), medium, s.wi, s.target.as_ref(), sigma_t)
            * f
            * s.l
            * (1.0 / density)
    }
}

/// Light that a surface emits where a path met it, with the weight of meeting it by chance.
#[inline]
pub fn emitted<const N: usize>(
    scene: &Scene,
    ray: &Ray,
    hit: &Hit,
    isect: &Interaction<'_>,
    last: Option<Last>,
    w: &Wavelengths<N>,
) -> Spectrum<N> {
    let Some(id) = isect.light else { return Spectrum::ZERO };
    let (s, light) = (&isect.surface, scene.lights.get(id));
    let le = light.radiance_at(s.ng, [s.uv.x, s.uv.y], -ray.d, w);
    let chance = last.map_or(1.0, |last| {
        let target = light.target(&scene.accel, hit, s);
        last.by_chance(scene, id, ray.d, Some(&target))
    });
    le * chance
}

/// The same for light from infinity along `d`; `from` is where the ray took that direction.
#[inline]
pub fn sky<const N: usize>(
    scene: &Scene,
    from: Vec3,
    d: Vec3,
    last: Option<Last>,
    w: &Wavelengths<N>,
) -> Spectrum<N> {
    let mut l = Spectrum::ZERO;
    for &id in scene.lights.infinite() {
        let chance = last.map_or(1.0, |last| last.by_chance(scene, id, d, None));
        l += scene.lights.get(id).le_infinite(last.map_or(from, |last| last.p), d, w) * chance;
    }
    l
}

/// `exp(-sum of sigma_t d)` between a point and a light (eq. 3), zero behind a surface.
fn transmittance<const N: usize>(
    scene: &Scene,
    (o, time): (Vec3, f32),
    mut medium: MediumId,
    d: Vec3,
    target: Option<&Target>,
    sigma_t: impl Fn(MediumId) -> Spectrum<N>,
) -> Spectrum<N> {
    let towards = |o: Vec3| match target {
        Some(target) => target.ray_from(o, time),
        None => Some(Ray { time, ..Ray::new(o, d) }),
    };
    let mut tau = Spectrum::ZERO;
    let Some(mut ray) = towards(o) else { return Spectrum::ONE };
    let obstacles = scene.obstacles(&ray);
    if obstacles.blocked {
        return Spectrum::ZERO;
    }
    loop {
        let hit = if !obstacles.boundaries.is_empty() { scene.next_boundary(&ray) } else { None };
        let t = hit.as_ref().map_or(ray.t_max, |h| h.t);
        let sigma = sigma_t(medium);
        // a transparent medium stays so over an unbounded way
        tau += sigma.map(|s| if s > 0.0 { s * t } else { 0.0 });
        let rest = hit.and_then(|hit| {
            let isect = scene.interaction(&ray, &hit);
            medium = isect.medium_towards(ray.d, medium);
            towards(isect.surface.origin(ray.d))
        });
        match rest {
            Some(rest) => ray = rest,
            None => return Spectrum(tyndall_base::math::exp_n((-tau).0)),
        }
    }
}

/// Extinction of a medium at the wavelengths of a path; zero in vacuum.
#[inline(always)]
pub fn extinction<const N: usize>(scene: &Scene, id: MediumId, w: &Wavelengths<N>) -> Spectrum<N> {
    scene.medium(id).and_then(|m| m.homogeneous(w)).map_or(Spectrum::ZERO, |m| m.sigma_t())
}
