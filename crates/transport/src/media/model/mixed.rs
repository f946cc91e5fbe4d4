//! Several species in one medium, each with its own density, spectra, phase function and emission: coefficients add up,
//! and the phase function is their mean weighted by the scattering coefficients.
//!
//! The space of the mixture is the world; every species keeps its own place.

use super::{MediumModel, Point};
use crate::{
    TransportError,
    media::{
        Cloud, Dense, Heterogeneous, Model,
        density::{Bricks, Extrema},
        majorant::Cells,
        model::{RgbGrid, Separable, SpectralGrid},
    },
};
use std::sync::Arc;
use tyndall_base::Vec3;
use tyndall_geometry::Bounds3;
use tyndall_scatter::phase::{MAX_SPECIES, Mixture};
use tyndall_spectral::{Emission, LambdaRange, Spectrum, Wavelengths};

/// Finest cells along the longest axis.
const CELLS: f32 = 32.0;

/// See the module.
#[derive(Clone, Debug)]
pub struct Mixed {
    species: Vec<Arc<Heterogeneous>>,
    bounds: Bounds3,
}

/// The prepared spectra of one species.
#[derive(Clone, Copy, Debug)]
pub enum PreparedSpecies<'m, const N: usize> {
    /// Of a regular grid.
    Dense(<Separable<Dense> as MediumModel>::Prepared<'m, N>),
    /// Of a sparse grid.
    Sparse(<Separable<Bricks> as MediumModel>::Prepared<'m, N>),
    /// Of a cloud.
    Cloud(<Separable<Cloud> as MediumModel>::Prepared<'m, N>),
    /// Of a grid of colours.
    Rgb(<RgbGrid as MediumModel>::Prepared<'m, N>),
    /// Of a grid of bands.
    Spectral(<SpectralGrid as MediumModel>::Prepared<'m, N>),
}

/// Runs `$body` with the model of a species and what was prepared for it.
macro_rules! with_species {
    ($model:expr, $prepared:expr, ($m:ident, $s:ident) => $body:expr, $else:expr) => {
        match ($model, $prepared) {
            (Model::Dense($m), PreparedSpecies::Dense($s)) => $body,
            (Model::Sparse($m), PreparedSpecies::Sparse($s)) => $body,
            (Model::Cloud($m), PreparedSpecies::Cloud($s)) => $body,
            (Model::Rgb($m), PreparedSpecies::Rgb($s)) => $body,
            (Model::Spectral($m), PreparedSpecies::Spectral($s)) => $body,
            _ => $else,
        }
    };
}

impl Mixed {
    /// Of two to [`MAX_SPECIES`] media that are no mixtures themselves.
    pub fn new(species: Vec<Arc<Heterogeneous>>) -> Result<Self, TransportError> {
        let bad = |why: String| TransportError::Unusable { what: "mixture of media", why };
        if species.is_empty() || species.len() > MAX_SPECIES {
            return Err(bad(format!("expected 1 to {MAX_SPECIES} media, got {}", species.len())));
        }
        if species.iter().any(|s| matches!(s.model(), Model::Mixed(_))) {
            return Err(bad("a mixture cannot be part of another".into()));
        }
        let bounds = species.iter().fold(Bounds3::EMPTY, |b, s| b.union(s.bounds()));
        Ok(Self { species, bounds })
    }

    /// The point in the space of a species, where it is inside.
    #[inline(always)]
    fn inside(species: &Heterogeneous, p: Vec3) -> Option<Vec3> {
        let p = species.to_grid(p);
        species.grid_bounds().contains(p).then_some(p)
    }

    /// Sums `f` over the species that reach `p`.
    #[inline(always)]
    fn each<'m, const N: usize>(
        &'m self,
        p: Vec3,
        prepared: &[Option<PreparedSpecies<'m, N>>; MAX_SPECIES],
        mut f: impl FnMut(&'m Model, &PreparedSpecies<'m, N>, Vec3),
    ) {
        for (species, prepared) in self.species.iter().zip(prepared) {
            if let (Some(prepared), Some(q)) = (prepared, Self::inside(species, p)) {
                f(species.model(), prepared, q);
            }
        }
    }
}

impl MediumModel for Mixed {
    type Prepared<'m, const N: usize> = [Option<PreparedSpecies<'m, N>>; MAX_SPECIES];

    fn prepare<'m, const N: usize>(&'m self, w: &'m Wavelengths<N>) -> Self::Prepared<'m, N> {
        let mut all = [None; MAX_SPECIES];
        for (slot, species) in all.iter_mut().zip(&self.species) {
            *slot = match species.model() {
                Model::Dense(m) => Some(PreparedSpecies::Dense(m.prepare(w))),
                Model::Sparse(m) => Some(PreparedSpecies::Sparse(m.prepare(w))),
                Model::Cloud(m) => Some(PreparedSpecies::Cloud(m.prepare(w))),
                Model::Rgb(m) => Some(PreparedSpecies::Rgb(m.prepare(w))),
                Model::Spectral(m) => Some(PreparedSpecies::Spectral(m.prepare(w))),
                Model::Mixed(_) => None,
            };
        }
        all
    }

    #[inline(always)]
    fn unit<const N: usize>(&self, _: &Self::Prepared<'_, N>) -> Spectrum<N> {
        Spectrum::ONE
    }

    fn extinction<'m, const N: usize>(&'m self, p: Vec3, prepared: &Self::Prepared<'m, N>) -> Spectrum<N> {
        let mut sum = Spectrum::ZERO;
        self.each(p, prepared, |model, s, q| {
            sum += with_species!(model, s, (m, s) => m.extinction(q, s), Spectrum::ZERO);
        });
        sum
    }

    fn at<'m, const N: usize>(&'m self, p: Vec3, prepared: &Self::Prepared<'m, N>) -> Point<N> {
        let mut sum = Point::NOTHING;
        self.each(p, prepared, |model, s, q| {
            let point = with_species!(model, s, (m, s) => m.at(q, s), Point::NOTHING);
            sum.sigma_a += point.sigma_a;
            sum.sigma_s += point.sigma_s;
            sum.emitted += point.emitted;
        });
        sum
    }

    fn scattering<'m, const N: usize>(
        &'m self,
        p: Vec3,
        _: Spectrum<N>,
        prepared: &Self::Prepared<'m, N>,
    ) -> Mixture<'m, N> {
        let mut mixture = Mixture::NONE;
        self.each(p, prepared, |model, s, q| {
            let one = with_species!(model, s, (m, s) => {
                let sigma_s = m.at(q, s).sigma_s;
                m.scattering(q, sigma_s, s)
            }, Mixture::NONE);
            for (sigma_s, phase) in one.species() {
                mixture.push(*sigma_s, phase);
            }
        });
        mixture
    }

    fn extrema(&self, b: Bounds3) -> Extrema {
        let mut sum = Extrema { max: 0.0, min: 0.0 };
        for species in &self.species {
            let e = species.extinction_bounds(b);
            sum = Extrema { max: sum.max + e.max, min: sum.min + e.min };
        }
        sum
    }

    fn bounds(&self) -> Bounds3 {
        self.bounds
    }

    fn cells(&self) -> Cells {
        let e = self.bounds.extent();
        let edge = e.max_component() / CELLS;
        let dims = [e.x, e.y, e.z].map(|v| ((v / edge).ceil() as usize).max(1));
        Cells { origin: self.bounds.lo, edge: Vec3::splat(edge), dims }
    }

    fn detail(&self) -> f32 {
        self.species.iter().map(|s| s.detail()).fold(f32::INFINITY, f32::min)
    }

    fn thickness(&self, _: LambdaRange) -> f32 {
        1.0
    }

    fn emission(&self) -> Option<&Emission> {
        self.species.iter().find_map(|s| s.emission())
    }
}
