//! Phase functions: the density \[1/sr\] of the direction after a scattering in a medium, at each wavelength.
//!
//! `wo` and `wi` are unit vectors that point away from the point of scattering, so `cos theta = -wo . wi`, and light
//! that goes straight on has `wi = -wo`. Every phase function is normalised, `int p dwi = 1`, and sampled exactly: its
//! value *is* the density of [`PhaseFunction::sample`], per lane.

pub mod deflection;
pub mod draine;
pub mod fournier_forand;
pub mod henyey_greenstein;
mod invert;
pub mod mixture;
pub mod rayleigh;
pub mod schlick;
pub mod tabulated;
pub mod two_lobe;

pub use deflection::{Deflection, versine};
pub use draine::Draine;
pub use fournier_forand::FournierForand;
pub use henyey_greenstein::HenyeyGreenstein;
pub use mixture::{MAX_SPECIES, Mixture};
pub use rayleigh::Rayleigh;
pub use schlick::Schlick;
pub use tabulated::Tabulated;
pub use two_lobe::TwoLobe;

use std::f32::consts::FRAC_1_PI;
use tyndall_base::vec::Vec3;
use tyndall_base::warp::sample_uniform_sphere;
use tyndall_spectral::curve::Curve;
use tyndall_spectral::range::{LambdaRange, RangeGap};
use tyndall_spectral::{SpectralError, Spectrum, Wavelengths};

/// A sampled direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhaseSample<const N: usize> {
    /// Where the path goes on.
    pub wi: Vec3,
    /// Phase function \[1/sr\] per lane. Lane 0 is also the density the direction was drawn with, lane `k` the density
    /// it would have had if lane `k` were the hero.
    pub p: Spectrum<N>,
}

/// The models, matched once per call.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum PhaseFunction {
    /// `p = 1 / 4 pi`.
    Isotropic,
    /// One lobe, `g(lambda)`.
    HenyeyGreenstein(HenyeyGreenstein),
    /// Molecules.
    Rayleigh(Rayleigh),
    /// Small particles; Cornette & Shanks with `alpha = 1`.
    Draine(Draine),
    /// Schlick's lobe.
    Schlick(Schlick),
    /// Two Henyey-Greenstein lobes.
    TwoLobe(TwoLobe),
    /// Sea water.
    FournierForand(FournierForand),
    /// A table over wavelength and angle.
    Tabulated(Tabulated),
}

impl PhaseFunction {
    /// `p(wo, wi)` \[1/sr\] per lane.
    #[inline(always)]
    pub fn eval<const N: usize>(&self, wo: Vec3, wi: Vec3, lambda: &Wavelengths<N>) -> Spectrum<N> {
        match self {
            Self::Isotropic => Spectrum::splat(0.25 * FRAC_1_PI),
            Self::HenyeyGreenstein(p) => p.eval(versine(wo, wi), lambda),
            Self::Rayleigh(p) => p.eval(versine(wo, wi), lambda),
            Self::Draine(p) => p.eval(versine(wo, wi), lambda),
            Self::Schlick(p) => p.eval(versine(wo, wi), lambda),
            Self::TwoLobe(p) => p.eval(versine(wo, wi), lambda),
            Self::FournierForand(p) => Spectrum::splat(p.eval(versine(wo, wi))),
            Self::Tabulated(p) => p.eval(versine(wo, wi), lambda),
        }
    }

    /// Draws `wi` with the hero's phase function; `u` in \[0, 1)^2.
    #[inline(always)]
    pub fn sample<const N: usize>(&self, wo: Vec3, u: [f32; 2], lambda: &Wavelengths<N>) -> PhaseSample<N> {
        let (angle, p) = match self {
            Self::Isotropic => {
                let p = Spectrum::splat(0.25 * FRAC_1_PI);
                return PhaseSample { wi: sample_uniform_sphere(u), p };
            }
            Self::HenyeyGreenstein(p) => drawn(p.sample(u[0], lambda.hero()), |v| p.eval(v, lambda)),
            Self::Rayleigh(p) => drawn(p.sample(u[0], lambda.hero()), |v| p.eval(v, lambda)),
            Self::Draine(p) => drawn(p.sample(u[0], lambda.hero()), |v| p.eval(v, lambda)),
            Self::Schlick(p) => drawn(p.sample(u[0], lambda.hero()), |v| p.eval(v, lambda)),
            Self::TwoLobe(p) => drawn(p.sample(u[0], lambda.hero()), |v| p.eval(v, lambda)),
            Self::FournierForand(p) => drawn(p.sample(u[0]), |v| Spectrum::splat(p.eval(v))),
            Self::Tabulated(p) => drawn(p.sample(u[0], lambda.hero()), |v| p.eval(v, lambda)),
        };
        PhaseSample { wi: angle.apply(wo, u[1]), p }
    }

    /// `<cos theta>` at `lambda` \[nm\].
    pub fn mean_cosine(&self, lambda: f32) -> f32 {
        match self {
            Self::Isotropic => 0.0,
            Self::HenyeyGreenstein(p) => p.mean_cosine(lambda),
            Self::Rayleigh(p) => p.mean_cosine(),
            Self::Draine(p) => p.mean_cosine(lambda),
            Self::Schlick(p) => p.mean_cosine(lambda),
            Self::TwoLobe(p) => p.mean_cosine(lambda),
            Self::FournierForand(p) => p.mean_cosine(),
            Self::Tabulated(p) => p.mean_cosine(lambda),
        }
    }

    /// An error when a table whose rule is [`Outside::Error`](tyndall_spectral::range::Outside::Error) does not cover `asked`, else the first gap to warn of.
    pub fn check_range(&self, asked: LambdaRange) -> Result<Option<RangeGap>, SpectralError> {
        let curves: &[&Curve] = match self {
            Self::Tabulated(p) => return p.check_range(asked),
            Self::Isotropic | Self::FournierForand(_) => &[],
            Self::HenyeyGreenstein(p) => &[p.g()],
            Self::Rayleigh(p) => &[p.depolarisation()],
            Self::Schlick(p) => &[p.k()],
            Self::Draine(p) => &p.curves(),
            Self::TwoLobe(p) => &p.curves(),
        };
        let gaps: Result<Vec<_>, _> = curves.iter().map(|c| c.check_range(asked)).collect();
        Ok(gaps?.into_iter().flatten().next())
    }
}

/// An angle and the phase function at exactly that angle.
#[inline(always)]
fn drawn<const N: usize>(angle: Deflection, p: impl Fn(f32) -> Spectrum<N>) -> (Deflection, Spectrum<N>) {
    (angle, p(angle.versine))
}

#[cfg(test)]
mod mixture_tests;
#[cfg(test)]
mod tabulated_tests;
#[cfg(test)]
mod tests;
