//! Film channels as data: K response curves turn the spectrum at a path's wavelengths into one sample.
//!
//! Channel `c` of a sample is `mean_k L_k r_c(lambda_k) / pdf_k`, whose expectation is the integral of `L r_c` over
//! wavelength plus the sum over spectral lines of `power r_c(lambda_line)`. Up to four curves (XYZ, RGB of a sensor) are
//! *dense*; bands are *sparse*: `r = 1/width` inside, so that a channel is the mean radiance per nm over the band, and a
//! line counts its power over the width.

mod bands;
mod dense;
mod sensor;

pub use bands::Bands;
use dense::Dense;
pub use sensor::Sensor;

use tyndall_spectral::{Spectrum, Wavelengths};

use crate::{ChannelGroup, FilmError, Statistics};

/// Lumen per watt at 555 nm: luminance \[cd/m2\] is this times the integral of radiance with y-bar \[W m^-2 sr^-1\].
pub const LUMENS_PER_WATT: f32 = 683.0;

/// Response curves of a film.
#[derive(Clone, Debug)]
pub struct Channels {
    dense: Dense,
    bands: Bands,
}

/// Responses at the wavelengths of one path, gathered once: `r_c(lambda_k) / (N pdf_k)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WavelengthWeights<const N: usize> {
    rows: [[f32; 4]; N],
    scale: [f32; N],
    band: [u16; N],
}

impl Channels {
    /// CIE X, Y, Z: integrals of radiance with the colour matching functions, no factor.
    pub fn xyz() -> Result<Self, FilmError> {
        Self::rgb(&Sensor::cie1931(1.0), &IDENTITY).map(|c| c.named(["X", "Y", "Z"]))
    }

    /// A sensor's RGB in the colour space given by its matrix from XYZ.
    pub fn rgb(sensor: &Sensor, rgb_from_xyz: &[[f64; 3]; 3]) -> Result<Self, FilmError> {
        Ok(Self { dense: sensor.responses(rgb_from_xyz)?, bands: Bands::default() })
    }

    /// Mean radiance per nm in the bands between ascending `edges` \[nm\].
    pub fn bands(edges: &[f32]) -> Result<Self, FilmError> {
        Ok(Self { dense: Dense::default(), bands: Bands::new(edges)? })
    }

    /// With bands beside the dense channels.
    pub fn with_bands(mut self, edges: &[f32]) -> Result<Self, FilmError> {
        self.bands = Bands::new(edges)?;
        Ok(self)
    }

    fn named(mut self, names: [&str; 3]) -> Self {
        self.dense.names = names.map(String::from).to_vec();
        self
    }

    /// Number of channels: dense ones, then bands.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.dense.names.len() + self.bands.len()
    }

    /// True without any channel.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Edges of the bands \[nm\], empty without bands.
    pub fn band_edges(&self) -> &[f32] {
        self.bands.edges()
    }

    /// The channels as the film's first group, with the unit that the files will state.
    pub fn group(&self, unit: &str) -> ChannelGroup {
        let bands = self.bands.edges().windows(2).map(|e| format!("{}-{}nm", e[0], e[1]));
        let channels = self.dense.names.iter().cloned().chain(bands).collect();
        ChannelGroup { name: String::new(), unit: unit.into(), channels, statistics: Statistics::Errors }
    }

    /// Weights of the channels that make up luminance Y (see [`crate::FilmSpec::luminance`]).
    pub fn luminance(&self) -> Vec<f32> {
        if self.dense.names.is_empty() { self.bands.luminance() } else { self.dense.luminance.to_vec() }
    }

    /// Gathers the responses at a path's wavelengths. A slot of zero density (a terminated wavelength) weighs nothing.
    #[inline]
    pub fn prepare<const N: usize>(&self, w: &Wavelengths<N>) -> WavelengthWeights<N> {
        let mut out = WavelengthWeights { rows: [[0.0; 4]; N], scale: [0.0; N], band: [Bands::NONE; N] };
        for k in 0..N {
            let scale = if w.pdf[k] > 0.0 { 1.0 / (w.pdf[k] * N as f32) } else { 0.0 };
            out.scale[k] = scale;
            let row = self.dense.at(w.lambda[k]);
            for c in 0..4 {
                out.rows[k][c] = row[c] * scale;
            }
            out.band[k] = self.bands.find(w.lambda[k]);
        }
        out
    }

    /// Writes the sample of spectrum `l` (unit of radiance per nm; power in slots on a line) into `out`, which has
    /// [`Channels::len`] entries.
    #[inline]
    pub fn respond_prepared<const N: usize>(
        &self,
        l: &Spectrum<N>,
        weights: &WavelengthWeights<N>,
        out: &mut [f32],
    ) {
        let mut sum = [0.0f32; 4];
        for k in 0..N {
            for c in 0..4 {
                sum[c] += l[k] * weights.rows[k][c];
            }
        }
        let (dense, bands) = out.split_at_mut(self.dense.names.len());
        dense.iter_mut().zip(sum).for_each(|(o, s)| *o = s);
        self.bands.respond(l, &weights.scale, &weights.band, bands);
    }

    /// [`Channels::prepare`] and [`Channels::respond_prepared`] at once.
    #[inline]
    pub fn respond<const N: usize>(&self, l: &Spectrum<N>, w: &Wavelengths<N>, out: &mut [f32]) {
        self.respond_prepared(l, &self.prepare(w), out);
    }
}

const IDENTITY: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
