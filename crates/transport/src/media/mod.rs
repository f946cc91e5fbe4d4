//! Participating media: coefficients \[1/m\] per wavelength, emission and phase function.

mod coarse;
pub mod density;
pub mod emission;
mod heterogeneous;
mod homogeneous;
mod length;
pub mod majorant;
pub mod model;
mod painted;

pub use density::{Bricks, Cloud, Dense, Edge};
pub use heterogeneous::{Heterogeneous, Model, Visitor};
pub use homogeneous::Homogeneous;
pub use painted::{Paint, Painted, albedo_of};

use std::sync::Arc;
use tyndall_scatter::phase::PhaseFunction;
use tyndall_spectral::{Spectrum, Wavelengths};

/// What a medium does to light at one point, at the wavelengths of a path.
#[derive(Clone, Copy, Debug)]
pub struct MediumProperties<'m, const N: usize> {
    /// Absorption coefficient \[1/m\].
    pub sigma_a: Spectrum<N>,
    /// Scattering coefficient \[1/m\].
    pub sigma_s: Spectrum<N>,
    /// Source radiance \[W m^-2 sr^-1 nm^-1\]: the medium emits `sigma_a le` per metre.
    pub le: Spectrum<N>,
    /// Distribution of scattered directions.
    pub phase: &'m PhaseFunction,
}

impl<const N: usize> MediumProperties<'_, N> {
    /// Extinction coefficient \[1/m\].
    #[inline(always)]
    pub fn sigma_t(&self) -> Spectrum<N> {
        self.sigma_a + self.sigma_s
    }
}

/// Any medium.
#[derive(Clone, Debug)]
pub enum Medium {
    /// The same everywhere.
    Homogeneous(Homogeneous),
    /// Varying in space.
    Heterogeneous(Arc<Heterogeneous>),
    /// The same everywhere for a path, as the point says where it entered.
    Painted(Box<Painted>),
}

impl Medium {
    /// The source radiance, if the medium emits: where it varies, of the kind found in it.
    pub fn emission(&self) -> Option<&tyndall_spectral::Emission> {
        match self {
            Self::Homogeneous(m) => m.le.as_ref(),
            Self::Heterogeneous(m) => m.emission(),
            Self::Painted(_) => None,
        }
    }

    /// The properties of a homogeneous medium; `None` where they depend on the point.
    #[inline(always)]
    pub fn homogeneous<const N: usize>(&self, w: &Wavelengths<N>) -> Option<MediumProperties<'_, N>> {
        match self {
            Self::Homogeneous(m) => Some(m.at(w)),
            Self::Heterogeneous(_) | Self::Painted(_) => None,
        }
    }
}
