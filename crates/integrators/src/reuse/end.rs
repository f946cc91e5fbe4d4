//! Where shared paths begin and end: what `x_i` must know of `y_k`, and the ray between them.

use crate::{
    glow::openness,
    medium::Inside,
    settings::Settings,
    shadow::{End, Place, Shadow, past},
    volpath::{Site, Walk},
    weight::exp,
};
use tyndall_base::Vec3;
use tyndall_geometry::{Notes, Ray, SurfacePoint};
use tyndall_scatter::bsdf::{Bsdf, BsdfFlags};
use tyndall_spectral::{Spectrum, Wavelengths};
use tyndall_transport::{Scene, light::Target, sampler::PathSampler};

/// Media whose phase functions are narrower send too little to the points of others.
const LEAST_OPEN: f32 = 0.1;

impl<const N: usize> Site<'_, N> {
    /// The point \[m\].
    #[inline(always)]
    pub fn p(&self) -> Vec3 {
        match self {
            Self::Medium(at) => at.p,
            Self::Surface(at) => at.isect.surface.p,
        }
    }

    /// Whether paths of others may begin here: what scatters leaves all directions open.
    #[inline(always)]
    pub fn may_begin(&self, w: &Wavelengths<N>) -> bool {
        match self {
            Self::Medium(at) => openness(at.inside.phase, w) >= LEAST_OPEN,
            Self::Surface(at) => at.bsdf.flags() == BsdfFlags::DIFFUSE | BsdfFlags::REFLECTION,
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

    /// Where a ray towards `wi` starts.
    #[inline(always)]
    fn spawn(&self, wi: Vec3) -> Vec3 {
        match self {
            Self::Medium(at) => at.p,
            Self::Surface(at) => at.spawn(wi).0,
        }
    }

    /// What is left of light along `ray`, which nothing blocks, to `target`; with the `boundaries` that it crosses.
    #[inline(always)]
    fn sees(
        &self,
        (scene, settings): (&Scene, &Settings),
        ray: Ray,
        boundaries: Notes,
        target: Target,
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
        past(scene, settings, ray, boundaries, place, End::At(target), w, sampler)
    }
}

/// A second scattering that others may go on from: a point of a medium, or a surface that sends the same light in all
/// directions on its side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shared<const N: usize> {
    target: Target,
    time: f32,
    /// Geometric and shading normal of a surface on the side that the path came from.
    facing: Option<[Vec3; 2]>,
    /// What collides per metre, and what scatters; 1 on a surface.
    density: Spectrum<N>,
    scattering: Spectrum<N>,
    /// Density of the point as its own path drew it: the hero's, per volume or area.
    pub own: f32,
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
}

impl<const N: usize> Shared<N> {
    /// The site that `walk` reached from `from`, if others may go on from it.
    #[inline(always)]
    pub fn new(walk: &Walk<'_, N>, from: &Site<'_, N>, at: &Site<'_, N>) -> Option<Self> {
        let mut shared = match at {
            Site::Medium(at) => {
                if openness(at.inside.phase, walk.w()) < LEAST_OPEN {
                    return None;
                }
                let (density, scattering) = (at.inside.sigma_t, at.inside.sigma_s);
                let target = Target::free(at.p);
                Self { target, time: walk.ray.time, facing: None, density, scattering, own: 0.0 }
            }
            Site::Surface(at) => {
                let Bsdf::Diffuse(_) = at.bsdf else { return None };
                let SurfacePoint { p, rounding, ng, .. } = at.isect.surface;
                let facing = Some([ng, at.frame.z].map(|n| if n.dot(walk.ray.d) < 0.0 { n } else { -n }));
                let target = Target { p, rounding, n: ng, pdf_area: 1.0 };
                let one = Spectrum::ONE;
                Self { target, time: walk.ray.time, facing, density: one, scattering: one, own: 0.0 }
            }
        };
        let to = shared.target.p - from.p();
        let r2 = to.length_squared();
        let towards = from.eval(walk.ray.d, walk.w()).1.hero();
        let passed = exp(Spectrum([-walk.flown()])).hero();
        shared.own = towards * passed * shared.density.hero() * shared.geometry(walk.ray.d, r2)?;
        shared.own.is_normal().then_some(shared)
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

    /// The point as its own path reached it.
    #[inline(always)]
    pub fn own_link(&self, walk: &Walk<'_, N>) -> Link<N> {
        let (through, density) = (walk.weight.beta * self.own, walk.weight.r_u * self.own);
        Link { through, density, wo: -walk.ray.d }
    }

    /// The point as aimed at from `from`, at which the throughput is `beta`; `None` where nothing scatters to it.
    #[inline(always)]
    pub fn aim(&self, from: &Site<'_, N>, beta: Spectrum<N>, w: &Wavelengths<N>) -> Option<Aim<N>> {
        let to = self.target.p - from.p();
        let r2 = to.length_squared();
        let wi = to * (1.0 / r2.sqrt());
        let geometry = self.geometry(wi, r2)?;
        let (f, pdf) = from.eval(wi, w);
        // a path without throughput ends, so that its density here is zero, too
        if (beta * f).is_zero() {
            return None;
        }
        let ray = self.target.ray_from(from.spawn(wi), self.time)?;
        Some(Aim { ray, wi, f: f * geometry, pdf: pdf * geometry })
    }

    /// The point as reached from `from`, at which the throughput is `beta`, where nothing blocks the aim;
    /// `boundaries` without material lie between.
    #[inline(always)]
    pub fn link(
        &self,
        (scene, settings): (&Scene, &Settings),
        (from, beta): (&Site<'_, N>, Spectrum<N>),
        aim: &Aim<N>,
        boundaries: Notes,
        w: &Wavelengths<N>,
        sampler: &mut PathSampler,
    ) -> Option<Link<N>> {
        let passed = from.sees((scene, settings), aim.ray, boundaries, self.target, w, sampler)?;
        let through = beta * aim.f * passed.t * self.scattering;
        if through.is_zero() {
            return None;
        }
        Some(Link { through, density: aim.pdf * passed.r_u * self.density, wo: -aim.wi })
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
