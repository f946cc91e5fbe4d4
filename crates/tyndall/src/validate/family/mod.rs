//! Families of cases: one file a phenomenon.

mod airlight;
mod beer_lambert;
mod colorimetry;
mod dispersion;
mod emitting_slab;
mod fresnel_slab;
mod furnace;
mod invariance;
mod lambertian_ground;
mod path_length;
mod point_source;
mod semi_infinite;
mod slab_flux;
mod slab_radiance;
mod sphere;
mod two_layers;
mod varying;
mod wide_slab;

use super::{bands::Dialect, case::Case};

/// What known answers are good for: a tolerance that other renderers are held to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tolerance {
    /// Of the answer.
    Relative(f64),
    /// In its unit.
    Absolute(f64),
}

impl Tolerance {
    /// For an answer.
    pub fn of(self, expected: f64) -> f64 {
        match self {
            Self::Relative(r) => r * expected.abs(),
            Self::Absolute(a) => a,
        }
    }
}

/// Cases of one phenomenon.
#[derive(Clone, Copy, Debug)]
pub struct Family {
    /// Name on the command line.
    pub name: &'static str,
    /// What is compared.
    pub title: &'static str,
    /// Where the answers come from.
    pub source: &'static str,
    /// Standard errors of half of it resolve an answer.
    pub tolerance: Tolerance,
    /// The cases.
    pub cases: fn(Dialect) -> Vec<Case>,
}

/// All families.
pub const FAMILIES: [Family; 18] = [
    beer_lambert::FAMILY,
    furnace::FAMILY,
    slab_flux::FAMILY,
    slab_radiance::FAMILY,
    semi_infinite::FAMILY,
    fresnel_slab::FAMILY,
    lambertian_ground::FAMILY,
    two_layers::FAMILY,
    sphere::FAMILY,
    point_source::FAMILY,
    airlight::FAMILY,
    emitting_slab::FAMILY,
    path_length::FAMILY,
    wide_slab::FAMILY,
    colorimetry::FAMILY,
    dispersion::FAMILY,
    varying::FAMILY,
    invariance::FAMILY,
];
