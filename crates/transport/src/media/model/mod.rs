//! Media whose coefficients vary in space, one file per kind. All points are in the space of the medium's grid.

mod mixed;
mod rgb;
mod separable;
mod spectral;

pub use mixed::{Mixed, PreparedSpecies};
pub use rgb::{Rgb, RgbGrid};
pub use separable::Separable;
pub use spectral::SpectralGrid;

use super::{density::Extrema, majorant::Cells};
use tyndall_base::Vec3;
use tyndall_geometry::Bounds3;
use tyndall_scatter::phase::Mixture;
use tyndall_spectral::{Emission, LambdaRange, Spectrum, Wavelengths};

/// What a medium does to light at a point.
#[derive(Clone, Copy, Debug)]
pub struct Point<const N: usize> {
    /// Absorption coefficient \[1/m\].
    pub sigma_a: Spectrum<N>,
    /// Scattering coefficient \[1/m\].
    pub sigma_s: Spectrum<N>,
    /// `sigma_a le`: power emitted per volume and solid angle \[W m^-3 sr^-1 nm^-1\].
    pub emitted: Spectrum<N>,
}

impl<const N: usize> Point<N> {
    /// Vacuum.
    pub const NOTHING: Self =
        Self { sigma_a: Spectrum::ZERO, sigma_s: Spectrum::ZERO, emitted: Spectrum::ZERO };
}

/// What the tracking loops ask of a medium; the kind is chosen once a ray, by [`super::Heterogeneous::visit`].
///
/// The majorant is a scalar density over space times [`Self::unit`], a spectrum.
pub trait MediumModel {
    /// What depends on the wavelengths alone.
    type Prepared<'m, const N: usize>
    where
        Self: 'm;
    /// Evaluates the spectra at the path's wavelengths.
    fn prepare<'m, const N: usize>(&'m self, w: &'m Wavelengths<N>) -> Self::Prepared<'m, N>;
    /// The same where `sigma_a` and `sigma_s` of density 1 may be known, of media that are a density times these.
    #[inline(always)]
    fn prepare_known<'m, const N: usize>(
        &'m self,
        w: &'m Wavelengths<N>,
        _: Option<[Spectrum<N>; 2]>,
    ) -> Self::Prepared<'m, N> {
        self.prepare(w)
    }
    /// Majorant \[1/m\] per unit of majorant density.
    fn unit<const N: usize>(&self, prepared: &Self::Prepared<'_, N>) -> Spectrum<N>;
    /// `sigma_t` \[1/m\] at `p`.
    fn extinction<'m, const N: usize>(&'m self, p: Vec3, prepared: &Self::Prepared<'m, N>) -> Spectrum<N>;
    /// All coefficients at `p`.
    fn at<'m, const N: usize>(&'m self, p: Vec3, prepared: &Self::Prepared<'m, N>) -> Point<N>;
    /// What scatters at `p`, where the scattering coefficient is `sigma_s`.
    fn scattering<'m, const N: usize>(
        &'m self,
        p: Vec3,
        sigma_s: Spectrum<N>,
        prepared: &Self::Prepared<'m, N>,
    ) -> Mixture<'m, N>;

    /// Bounds of the majorant density over a box.
    fn extrema(&self, b: Bounds3) -> Extrema;
    /// Least and greatest value of the unit spectrum on a range of wavelengths.
    fn unit_bounds(&self, _: LambdaRange) -> [f32; 2] {
        [1.0; 2]
    }
    /// Where the medium varies.
    fn bounds(&self) -> Bounds3;
    /// The cells that majorants are kept for.
    fn cells(&self) -> Cells;
    /// Length over which it varies.
    fn detail(&self) -> f32;
    /// Mean majorant over wavelength per unit of density \[1/m\].
    fn thickness(&self, range: LambdaRange) -> f32;
    /// An emission of the kind found in the medium.
    fn emission(&self) -> Option<&Emission>;
}

/// Mean over wavelength by 64 midpoints.
fn mean(range: LambdaRange, f: impl Fn(f32) -> f32) -> f32 {
    const STEPS: usize = 64;
    let at = |i: usize| range.min + range.width() * (i as f32 + 0.5) / STEPS as f32;
    (0..STEPS).map(|i| f(at(i))).sum::<f32>() / STEPS as f32
}
