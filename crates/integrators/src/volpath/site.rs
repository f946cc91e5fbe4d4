//! Where a path scatters: a point of a medium or of a surface, with all that scattering there needs.

use crate::{
    medium::Inside,
    steer::{Steering, mixed},
};
use tyndall_base::Vec3;
use tyndall_geometry::Frame;
use tyndall_scatter::bsdf::{Bsdf, BsdfFlags};
use tyndall_spectral::{Spectrum, Wavelengths};
use tyndall_transport::{Interaction, MediumId};

/// What scatters at a point, for light that leaves along any direction.
pub(crate) trait Scatters<const N: usize> {
    /// `(f |cos|, density)` \[1/sr\] per lane of a path that came from `wo` and goes on towards `wi`; in a medium the phase
    /// function stands for `f |cos|`.
    fn eval_from(&self, wo: Vec3, wi: Vec3, w: &Wavelengths<N>) -> (Spectrum<N>, Spectrum<N>);
}

/// A point of a medium.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MediumSite<'s, const N: usize> {
    /// The point \[m\].
    pub p: Vec3,
    /// Unit direction that the path came from.
    pub wo: Vec3,
    /// The medium there.
    pub medium: MediumId,
    /// Its coefficients; where it varies those of density 1.
    pub inside: Inside<'s, N>,
    /// What draws directions beside the phase function.
    pub steering: Option<Steering<'s>>,
}

impl<const N: usize> MediumSite<'_, N> {
    /// `(phase function, density)` \[1/sr\] of going on towards `wi`, per lane.
    #[inline(always)]
    pub fn eval(&self, wi: Vec3, w: &Wavelengths<N>) -> (Spectrum<N>, Spectrum<N>) {
        self.eval_from(self.wo, wi, w)
    }
}

impl<const N: usize> Scatters<N> for MediumSite<'_, N> {
    #[inline(always)]
    fn eval_from(&self, wo: Vec3, wi: Vec3, w: &Wavelengths<N>) -> (Spectrum<N>, Spectrum<N>) {
        let phase = self.inside.phase.eval(wo, wi, w);
        (phase, mixed(self.steering.as_ref(), phase, wi))
    }
}

/// A point of a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SurfaceSite<'s, const N: usize> {
    /// The point and what is bound to it.
    pub isect: Interaction<'s>,
    /// Shading frame.
    pub frame: Frame,
    /// The surface at the path's wavelengths.
    pub bsdf: Bsdf<'s, N>,
    /// Unit direction that the path came from, in the shading frame.
    pub wo: Vec3,
    /// The medium that the path came through.
    pub medium: MediumId,
    /// Its coefficients.
    pub inside: Option<Inside<'s, N>>,
    /// What draws directions beside the BSDF.
    pub steering: Option<Steering<'s>>,
}

impl<const N: usize> SurfaceSite<'_, N> {
    /// `(f |cos|, density)` \[1/sr\] of going on towards `wi`, per lane.
    #[inline(always)]
    pub fn eval(&self, wi: Vec3) -> (Spectrum<N>, Spectrum<N>) {
        self.eval_local(self.wo, wi)
    }

    /// The same for a path that came from `wo` in the shading frame.
    #[inline(always)]
    fn eval_local(&self, wo: Vec3, wi: Vec3) -> (Spectrum<N>, Spectrum<N>) {
        let local = self.frame.to_local(wi);
        let (f, pdf) = self.bsdf.eval_pdf(wo, local);
        (f * local.z.abs(), mixed(self.steering.as_ref(), pdf, wi))
    }

    /// The half of the sphere that light counts from, by its axis; zero where what comes from behind counts, too.
    #[inline(always)]
    pub fn half(&self) -> Vec3 {
        if self.bsdf.flags().contains(BsdfFlags::TRANSMISSION) {
            Vec3::ZERO
        } else if self.wo.z < 0.0 {
            -self.frame.z
        } else {
            self.frame.z
        }
    }

    /// Where a ray along `wi` starts, and in which medium.
    #[inline(always)]
    pub fn spawn(&self, wi: Vec3) -> (Vec3, MediumId) {
        (self.isect.surface.origin(wi), self.isect.medium_towards(wi, self.medium))
    }
}

impl<const N: usize> Scatters<N> for SurfaceSite<'_, N> {
    #[inline(always)]
    fn eval_from(&self, wo: Vec3, wi: Vec3, _: &Wavelengths<N>) -> (Spectrum<N>, Spectrum<N>) {
        self.eval_local(self.frame.to_local(wo), wi)
    }
}

/// Either.
#[derive(Clone, Copy, Debug)]
#[expect(clippy::large_enum_variant, reason = "a path has one at a time, and most are surfaces")]
pub(crate) enum Site<'s, const N: usize> {
    /// In a medium.
    Medium(MediumSite<'s, N>),
    /// On a surface.
    Surface(SurfaceSite<'s, N>),
}
