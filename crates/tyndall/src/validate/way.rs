//! Ways to render: integrators and spectral strategies without bias.

use super::case::{Case, Measured};
use crate::{Spectral, WavelengthPdf};
use tyndall_spectral::strategy::Rule;

/// An integrator with a spectral strategy.
#[derive(Clone, Copy, Debug)]
pub struct Way {
    /// Name in tables.
    pub name: &'static str,
    /// Name of the integrator.
    pub integrator: &'static str,
    kind: Kind,
    /// Density of wavelengths.
    pub pdf: WavelengthPdf,
    /// Samples against those of the first way: cheap and noisy ways take more.
    pub effort: f64,
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    Hero(u32),
    Continuum,
    /// One wavelength in the middle of each band.
    FixedSet,
}

const fn way(name: &'static str, integrator: &'static str, kind: Kind, effort: f64) -> Way {
    Way { name, integrator, kind, pdf: WavelengthPdf::Uniform, effort }
}

/// All of them; the first one renders every case at every depth.
pub const WAYS: [Way; 7] = [
    way("hero 8", "volpath", Kind::Hero(8), 1.0),
    way("hero 4", "volpath", Kind::Hero(4), 1.0),
    way("hero 16", "volpath", Kind::Hero(16), 0.5),
    Way { pdf: WavelengthPdf::Light, ..way("hero 8, light", "volpath", Kind::Hero(8), 0.5) },
    way("opow", "volpath", Kind::Continuum, 2.0),
    way("opow, fixed set", "volpath", Kind::FixedSet, 2.0),
    way("analog", "analog", Kind::Continuum, 2.0),
];

impl Way {
    /// Whether this way has the case's answer as its mean.
    pub fn can(&self, case: &Case) -> bool {
        let meets = case.by_chance || self.integrator != "analog";
        // nodes in the middle of bands know nothing of what varies within them
        meets && !(matches!(self.kind, Kind::FixedSet) && case.measured == Measured::Xyz)
    }

    /// The strategy for a number of bands.
    pub fn spectral(&self, bands: usize) -> Spectral {
        match self.kind {
            Kind::Hero(wavelengths) => Spectral::Hero { wavelengths },
            Kind::Continuum => Spectral::Opow { set: None },
            Kind::FixedSet => Spectral::Opow { set: Some((bands as u32, Rule::Midpoint)) },
        }
    }

    /// Wavelengths on a path.
    pub fn lanes(&self) -> u32 {
        if let Kind::Hero(n) = self.kind { n } else { 1 }
    }
}
