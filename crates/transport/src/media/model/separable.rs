//! `sigma(lambda, p) = density(p) sigma(lambda)`: the spectra are evaluated once a ray, the density once a point for all
//! wavelengths.

use super::{MediumModel, Point, mean};
use crate::media::{
    density::{Density, Extrema},
    emission::Source,
    majorant::Cells,
};
use tyndall_base::Vec3;
use tyndall_geometry::Bounds3;
use tyndall_scatter::phase::{Mixture, PhaseFunction};
use tyndall_spectral::{Curve, Emission, LambdaRange, Spectrum, Wavelengths};

/// Spectra times a density.
#[derive(Clone, Debug)]
pub struct Separable<D> {
    /// The density.
    pub density: D,
    /// Absorption coefficient at density 1 \[1/m\].
    pub sigma_a: Curve,
    /// Scattering coefficient at density 1 \[1/m\].
    pub sigma_s: Curve,
    /// Source radiance, if the medium emits.
    pub source: Option<Source<D>>,
    /// Distribution of scattered directions.
    pub phase: PhaseFunction,
}

/// The spectra at a path's wavelengths.
#[derive(Clone, Copy, Debug)]
pub struct Prepared<'m, const N: usize> {
    sigma_a: Spectrum<N>,
    sigma_s: Spectrum<N>,
    sigma_t: Spectrum<N>,
    le: Spectrum<N>,
    w: &'m Wavelengths<N>,
}

impl<D: Density> MediumModel for Separable<D> {
    type Prepared<'m, const N: usize>
        = Prepared<'m, N>
    where
        D: 'm;

    #[inline]
    fn prepare<'m, const N: usize>(&'m self, w: &'m Wavelengths<N>) -> Prepared<'m, N> {
        self.prepare_known(w, None)
    }

    #[inline(always)]
    fn prepare_known<'m, const N: usize>(
        &'m self,
        w: &'m Wavelengths<N>,
        known: Option<[Spectrum<N>; 2]>,
    ) -> Prepared<'m, N> {
        let [sigma_a, sigma_s] = match known {
            Some(known) => known,
            None => [self.sigma_a.sample(w), self.sigma_s.sample(w)],
        };
        let le = match &self.source {
            Some(Source::Spectrum { le, .. }) => le.sample(w),
            _ => Spectrum::ZERO,
        };
        Prepared { sigma_a, sigma_s, sigma_t: sigma_a + sigma_s, le, w }
    }

    #[inline(always)]
    fn unit<const N: usize>(&self, s: &Prepared<'_, N>) -> Spectrum<N> {
        s.sigma_t
    }

    #[inline(always)]
    fn extinction<'m, const N: usize>(&'m self, p: Vec3, s: &Prepared<'m, N>) -> Spectrum<N> {
        s.sigma_t * self.density.at(p)
    }

    #[inline(always)]
    fn at<'m, const N: usize>(&'m self, p: Vec3, s: &Prepared<'m, N>) -> Point<N> {
        let d = self.density.at(p);
        let sigma_a = s.sigma_a * d;
        let emitted = match &self.source {
            // cold where nothing absorbs
            Some(source) if d > 0.0 => sigma_a * source.at(p, &s.le, s.w),
            _ => Spectrum::ZERO,
        };
        Point { sigma_a, sigma_s: s.sigma_s * d, emitted }
    }

    #[inline(always)]
    fn scattering<'m, const N: usize>(
        &'m self,
        _: Vec3,
        sigma_s: Spectrum<N>,
        _: &Prepared<'m, N>,
    ) -> Mixture<'m, N> {
        Mixture::single(sigma_s, &self.phase)
    }

    fn extrema(&self, b: Bounds3) -> Extrema {
        self.density.extrema(b)
    }

    fn bounds(&self) -> Bounds3 {
        self.density.bounds()
    }

    fn cells(&self) -> Cells {
        self.density.cells()
    }

    fn detail(&self) -> f32 {
        self.density.detail()
    }

    fn thickness(&self, range: LambdaRange) -> f32 {
        mean(range, |l| self.sigma_a.eval(l) + self.sigma_s.eval(l))
    }

    fn unit_bounds(&self, range: LambdaRange) -> [f32; 2] {
        let (a, s) = (self.sigma_a.bounds(range), self.sigma_s.bounds(range));
        [a[0] + s[0], a[1] + s[1]]
    }

    fn emission(&self) -> Option<&Emission> {
        self.source.as_ref().map(Source::typical)
    }
}
