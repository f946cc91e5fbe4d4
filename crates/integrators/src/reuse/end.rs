//! Where shared paths begin and end: what `x_i` must know of `y_k`, and the ray between them.

use crate::{
    glow::openness,
    medium::Inside,
    settings::Settings,
    shadow::{End, Known, Place, Shadow, past},
    volpath::{Site, Walk},
    weight::exp,
};
use tyndall_base::Vec3;
use tyndall_geometry::{Notes, Ray, SurfacePoint, surface::segment};
use tyndall_scatter::{
    bsdf::{Bsdf, TrowbridgeReitz},
    phase::PhaseFunction,
};
use tyndall_spectral::{Spectrum, Wavelengths};
use tyndall_transport::{MediumId, Scene, light::Target, media::Medium, sampler::PathSampler};

/// Media whose phase functions are narrower send too little to the points of others.
const LEAST_OPEN: f32 = 0.1;
/// So do surfaces that are smoother.
const LEAST_ROUGH: f32 = 0.02;

/// Roughness of a surface whose density of directions has a closed form that is quickly worked out, 1 where it is diffuse;
/// 0 for others.
#[inline(always)]
fn roughness<const N: usize>(bsdf: &Bsdf<'_, N>) -> f32 {
    let least = |d: &TrowbridgeReitz| d.alpha_x.min(d.alpha_y);
    match bsdf {
        Bsdf::Diffuse(_) | Bsdf::DiffuseTransmission(_) => 1.0,
        Bsdf::Conductor(b) => least(&b.distribution),
        Bsdf::Dielectric(b) => least(&b.distribution),
        _ => 0.0,
    }
}

impl<const N: usize> Site<'_, N> {
    /// The medium that the path came through.
    #[inline(always)]
    fn medium(&self) -> MediumId {
        match self {
            Self::Medium(at) => at.medium,
            Self::Surface(at) => at.medium,
        }
    }

    /// Whether paths of others may begin here: what scatters spreads directions enough.
    #[inline(always)]
    pub fn may_begin(&self, w: &Wavelengths<N>) -> bool {
        match self {
            Self::Medium(at) => openness(at.inside.phase, w) >= LEAST_OPEN,
            Self::Surface(at) => roughness(&at.bsdf) >= LEAST_ROUGH,
        }
    }

    /// Whether paths from different directions get different parts of what goes on from here.
    #[inline(always)]
    pub fn tells_apart(&self) -> bool {
        match self {
            Self::Medium(at) => !matches!(at.inside.phase, PhaseFunction::Isotropic),
            Self::Surface(at) => !matches!(at.bsdf, Bsdf::Diffuse(_)),
        }
    }

    /// `(f |cos|, density)` \[1/sr\] of going on towards `wi`, per lane.
    #[inline(always)]
    fn eval(&self, wi: Vec3, w: &Wavelengths<N>) -> (Spectrum<N>, Spectrum<N>) {
        match self {
            Self::Medium(at) => at.eval(wi, w),
            Self::Surface(at) => at.eval(wi),
        }
    }

    /// What is left of light along `ray`, which nothing blocks, to `target`; with the `boundaries` that it crosses.
    #[inline(always)]
    fn sees(
        &self,
        (scene, settings): (&Scene, &Settings),
        ray: Ray,
        boundaries: Notes,
        (target, known): (Target, Option<Known<'_, '_, N>>),
        w: &Wavelengths<N>,
        sampler: &mut PathSampler,
    ) -> Option<Shadow<N>> {
        let entered;
        let (medium, inside) = match self {
            Self::Medium(at) => (at.medium, Some(&at.inside)),
            Self::Surface(at) => {
                let medium = at.isect.medium_towards(ray.d, at.medium);
                if medium == at.medium {
                    (medium, at.inside.as_ref())
                } else {
                    entered = Inside::entered(scene, medium, Some(&at.isect.surface), w);
                    (medium, entered.as_ref())
                }
            }
        };
        let place = Place { medium, inside, time: ray.time };
        past(scene, settings, ray, boundaries, (place, known), End::At(target), w, sampler)
    }
}

/// A first scattering that paths of others may begin at.
#[derive(Clone, Copy, Debug)]
pub(super) struct Origin<'s, const N: usize> {
    site: Site<'s, N>,
    /// The throughput there.
    beta: Spectrum<N>,
    p: Vec3,
    /// Normal of the surface, zero in a medium; where rays start that leave to its side, and to the other.
    n: Vec3,
    starts: [Vec3; 2],
}

impl<'s, const N: usize> Origin<'s, N> {
    /// The site, which a path reached with the throughput `beta`.
    #[inline(always)]
    pub fn new(site: &Site<'s, N>, beta: Spectrum<N>) -> Self {
        let (p, n, starts) = match site {
            Site::Medium(at) => (at.p, Vec3::ZERO, [at.p; 2]),
            Site::Surface(at) => {
                let s = &at.isect.surface;
                (s.p, s.ng, [s.origin(s.ng), s.origin(-s.ng)])
            }
        };
        Self { site: *site, beta, p, n, starts }
    }

    /// Where a ray towards `wi` starts.
    #[inline(always)]
    fn start(&self, wi: Vec3) -> Vec3 {
        if self.n.dot(wi) < 0.0 { self.starts[1] } else { self.starts[0] }
    }
}

/// A second scattering that others may go on from: a point of a medium, or of a surface on the side that the path came
/// from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shared<'s, const N: usize> {
    target: Target,
    /// The medium that its path came through.
    medium: Option<(MediumId, Inside<'s, N>)>,
    /// Where rays to the point end.
    end: Vec3,
    time: f32,
    /// Geometric and shading normal of a surface on the side that the path came from.
    facing: Option<[Vec3; 2]>,
    /// What collides per metre, and what scatters; 1 on a surface.
    density: Spectrum<N>,
    scattering: Spectrum<N>,
}

/// Contribution and density of `y_k` as reached from some `x_i`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Link<const N: usize> {
    /// `beta_i F(x_i, y_k)`.
    pub through: Spectrum<N>,
    /// `p_l(y_k | x_i)`.
    pub density: Spectrum<N>,
    /// Unit direction from `y_k` to `x_i`.
    pub wo: Vec3,
    /// What of `through` goes on in the direction that is dealt with.
    pub sent: Spectrum<N>,
}

impl<'s, const N: usize> Shared<'s, N> {
    /// The site that `walk` reached from `from`, if others may go on from it.
    #[inline(always)]
    pub fn new(walk: &Walk<'_, N>, at: &Site<'s, N>) -> Option<Self> {
        // what lies behind depends on where the path entered, which is another point for each
        if matches!(walk.scene.medium(at.medium()), Some(Medium::Painted(_))) {
            return None;
        }
        Some(match at {
            Site::Medium(at) => {
                if openness(at.inside.phase, walk.w()) < LEAST_OPEN {
                    return None;
                }
                let local = at.inside.varying.map_or(1.0, |m| m.density(at.p));
                let (density, scattering) = (at.inside.sigma_t * local, at.inside.sigma_s * local);
                let (target, time) = (Target::free(at.p), walk.ray.time);
                let medium = Some((at.medium, at.inside));
                Self { target, medium, end: at.p, time, facing: None, density, scattering }
            }
            Site::Surface(at) => {
                if roughness(&at.bsdf) < LEAST_ROUGH {
                    return None;
                }
                let SurfacePoint { p, rounding, ng, .. } = at.isect.surface;
                let facing = Some([ng, at.frame.z].map(|n| if n.dot(walk.ray.d) < 0.0 { n } else { -n }));
                let target = Target { p, rounding, n: ng, pdf_area: 1.0 };
                let end = at.isect.surface.origin(-walk.ray.d);
                let medium = at.inside.map(|inside| (at.medium, inside));
                let (time, one) = (walk.ray.time, Spectrum::ONE);
                Self { target, medium, end, time, facing, density: one, scattering: one }
            }
        })
    }

    /// Volume or area per solid angle, inverse; `None` for the side that the path did not come from.
    #[inline(always)]
    fn geometry(&self, wi: Vec3, r2: f32) -> Option<f32> {
        let cos = match self.facing {
            None => 1.0,
            Some([ng, ns]) => {
                if ns.dot(wi) >= 0.0 {
                    return None;
                }
                -ng.dot(wi)
            }
        };
        (cos > 0.0 && r2 > 0.0).then(|| cos / r2)
    }

    /// The point as its own path reached it from `from` through media that do not vary, and the density that it drew the
    /// point with: the hero's, per volume or area.
    #[inline(always)]
    pub fn own_link(&self, walk: &Walk<'_, N>, from: &Origin<'_, N>) -> Option<(Link<N>, f32)> {
        let r2 = (self.target.p - from.p).length_squared();
        let towards = from.site.eval(walk.ray.d, walk.w()).1.hero();
        let passed = exp(Spectrum([-walk.flown()])).hero();
        let own = towards * passed * self.density.hero() * self.geometry(walk.ray.d, r2)?;
        let (through, density) = (walk.weight.beta * own, walk.weight.r_u * own);
        own.is_normal().then_some((Link { through, density, wo: -walk.ray.d, sent: Spectrum::ZERO }, own))
    }

    /// The point as aimed at from `from`; `None` where nothing scatters to it.
    #[inline(always)]
    pub fn aim(&self, from: &Origin<'_, N>, w: &Wavelengths<N>) -> Option<Aim<N>> {
        let to = self.target.p - from.p;
        let r2 = to.length_squared();
        let wi = to * (1.0 / r2.sqrt());
        let geometry = self.geometry(wi, r2)?;
        let (f, pdf) = from.site.eval(wi, w);
        // a path without throughput ends, so that its density here is zero, too
        if (from.beta * f).is_zero() {
            return None;
        }
        let ray = segment(from.start(wi), self.end, self.time)?;
        Some(Aim { ray, wi, f: f * geometry, pdf: pdf * geometry })
    }

    /// The same as [`Self::link`], for a link that is rare.
    #[inline(never)]
    pub fn link_apart(
        &self,
        scene: (&Scene, &Settings),
        from: &Origin<'_, N>,
        aim: &Aim<N>,
        boundaries: Notes,
        w: &Wavelengths<N>,
        sampler: &mut PathSampler,
    ) -> Option<Link<N>> {
        self.link(scene, from, aim, boundaries, w, sampler)
    }

    /// The point as reached from `from`, where nothing blocks the aim; `boundaries` without material lie between.
    #[inline(always)]
    pub fn link(
        &self,
        (scene, settings): (&Scene, &Settings),
        from: &Origin<'_, N>,
        aim: &Aim<N>,
        boundaries: Notes,
        w: &Wavelengths<N>,
        sampler: &mut PathSampler,
    ) -> Option<Link<N>> {
        let known = self.medium.as_ref().map(|(medium, inside)| (*medium, inside));
        let end = (self.target, known);
        let passed = from.site.sees((scene, settings), aim.ray, boundaries, end, w, sampler)?;
        let through = from.beta * aim.f * passed.t * self.scattering;
        if through.is_zero() {
            return None;
        }
        let density = aim.pdf * passed.r_u * self.density;
        Some(Link { through, density, wo: -aim.wi, sent: Spectrum::ZERO })
    }
}

/// A shared point as aimed at from another path's first scattering.
#[derive(Clone, Copy, Debug)]
pub(super) struct Aim<const N: usize> {
    /// Ends just short of the point.
    pub ray: Ray,
    wi: Vec3,
    /// What scatters towards the point, and the density of its direction, both per volume or area there.
    f: Spectrum<N>,
    pdf: Spectrum<N>,
}
