//! Bidirectional scattering distribution functions of surfaces, in the local shading frame (z = shading normal).
//!
//! `wo` and `wi` are unit vectors that point away from the surface; `wo` is the side the path comes from. A [`Bsdf`] is
//! built by value at each hit from the material's parameters at the path's wavelengths, which must be in range
//! (reflectances in \[0, 1\], indices > 0): whoever reads or interpolates them clamps or refuses.

pub mod coated;
pub mod conductor;
pub mod dielectric;
pub mod diffuse;
pub mod diffuse_transmission;
pub mod flags;
pub mod fresnel;
pub mod hair;
pub mod measured;
pub mod microfacet;
pub mod thin_dielectric;

pub use coated::Coated;
pub use conductor::Conductor;
pub use dielectric::Dielectric;
pub use diffuse::Diffuse;
pub use diffuse_transmission::DiffuseTransmission;
pub use flags::BsdfFlags;
pub use hair::Hair;
pub use measured::{Measured, MeasuredTables};
pub use microfacet::TrowbridgeReitz;
pub use thin_dielectric::ThinDielectric;

use tyndall_base::vec::Vec3;
use tyndall_spectral::Spectrum;

/// What the path carries from `wi` to `wo`: decides the factor `1 / etap^2` of refraction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TransportMode {
    /// Paths from the camera carry radiance back.
    #[default]
    Radiance,
    /// Paths from the lights (adjoint).
    Importance,
}

/// A sampled direction.
///
/// Weight per lane of the path: `f |cos wi| / pdf`. Lane `k` of `pdf` is the density \[1/sr\] the direction would have had
/// if lane `k` were the hero; the direction was drawn with lane 0's, which is > 0. For a delta event both `f |cos wi|`
/// and `pdf` are the factors of the Dirac delta, so `pdf` is the probability of the choice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfSample<const N: usize> {
    /// BSDF without the cosine.
    pub f: Spectrum<N>,
    /// Where the path goes on.
    pub wi: Vec3,
    /// Density per lane.
    pub pdf: Spectrum<N>,
    /// `n(side of wi) / n(side of wo)` for the hero; 1 unless refracted.
    pub eta: f32,
    /// The event.
    pub flags: BsdfFlags,
}

impl<const N: usize> BsdfSample<N> {
    /// A density; `None` where the hero's is zero or not finite (a grazing direction has no event).
    #[inline(always)]
    fn smooth((f, pdf): (Spectrum<N>, Spectrum<N>), wi: Vec3, eta: f32, flags: BsdfFlags) -> Option<Self> {
        (pdf.hero() > 0.0 && pdf.hero().is_finite()).then_some(Self { f, wi, pdf, eta, flags })
    }

    /// A delta event of `weight = f |cos wi|`; `None` where its probability is zero.
    #[inline(always)]
    fn delta(weight: Spectrum<N>, wi: Vec3, pdf: Spectrum<N>, eta: f32, flags: BsdfFlags) -> Option<Self> {
        (wi.z != 0.0 && pdf.hero() > 0.0).then(|| Self {
            f: weight * (1.0 / wi.z.abs()),
            wi,
            pdf,
            eta,
            flags,
        })
    }
}

/// The models, matched once per call.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Bsdf<'m, const N: usize> {
    /// Lambertian reflection.
    Diffuse(Diffuse<N>),
    /// Lambertian reflection and transmission.
    DiffuseTransmission(DiffuseTransmission<N>),
    /// Metal, smooth or rough.
    Conductor(Conductor<N>),
    /// Glass or water, smooth or rough, dispersive.
    Dielectric(Dielectric<N>),
    /// A thin plate.
    ThinDielectric(ThinDielectric<N>),
    /// A surface under a dielectric coat.
    Coated(Coated<N>),
    /// A fibre.
    Hair(Hair<N>),
    /// Tables of a real surface.
    Measured(Measured<'m, N>),
}

impl<const N: usize> Bsdf<'_, N> {
    /// BSDF `f(wo, wi)` \[1/sr\] per lane, without the cosine; zero for delta events.
    #[inline(always)]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Spectrum<N> {
        match self {
            Self::Diffuse(b) => b.eval(wo, wi),
            Self::DiffuseTransmission(b) => b.eval(wo, wi),
            Self::Conductor(b) => b.eval_pdf(wo, wi).0,
            Self::Dielectric(b) => b.eval_pdf(wo, wi).0,
            Self::ThinDielectric(_) => Spectrum::ZERO,
            Self::Coated(b) => b.eval(wo, wi),
            Self::Hair(b) => b.eval_pdf(wo, wi).0,
            Self::Measured(b) => b.eval_pdf(wo, wi).0,
        }
    }

    /// Density \[1/sr\] of [`sample`](Self::sample) per lane, as if that lane were the hero; zero for delta events.
    #[inline(always)]
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> Spectrum<N> {
        match self {
            Self::Diffuse(b) => b.pdf(wo, wi),
            Self::DiffuseTransmission(b) => b.pdf(wo, wi),
            Self::Conductor(b) => b.eval_pdf(wo, wi).1,
            Self::Dielectric(b) => b.eval_pdf(wo, wi).1,
            Self::ThinDielectric(_) => Spectrum::ZERO,
            Self::Coated(b) => b.pdf(wo, wi),
            Self::Hair(b) => b.eval_pdf(wo, wi).1,
            Self::Measured(b) => b.eval_pdf(wo, wi).1,
        }
    }

    /// [`eval`](Self::eval) and [`pdf`](Self::pdf) together: half the work of both for rough surfaces.
    #[inline(always)]
    pub fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Spectrum<N>, Spectrum<N>) {
        match self {
            Self::Diffuse(b) => (b.eval(wo, wi), b.pdf(wo, wi)),
            Self::DiffuseTransmission(b) => (b.eval(wo, wi), b.pdf(wo, wi)),
            Self::Conductor(b) => b.eval_pdf(wo, wi),
            Self::Dielectric(b) => b.eval_pdf(wo, wi),
            Self::ThinDielectric(_) => (Spectrum::ZERO, Spectrum::ZERO),
            Self::Coated(b) => (b.eval(wo, wi), b.pdf(wo, wi)),
            Self::Hair(b) => b.eval_pdf(wo, wi),
            Self::Measured(b) => b.eval_pdf(wo, wi),
        }
    }

    /// Draws `wi` for the hero; `uc` chooses the event, `u` the direction, all in \[0, 1). `None`: the path ends here.
    #[inline(always)]
    pub fn sample(&self, wo: Vec3, uc: f32, u: [f32; 2]) -> Option<BsdfSample<N>> {
        if wo.z == 0.0 {
            return None;
        }
        match self {
            Self::Diffuse(b) => b.sample(wo, u),
            Self::DiffuseTransmission(b) => b.sample(wo, uc, u),
            Self::Conductor(b) => b.sample(wo, u),
            Self::Dielectric(b) => b.sample(wo, uc, u),
            Self::ThinDielectric(b) => b.sample(wo, uc),
            Self::Coated(b) => b.sample(wo, uc, u),
            Self::Hair(b) => b.sample(wo, uc, u),
            Self::Measured(b) => b.sample(wo, u),
        }
    }

    /// The events this surface has.
    #[inline(always)]
    pub fn flags(&self) -> BsdfFlags {
        match self {
            Self::Diffuse(_) => Diffuse::<N>::FLAGS,
            Self::DiffuseTransmission(_) => DiffuseTransmission::<N>::FLAGS,
            Self::Conductor(b) => b.flags(),
            Self::Dielectric(b) => b.flags(),
            Self::ThinDielectric(_) => ThinDielectric::<N>::FLAGS,
            Self::Coated(b) => b.flags(),
            Self::Hair(_) => Hair::<N>::FLAGS,
            Self::Measured(_) => Measured::<N>::FLAGS,
        }
    }

    /// True where lanes of another wavelength than the hero's have no value: the path goes on with the hero alone.
    #[inline(always)]
    pub fn wants_hero_only(&self) -> bool {
        matches!(self, Self::Coated(b) if b.is_dispersive())
    }

    /// True when [`eval`](Self::eval) is zero everywhere: light sampling is useless here.
    #[inline(always)]
    pub fn is_delta(&self) -> bool {
        self.flags().is_delta()
    }

    /// The same surface for paths that carry `mode`.
    #[inline(always)]
    pub fn with_mode(mut self, mode: TransportMode) -> Self {
        if let Self::Dielectric(b) = &mut self {
            b.mode = mode;
        }
        self
    }

    /// The same surface with narrow lobes widened ([`TrowbridgeReitz::regularized`]): biased.
    #[inline]
    pub fn regularized(mut self) -> Self {
        match &mut self {
            Self::Conductor(b) => b.distribution = b.distribution.regularized(),
            Self::Dielectric(b) => *b = b.regularized(),
            Self::Coated(b) => *b = b.regularized(),
            _ => {}
        }
        self
    }
}

#[cfg(test)]
mod delta_tests;
#[cfg(test)]
mod tests;
