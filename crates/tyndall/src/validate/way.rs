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
    /// So many wavelengths at equal distances in each band.
    FixedSet(u32),
    Clusters(u32),
    /// All of a set with one wavelength in the middle of each band.
    Means,
}

const fn way(name: &'static str, integrator: &'static str, kind: Kind, effort: f64) -> Way {
    Way { name, integrator, kind, pdf: WavelengthPdf::Uniform, effort }
}

/// All of them; the first one renders every case at every depth.
pub const WAYS: [Way; 11] = [
    way("hero 8", "volpath", Kind::Hero(8), 1.0),
    way("hero 4", "volpath", Kind::Hero(4), 1.0),
    way("hero 16", "volpath", Kind::Hero(16), 0.5),
    Way { pdf: WavelengthPdf::Light, ..way("hero 8, light", "volpath", Kind::Hero(8), 0.5) },
    way("opow", "volpath", Kind::Continuum, 2.0),
    way("opow, 1 a band", "volpath", Kind::FixedSet(1), 2.0),
    way("opow, 3 a band", "volpath", Kind::FixedSet(3), 2.0),
    way("swc 8", "volpath", Kind::Clusters(8), 1.0),
    way("opaw", "volpath", Kind::Means, 1.0),
    way("wang-chern", "wang-chern", Kind::Continuum, 2.0),
    way("analog", "analog", Kind::Continuum, 2.0),
];

impl Way {
    /// Whether this way has the case's answer as its mean.
    pub fn can(&self, case: &Case) -> bool {
        // neither samples lights
        let meets = case.by_chance || self.integrator == "volpath";
        let closed = self.integrator == "wang-chern" || matches!(self.kind, Kind::Clusters(_) | Kind::Means);
        // nodes in the middle of bands know nothing of what varies within them
        let set = matches!(self.kind, Kind::FixedSet(_) | Kind::Means);
        let means = matches!(self.kind, Kind::Means);
        meets
            && (case.homogeneous() || !closed)
            && !(set && case.measured == Measured::Xyz)
            && (case.grey || !means)
    }

    /// The strategy for a number of bands.
    pub fn spectral(&self, bands: usize) -> Spectral {
        let set = |each: u32| (each * bands as u32, Rule::Midpoint);
        match self.kind {
            Kind::Hero(wavelengths) => Spectral::Hero { wavelengths },
            Kind::Continuum => Spectral::Opow { set: None },
            Kind::FixedSet(each) => Spectral::Opow { set: Some(set(each)) },
            Kind::Clusters(wavelengths) => Spectral::Swc { wavelengths },
            Kind::Means => Spectral::Opaw { set: set(1) },
        }
    }

    /// Wavelengths on a path, of a film with so many bands.
    pub fn lanes(&self, bands: usize) -> u32 {
        match self.kind {
            Kind::Hero(n) | Kind::Clusters(n) => n,
            Kind::Means => bands as u32,
            Kind::Continuum | Kind::FixedSet(_) => 1,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::validate::Bands;

    fn able(case: &Case) -> Vec<&'static str> {
        WAYS.iter().filter(|w| w.can(case)).map(|w| w.name).collect()
    }

    #[test]
    fn ways_keep_to_what_they_can() {
        let case = |text: &str| Case::new("c", Bands::new(4), text.into(), vec![1.0; 4]);
        let all: Vec<_> = WAYS.iter().map(|w| w.name).collect();
        assert_eq!(able(&case("").grey()), all);
        let without = |out: &[&str]| -> Vec<_> { all.iter().copied().filter(|n| !out.contains(n)).collect() };
        assert_eq!(able(&case("")), without(&["opaw"]));
        assert_eq!(able(&case("").light_sampling_only()), without(&["opaw", "wang-chern", "analog"]));
        assert_eq!(able(&case("\"uniformgrid\"")), without(&["opaw", "wang-chern", "swc 8"]));
        let xyz = case("").xyz(Bands::new(4).range(), 1.0);
        assert_eq!(able(&xyz), without(&["opaw", "opow, 1 a band", "opow, 3 a band"]));
    }
}
