//! What a medium of varying density emits: `sigma_a le` \[W m^-3 sr^-1 nm^-1\], with `le` a spectrum times a density, or a
//! black body whose temperature is a grid.

use super::density::Density;
use tyndall_base::Vec3;
use tyndall_geometry::Transform;
use tyndall_spectral::{Emission, Spectrum, Wavelengths, curve::Blackbody};

/// Colder than this nothing is emitted, as in pbrt-v4 \[K\].
const COLDEST: f32 = 100.0;

/// The source radiance of a medium.
#[derive(Clone, Debug)]
pub enum Source<D> {
    /// A spectrum, times a grid if there is one.
    Spectrum {
        /// Source radiance where the grid is 1.
        le: Emission,
        /// Its scale over space.
        scale: Option<D>,
    },
    /// A black body.
    Thermal(Box<Thermal<D>>),
}

/// `T = (temperature - offset) scale` \[K\]; radiance by Planck's law, or that over its maximum as pbrt-v4 has it.
#[derive(Clone, Debug)]
pub struct Thermal<D> {
    /// The grid of temperatures.
    pub temperature: D,
    /// From the density's space to that of the temperature, where they differ.
    pub place: Option<Transform>,
    /// Subtracted from the grid's values.
    pub offset: f32,
    /// Then multiplied by this.
    pub scale: f32,
    /// Factor of the radiance.
    pub le_scale: f32,
    /// Its scale over space, in the density's space.
    pub le_grid: Option<D>,
    /// Planck's law in W m^-2 sr^-1 nm^-1 instead of a maximum of 1.
    pub absolute: bool,
    /// Emission of the hottest point, for densities of wavelengths.
    pub hottest: Emission,
}

impl<D: Density> Source<D> {
    /// An emission of the kind found in the medium, for densities of wavelengths.
    pub fn typical(&self) -> &Emission {
        match self {
            Self::Spectrum { le, .. } => le,
            Self::Thermal(t) => &t.hottest,
        }
    }

    /// Source radiance at `p`; `unit` is the spectrum at the path's wavelengths where there is one.
    #[inline]
    pub fn at<const N: usize>(&self, p: Vec3, unit: &Spectrum<N>, w: &Wavelengths<N>) -> Spectrum<N> {
        match self {
            Self::Spectrum { scale: None, .. } => *unit,
            Self::Spectrum { scale: Some(grid), .. } => *unit * grid.at(p),
            Self::Thermal(t) => t.at(p, w),
        }
    }
}

impl<D: Density> Thermal<D> {
    #[inline]
    fn at<const N: usize>(&self, p: Vec3, w: &Wavelengths<N>) -> Spectrum<N> {
        let scale = self.le_scale * self.le_grid.as_ref().map_or(1.0, |g| g.at(p));
        let there = self.place.map_or(p, |t| t.point(p));
        let kelvin = (self.temperature.at(there) - self.offset) * self.scale;
        // a NaN is no temperature
        if scale <= 0.0 || kelvin.is_nan() || kelvin <= COLDEST {
            return Spectrum::ZERO;
        }
        let body = if self.absolute { Blackbody::absolute(kelvin) } else { Blackbody::normalized(kelvin) };
        let Ok(body) = body else { return Spectrum::ZERO };
        // a black body has no lines
        Spectrum::from_fn(|k| if w.on_line(k) { 0.0 } else { scale * body.eval(w.lambda[k]) })
    }
}
