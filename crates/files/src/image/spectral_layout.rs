//! The spectral layout of an image: bands, units, and the attributes that say so.
//!
//! After A. Fichet, R. Pacanowski, A. Wilkie, "An OpenEXR layout for spectral images", JCGT 10(3), 2021:
//! `spectralLayoutVersion` and `emissiveUnits`. Ours beside them: `spectralQuantity` ("per nm, band mean"),
//! `spectralBandEdges` (n + 1 edges in nm), `samplesPerPixel`.

use super::{MetaValue, Pixels, spectral_channel_name};
use crate::{FileError, Result};

const LAYOUT_VERSION: &str = "1.0";
const QUANTITY: &str = "per nm, band mean";
const BAND_EDGES: &str = "spectralBandEdges";

/// The unit of the samples, each of which is a mean over its band.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SpectralUnit {
    /// Spectral radiance, W m^-2 sr^-1 nm^-1.
    Absolute,
    /// Relative, with a word that says to what (`pbrt-normalised`).
    Relative(String),
}

/// Bands and unit of a spectral image.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectralLayout {
    /// Band edges in nm, ascending: band `i` is `edges_nm[i] .. edges_nm[i + 1]`.
    pub edges_nm: Vec<f64>,
    /// Unit of the samples.
    pub unit: SpectralUnit,
    /// Samples a pixel.
    pub samples_per_pixel: Option<i32>,
}

impl SpectralLayout {
    /// Number of bands.
    pub fn bands(&self) -> usize {
        self.edges_nm.len().saturating_sub(1)
    }

    /// Centre of a band in nm, the number in its channel's name.
    pub fn centre_nm(&self, band: usize) -> f64 {
        0.5 * (self.edges_nm[band] + self.edges_nm[band + 1])
    }

    /// Adds one channel for each band and the attributes of the layout to an image that has R, G, B already.
    ///
    /// # Errors
    /// [`FileError::BadImage`] when R, G, B are missing (the layout asks for them, so that every viewer
    /// shows the file), when edges are not finite, positive and ascending, when the number of planes is not
    /// that of the bands, or a plane has the wrong size.
    pub fn add_to(&self, pixels: &mut Pixels, planes: Vec<Vec<f32>>) -> Result<()> {
        self.check(pixels, planes.len())?;
        for (band, plane) in planes.into_iter().enumerate() {
            pixels.push(spectral_channel_name(self.centre_nm(band)), plane)?;
        }
        pixels.set("spectralLayoutVersion", LAYOUT_VERSION);
        pixels.set("emissiveUnits", "W.m^-2.sr^-1");
        pixels.set("spectralQuantity", QUANTITY);
        if let SpectralUnit::Relative(to) = &self.unit {
            pixels.set("radianceUnits", to.as_str());
        } else {
            pixels.set("radianceUnits", "W.m^-2.sr^-1.nm^-1");
        }
        pixels.set(BAND_EDGES, self.edges_nm.iter().map(|&e| e as f32).collect::<Vec<_>>());
        if let Some(samples) = self.samples_per_pixel {
            pixels.set("samplesPerPixel", samples);
        }
        Ok(())
    }

    fn check(&self, pixels: &Pixels, planes: usize) -> Result<()> {
        if pixels.rgb().is_none() {
            let names: Vec<_> = pixels.channels().iter().map(|c| c.name.as_str()).collect();
            return Err(FileError::bad_image(
                "R, G and B beside the spectral channels",
                format!("channels {names:?}"),
                "add the RGB planes first",
            ));
        }
        let ascending = self.edges_nm.windows(2).all(|e| e[0] < e[1]);
        if !ascending || self.bands() == 0 || !self.edges_nm.iter().all(|e| e.is_finite() && *e > 0.0) {
            return Err(FileError::bad_image(
                "at least two ascending, positive band edges in nm",
                format!("{:?}", self.edges_nm),
                "give edges as FROM:TO:STEP, for example 380:780:5",
            ));
        }
        if planes != self.bands() {
            return Err(FileError::bad_image(
                format!("{} planes, one for each band", self.bands()),
                planes.to_string(),
                "n + 1 edges bound n bands",
            ));
        }
        Ok(())
    }
}

/// The band edges in nm that [`SpectralLayout::add_to`] left in an image, when it has them.
pub fn band_edges_nm(pixels: &Pixels) -> Option<Vec<f64>> {
    match pixels.meta.get(BAND_EDGES) {
        Some(MetaValue::Floats(edges)) => Some(edges.iter().map(|&e| f64::from(e)).collect()),
        _ => None,
    }
}
