//! Grids of K bands per voxel: `sigma_a` and `sigma_s` of every voxel as functions of wavelength, constant in each band.
//!
//! The values of a voxel are the products of one density and K pairs of coefficients nowhere: any voxel may have any
//! spectrum. Interpolation in space is linear, band by band.

use super::{MediumModel, Point};
use crate::{
    TransportError,
    error::check,
    media::{
        density::{Edge, Extrema, Lattice, bounds_of, cells_of, reach},
        majorant::Cells,
    },
};
use tyndall_base::Vec3;
use tyndall_geometry::Bounds3;
use tyndall_scatter::phase::{Mixture, PhaseFunction};
use tyndall_spectral::{Emission, LambdaRange, Spectrum, Wavelengths};

/// Bands at most.
pub const MOST_BANDS: usize = 4096;

/// See the module.
#[derive(Clone, Debug)]
pub struct SpectralGrid {
    dims: [usize; 3],
    /// Limits of the bands \[nm\], ascending.
    edges: Vec<f32>,
    /// Values of a voxel: K pairs of absorption and scattering coefficient.
    values: Vec<[f32; 2]>,
    edge: Edge,
    /// Factor of all coefficients.
    scale: f32,
    phase: PhaseFunction,
}

impl SpectralGrid {
    /// `sigma_a[v K + k]` and `sigma_s` likewise \[1/m\] for voxel `v` (x fastest) and band `k` between `edges[k]` and
    /// `edges[k + 1]` \[nm\].
    pub fn new(
        dims: [usize; 3],
        edges: Vec<f32>,
        [sigma_a, sigma_s]: [&[f32]; 2],
        edge: Edge,
        scale: f32,
        phase: PhaseFunction,
    ) -> Result<Self, TransportError> {
        let bad = |why: String| TransportError::Unusable { what: "spectral grid", why };
        if edges.len() < 2
            || edges.len() > MOST_BANDS
            || edges.windows(2).any(|e| e[0].partial_cmp(&e[1]) != Some(std::cmp::Ordering::Less))
        {
            return Err(bad("the limits of bands must ascend, two at least".into()));
        }
        let bands = edges.len() - 1;
        let count = dims.iter().try_fold(bands, |n, &d| n.checked_mul(d)).unwrap_or(usize::MAX);
        for (name, list) in [("sigma_a", sigma_a), ("sigma_s", sigma_s)] {
            if list.len() != count || count == 0 {
                return Err(bad(format!(
                    "{name}: expected {count} values (voxels times bands), got {}",
                    list.len()
                )));
            }
            for &v in list {
                check(v >= 0.0 && v.is_finite(), "value of a grid", "finite and >= 0 1/m", f64::from(v))?;
            }
        }
        check(scale >= 0.0 && scale.is_finite(), "scale", "finite and >= 0", f64::from(scale))?;
        let values = sigma_a.iter().zip(sigma_s).map(|(&a, &s)| [a, s]).collect();
        Ok(Self { dims, edges, values, edge, scale, phase })
    }

    /// Voxels along each axis.
    pub fn dims(&self) -> [usize; 3] {
        self.dims
    }

    /// Limits of the bands \[nm\].
    pub fn edges(&self) -> &[f32] {
        &self.edges
    }

    #[inline(always)]
    fn lattice(&self) -> Lattice {
        Lattice { dims: self.dims, edge: self.edge }
    }

    /// Bands of a voxel.
    #[inline(always)]
    fn bands(&self) -> usize {
        self.edges.len() - 1
    }

    #[inline(always)]
    fn coefficients<const N: usize>(&self, p: Vec3, bands: &[Option<usize>; N]) -> [Spectrum<N>; 2] {
        let mut sum = [Spectrum::ZERO; 2];
        for (weight, voxel) in self.lattice().corners(p) {
            let Some(voxel) = voxel else { continue };
            let (weight, first) = (weight * self.scale, voxel * self.bands());
            for k in 0..N {
                if let Some(band) = bands[k] {
                    let [a, s] = self.values[first + band];
                    sum[0].0[k] += weight * a;
                    sum[1].0[k] += weight * s;
                }
            }
        }
        sum
    }
}

impl MediumModel for SpectralGrid {
    /// The band of each lane.
    type Prepared<'m, const N: usize> = [Option<usize>; N];

    #[inline]
    fn prepare<'m, const N: usize>(&'m self, w: &'m Wavelengths<N>) -> [Option<usize>; N] {
        let last = self.edges.len() - 1;
        let mut bands = [None; N];
        for k in 0..N {
            let above = self.edges.partition_point(|&e| e <= w.lambda[k]);
            // the last band has its upper limit
            let above = if w.lambda[k] == self.edges[last] { last } else { above };
            bands[k] = if above == 0 || above > last { None } else { Some(above - 1) };
        }
        bands
    }

    #[inline(always)]
    fn unit<const N: usize>(&self, _: &[Option<usize>; N]) -> Spectrum<N> {
        Spectrum::ONE
    }

    #[inline]
    fn extinction<const N: usize>(&self, p: Vec3, bands: &[Option<usize>; N]) -> Spectrum<N> {
        let [a, s] = self.coefficients(p, bands);
        a + s
    }

    #[inline]
    fn at<const N: usize>(&self, p: Vec3, bands: &[Option<usize>; N]) -> Point<N> {
        let [sigma_a, sigma_s] = self.coefficients(p, bands);
        Point { sigma_a, sigma_s, emitted: Spectrum::ZERO }
    }

    #[inline(always)]
    fn scattering<'m, const N: usize>(
        &'m self,
        _: Vec3,
        sigma_s: Spectrum<N>,
        _: &[Option<usize>; N],
    ) -> Mixture<'m, N> {
        Mixture::single(sigma_s, &self.phase)
    }

    fn extrema(&self, b: Bounds3) -> Extrema {
        let voxel = |at: [usize; 3]| self.lattice().voxel(at.map(|i| i as i32));
        reach(b, self.dims).fold(Extrema::NONE, |e, at| match voxel(at) {
            None => e.with(0.0),
            Some(voxel) => {
                let first = voxel * self.bands();
                let sums = self.values[first..first + self.bands()].iter().map(|[a, s]| a + s);
                sums.fold(e, |e, v| e.with(v * self.scale))
            }
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
        None
    }
}
