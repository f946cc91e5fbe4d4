//! Grids of RGB coefficients, as pbrt-v4's `rgbgrid`: every voxel's colours become smooth spectra, and it is the spectra
//! that are interpolated.

use super::{MediumModel, Point};
use crate::{
    TransportError,
    error::check,
    media::{
        density::{Corners, Edge, Extrema, Lattice, bounds_of, cells_of, reach},
        majorant::Cells,
    },
};
use tyndall_base::Vec3;
use tyndall_geometry::Bounds3;
use tyndall_scatter::phase::{Mixture, PhaseFunction};
use tyndall_spectral::SpaceName;
use tyndall_spectral::{
    Emission, LambdaRange, Spectrum, Wavelengths, curve::SigmoidPolynomial, upsample::RgbTable,
};

/// A spectrum: a factor and a sigmoid.
#[derive(Clone, Copy, Debug)]
pub struct Rgb {
    scale: f32,
    sigmoid: SigmoidPolynomial,
}

impl Rgb {
    /// The smooth spectrum of an RGB value >= 0, as pbrt-v4's unbounded spectra: from the table.
    pub fn new(space: SpaceName, rgb: [f32; 3], factor: f32) -> Result<Self, TransportError> {
        for c in rgb {
            check(c >= 0.0 && c.is_finite(), "colour of a grid", "finite and >= 0", f64::from(c))?;
        }
        let m = 2.0 * rgb[0].max(rgb[1]).max(rgb[2]);
        if m == 0.0 {
            return Ok(Self { scale: 0.0, sigmoid: SigmoidPolynomial::constant(0.0) });
        }
        let sigmoid = RgbTable::get(space).coefficients(rgb.map(|c| c / m));
        Ok(Self { scale: m * factor, sigmoid })
    }

    /// The same value at every wavelength.
    pub fn grey(value: f32) -> Self {
        Self { scale: 2.0 * value, sigmoid: SigmoidPolynomial::constant(0.5) }
    }

    #[inline(always)]
    fn add<const N: usize>(&self, weight: f32, w: &Wavelengths<N>, sum: &mut Spectrum<N>) {
        let scale = weight * self.scale;
        if scale > 0.0 {
            *sum += Spectrum::from_fn(|k| scale * self.sigmoid.eval(w.lambda[k]));
        }
    }
}

/// See the module.
#[derive(Clone, Debug)]
pub struct RgbGrid {
    /// Voxels along each axis.
    pub dims: [usize; 3],
    /// Absorption coefficients \[1/m\]; 1 everywhere where absent.
    pub sigma_a: Option<Vec<Rgb>>,
    /// Scattering coefficients \[1/m\]; 1 everywhere where absent.
    pub sigma_s: Option<Vec<Rgb>>,
    /// Of an absent grid: the constant times the scale.
    pub absent: f32,
    /// Source radiance over `white`.
    pub le: Option<Vec<Rgb>>,
    /// The white that emission multiplies.
    pub white: Option<Emission>,
    /// What lies beyond the outermost centres.
    pub edge: Edge,
    /// Distribution of scattered directions.
    pub phase: PhaseFunction,
    /// Wavelengths over which majorants hold.
    pub range: LambdaRange,
}

/// The wavelengths, and the white at them.
#[derive(Clone, Copy, Debug)]
pub struct Prepared<'m, const N: usize> {
    w: &'m Wavelengths<N>,
    white: Spectrum<N>,
}

impl RgbGrid {
    #[inline(always)]
    fn lattice(&self) -> Lattice {
        Lattice { dims: self.dims, edge: self.edge }
    }

    #[inline(always)]
    fn blend<const N: usize>(grid: &[Rgb], corners: &Corners, w: &Wavelengths<N>) -> Spectrum<N> {
        let mut sum = Spectrum::ZERO;
        for (weight, voxel) in corners {
            if let Some(voxel) = voxel {
                grid[*voxel].add(*weight, w, &mut sum);
            }
        }
        sum
    }

    #[inline(always)]
    fn coefficients<const N: usize>(&self, corners: &Corners, w: &Wavelengths<N>) -> [Spectrum<N>; 2] {
        let one = |grid: &Option<Vec<Rgb>>| {
            grid.as_ref().map_or(Spectrum::splat(self.absent), |g| Self::blend(g, corners, w))
        };
        [one(&self.sigma_a), one(&self.sigma_s)]
    }
}

impl MediumModel for RgbGrid {
    type Prepared<'m, const N: usize> = Prepared<'m, N>;

    #[inline]
    fn prepare<'m, const N: usize>(&'m self, w: &'m Wavelengths<N>) -> Prepared<'m, N> {
        Prepared { w, white: self.white.as_ref().map_or(Spectrum::ZERO, |e| e.sample(w)) }
    }

    #[inline(always)]
    fn unit<const N: usize>(&self, _: &Prepared<'_, N>) -> Spectrum<N> {
        Spectrum::ONE
    }

    #[inline]
    fn extinction<'m, const N: usize>(&'m self, p: Vec3, s: &Prepared<'m, N>) -> Spectrum<N> {
        let [a, sigma_s] = self.coefficients(&self.lattice().corners(p), s.w);
        a + sigma_s
    }

    #[inline]
    fn at<'m, const N: usize>(&'m self, p: Vec3, s: &Prepared<'m, N>) -> Point<N> {
        let corners = self.lattice().corners(p);
        let [sigma_a, sigma_s] = self.coefficients(&corners, s.w);
        let le = self.le.as_ref().map_or(Spectrum::ZERO, |g| Self::blend(g, &corners, s.w) * s.white);
        Point { sigma_a, sigma_s, emitted: sigma_a * le }
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
        let range = self.range;
        let one = |grid: &Option<Vec<Rgb>>, voxel: Option<usize>| match (grid, voxel) {
            (None, _) => [self.absent; 2],
            (Some(_), None) => [0.0; 2],
            (Some(g), Some(i)) => g[i].sigmoid.bounds(range).map(|v| v * g[i].scale),
        };
        reach(b, self.dims).fold(Extrema::NONE, |e, at| {
            let voxel = self.lattice().voxel(at.map(|i| i as i32));
            let (a, s) = (one(&self.sigma_a, voxel), one(&self.sigma_s, voxel));
            e.with(a[0] + s[0]).with(a[1] + s[1])
        })
    }

    fn bounds(&self) -> Bounds3 {
        bounds_of(self.dims)
    }

    fn cells(&self) -> Cells {
        cells_of(self.dims)
    }

    fn detail(&self) -> f32 {
        1.0
    }

    fn thickness(&self, _: LambdaRange) -> f32 {
        1.0
    }

    fn emission(&self) -> Option<&Emission> {
        self.le.as_ref().and(self.white.as_ref())
    }
}
