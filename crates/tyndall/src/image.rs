//! A film as named planes: what EXR files hold and every other output is made from.

use crate::{Error, Provenance, memory, statistics, units};
use std::{
    fs::File,
    io::Read,
    path::{Path, PathBuf},
};
use tyndall_engine::container;
use tyndall_files::image::{
    Channel, MetaValue, Pixels, SpectralLayout, SpectralUnit, Window, band_edges_nm, read_image,
    spectral_channel_name, spectral_channels,
};
use tyndall_film::{Developed, Film, PixelBounds, Squares};
use tyndall_spectral::{ColourSpace, SpaceName, cie::CIE_Y_INTEGRAL};

/// Names of our own attributes.
pub mod attribute {
    /// Hash of the job.
    pub const JOB: &str = "tyndall:job";
    /// Hash of the scene.
    pub const SCENE: &str = "tyndall:sceneHash";
    /// The job's seed.
    pub const SEED: &str = "tyndall:seed";
    /// Unit of the spectral radiance.
    pub const UNITS: &str = "tyndall:units";
    /// Colour space of R, G, B.
    pub const SPACE: &str = "tyndall:colourSpace";
    /// How standard errors were estimated.
    pub const ERROR_MODE: &str = "tyndall:errorMode";
    /// Degrees of freedom of the standard errors.
    pub const FREEDOM: &str = "tyndall:degreesOfFreedom";
    /// Side of the squares of pixels that share paths, and have errors in common; absent where pixels are independent.
    pub const SQUARE: &str = "tyndall:pixelsShareErrors";
    /// Everything that the bits depend on, as `name: value`.
    pub const SETTINGS: &str = "tyndall:settings";
    /// In a picture: that and how it was denoised.
    pub const DENOISED: &str = "tyndall:denoised";
    /// Mean number of samples per pixel.
    pub const SAMPLES: &str = "samplesPerPixel";
}

/// Values and, where they are known, standard errors under the same channel names.
#[derive(Clone, Debug)]
pub struct Image {
    /// Values.
    pub values: Pixels,
    /// Standard errors of the leading channels; infinite where unknown.
    pub errors: Option<Pixels>,
}

impl Image {
    /// The image of a film: R, G, B, spectral bands, layers.
    pub fn of_film(film: &Film, provenance: &Provenance) -> Result<Self, Error> {
        Self::of_developed(&film.develop(), film, provenance)
    }

    /// The same from planes that are there already.
    pub fn of_developed(developed: &Developed, film: &Film, provenance: &Provenance) -> Result<Self, Error> {
        let planes = Planes { developed, provenance, bands: &provenance.band_edges };
        let frame = || {
            let mut frame = frame(film.spec().bounds, film.spec().resolution);
            describe(&mut frame, provenance);
            frame.set(attribute::ERROR_MODE, film.spec().mode.name());
            frame.set(attribute::FREEDOM, median(&developed.dof) as i32);
            frame.set(attribute::SAMPLES, mean_samples(film));
            if developed.square > 1 {
                frame.set(attribute::SQUARE, developed.square as i32);
            }
            frame
        };
        let values = planes.fill(frame(), &developed.mean)?;
        let mut errors = planes.fill(frame(), &developed.error)?;
        errors.set("comments", "standard errors of the channels of the same names; inf where unknown");
        statistics::add(&mut errors, developed)?;
        if !developed.square_error.is_empty() {
            statistics::add_squares(&mut errors, &planes.fill(frame(), &developed.square_error)?)?;
        }
        Ok(Self { values, errors: Some(errors) })
    }

    /// A film, or an image file; for an EXR the errors beside it (`NAME.error.exr`) where they are.
    ///
    /// # Errors
    /// When the file cannot be read or is damaged.
    pub fn read(path: &Path) -> Result<Self, Error> {
        if is_film(path) {
            let (header, state) = container::read(path, memory::available(), |_| Ok(()))?;
            return Self::of_film(&state.film, &Provenance::from_identity(&header.identity)?);
        }
        let values = read_image(path)?;
        let beside = error_path(path);
        let errors = if beside.exists() && beside != path { Some(read_image(&beside)?) } else { None };
        Ok(Self { values, errors })
    }

    /// Colour space of R, G, B; that of the file's chromaticities, sRGB without.
    pub fn space(&self) -> SpaceName {
        if let Some(MetaValue::Text(name)) = self.values.meta.get(attribute::SPACE)
            && let Ok(space) = name.parse()
        {
            return space;
        }
        let Some(MetaValue::Chromaticities(xy)) = self.values.meta.get("chromaticities") else {
            return SpaceName::Srgb;
        };
        let same = |s: &SpaceName| {
            let own = chromaticities(*s);
            own.iter().flatten().zip(xy.iter().flatten()).all(|(a, b)| (a - b).abs() < 2e-3)
        };
        SpaceName::ALL.into_iter().find(same).unwrap_or(SpaceName::Srgb)
    }

    /// True when radiance is in W m^-2 sr^-1 nm^-1, so that 683 Y is a luminance in cd/m^2.
    pub fn is_absolute(&self) -> bool {
        matches!(self.values.meta.get(attribute::UNITS), Some(MetaValue::Text(t)) if t == units::ABSOLUTE)
    }

    /// Edges of the bands \[nm\], if there are bands.
    pub fn band_edges(&self) -> Option<Vec<f64>> {
        band_edges_nm(&self.values)
    }

    /// Degrees of freedom of the errors, where the file says so.
    pub fn degrees_of_freedom(&self) -> Option<u32> {
        match self.values.meta.get(attribute::FREEDOM) {
            Some(MetaValue::Int(n)) => u32::try_from(*n).ok(),
            _ => None,
        }
    }

    /// Side of the squares of pixels that have errors in common, cut from the upper left corner of the window; 1 where the
    /// file says nothing of it.
    pub fn square(&self) -> u32 {
        match self.errors.as_ref().and_then(|e| e.meta.get(attribute::SQUARE)) {
            Some(MetaValue::Int(n)) => u32::try_from(*n).map_or(1, |n| n.max(1)),
            _ => 1,
        }
    }

    /// Standard errors of a channel, from which those of sums over pixels follow; pixels count from the window's corner.
    pub fn squares(&self, channel: &str) -> Option<Squares<'_>> {
        let errors = self.errors.as_ref()?;
        Some(Squares {
            window: PixelBounds::new(0, 0, errors.width() as u32, errors.height() as u32),
            side: self.square(),
            pixel: errors.channel(channel)?,
            square: errors.channel(&statistics::square_name(channel)),
        })
    }

    /// Luminance Y of every pixel, in the unit of the image; `None` without R, G, B.
    pub fn luminance(&self) -> Option<Vec<f32>> {
        self.values.rgb().map(|rgb| self.luminance_of(rgb))
    }

    /// Luminance Y of other planes R, G, B in the colour space of the image.
    pub fn luminance_of(&self, [r, g, b]: [&[f32]; 3]) -> Vec<f32> {
        let y = ColourSpace::get(self.space()).xyz_from_rgb.0[1];
        let dot = |((r, g), b): ((&f32, &f32), &f32)| {
            (y[0] * f64::from(*r) + y[1] * f64::from(*g) + y[2] * f64::from(*b)) as f32
        };
        r.iter().zip(g).zip(b).map(dot).collect()
    }
}

/// The channels in the order people expect: R, G, B, bands by wavelength, layers. Files sort them by name.
pub fn ordered(pixels: &Pixels) -> Vec<&Channel> {
    let bands: Vec<&str> = spectral_channels(pixels).iter().map(|c| c.channel.name.as_str()).collect();
    let rank = |c: &&Channel| {
        let name = c.name.as_str();
        let (layer, channel) = split_layer(name);
        let layer = if layer == "S0" { "" } else { layer };
        let colour = ["R", "G", "B"].iter().position(|n| *n == channel);
        let band = bands.iter().position(|b| *b == name).map(|i| i + 3);
        (layer.to_owned(), colour.or(band).unwrap_or(usize::MAX))
    };
    let mut channels: Vec<&Channel> = pixels.channels().iter().collect();
    channels.sort_by_cached_key(rank);
    channels
}

/// Whether a file starts as films do.
pub fn is_film(path: &Path) -> bool {
    let mut start = [0; 8];
    let read = File::open(path).and_then(|mut f| f.read_exact(&mut start));
    read.is_ok() && start == container::MAGIC
}

/// `fog.error.exr` for `fog.exr`.
pub fn error_path(path: &Path) -> PathBuf {
    path.with_extension("error.exr")
}

/// Chromaticities of red, green, blue and white.
pub fn chromaticities(space: SpaceName) -> [[f32; 2]; 4] {
    let space = ColourSpace::get(space);
    let [r, g, b] = space.primaries;
    [r, g, b, tyndall_spectral::colour::chromaticity(space.white)].map(|xy| xy.map(|v| v as f32))
}

fn frame(bounds: PixelBounds, [width, height]: [u32; 2]) -> Pixels {
    let window = Window {
        x0: bounds.x0 as i32,
        y0: bounds.y0 as i32,
        width: bounds.width() as usize,
        height: bounds.height() as usize,
    };
    Pixels::cropped(window, Window::of_size(width as usize, height as usize))
}

fn describe(pixels: &mut Pixels, p: &Provenance) {
    pixels.set("software", concat!("tyndall ", env!("CARGO_PKG_VERSION")));
    pixels.set("chromaticities", MetaValue::Chromaticities(chromaticities(p.space)));
    pixels.set("worldToCamera", MetaValue::Matrix4(p.camera.world_to_camera));
    pixels.set("worldToNDC", MetaValue::Matrix4(p.camera.world_to_ndc));
    pixels.set(attribute::JOB, p.job.as_str());
    pixels.set(attribute::SCENE, p.scene_hash.as_str());
    pixels.set(attribute::SEED, p.seed.to_string());
    pixels.set(attribute::UNITS, p.units.as_str());
    pixels.set(attribute::SPACE, p.space.name());
    let settings = p.settings.iter().map(|(name, value)| format!("{name}: {value}")).collect();
    pixels.set(attribute::SETTINGS, MetaValue::Texts(settings));
}

/// Mean samples per pixel, rounded.
fn mean_samples(film: &Film) -> i32 {
    let area = film.spec().bounds.area().max(1);
    i32::try_from((film.samples() + area / 2) / area).unwrap_or(i32::MAX)
}

fn median(dof: &[u32]) -> u32 {
    let mut sorted = dof.to_vec();
    sorted.sort_unstable();
    sorted.get(sorted.len() / 2).copied().unwrap_or(0)
}

/// The planes of a film under their names in files.
struct Planes<'a> {
    developed: &'a Developed,
    provenance: &'a Provenance,
    bands: &'a [f32],
}

impl Planes<'_> {
    /// The first planes of the film (all, or those with errors), in place of their names there.
    fn fill(&self, mut pixels: Pixels, planes: &[Vec<f32>]) -> Result<Pixels, Error> {
        let names = self.developed.names.iter().zip(&self.developed.units).zip(planes);
        let mut bands = Vec::new();
        let mut layers = Vec::new();
        for ((name, unit), plane) in names {
            let (layer, channel) = split_layer(name);
            let Some(band) = self.band(channel) else {
                if layer.is_empty() {
                    pixels.push(channel, plane.clone())?;
                } else {
                    layers.push((name.clone(), plane.clone()));
                }
                continue;
            };
            let plane = self.denormalised(plane, unit);
            if layer.is_empty() {
                bands.push(plane);
            } else {
                layers.push((format!("{layer}.{}", spectral_channel_name(self.centre(band))), plane));
            }
        }
        if !bands.is_empty() {
            self.layout(&pixels).add_to(&mut pixels, bands)?;
        }
        for (name, plane) in layers {
            pixels.push(name, plane)?;
        }
        Ok(pixels)
    }

    /// The band of a channel such as `400-410nm`.
    fn band(&self, channel: &str) -> Option<usize> {
        self.bands.windows(2).position(|e| channel == format!("{}-{}nm", e[0], e[1]))
    }

    fn centre(&self, band: usize) -> f64 {
        0.5 * (f64::from(self.bands[band]) + f64::from(self.bands[band + 1]))
    }

    /// pbrt-v4's rule: bands of normalised lights are multiplied by the integral of y-bar, so that a constant light of
    /// scale 1 is 1 in every band. Ratios (albedo, transmittance) and absolute units stay.
    fn denormalised(&self, plane: &[f32], unit: &str) -> Vec<f32> {
        let factor = if unit == units::NORMALISED { CIE_Y_INTEGRAL } else { 1.0 };
        plane.iter().map(|v| v * factor).collect()
    }

    fn layout(&self, pixels: &Pixels) -> SpectralLayout {
        let samples = match pixels.meta.get(attribute::SAMPLES) {
            Some(MetaValue::Int(n)) => Some(*n),
            _ => None,
        };
        let unit = if self.provenance.is_absolute() {
            SpectralUnit::Absolute
        } else {
            SpectralUnit::Relative(self.provenance.units.clone())
        };
        SpectralLayout {
            edges_nm: self.bands.iter().map(|&e| f64::from(e)).collect(),
            unit,
            samples_per_pixel: samples,
        }
    }
}

/// Layer and channel. Names of bands may hold points of their own (`400.5-401nm`), names of layers start with a letter.
fn split_layer(name: &str) -> (&str, &str) {
    match name.split_once('.') {
        Some((layer, channel)) if !layer.starts_with(|c: char| c.is_ascii_digit()) => (layer, channel),
        _ => ("", name),
    }
}
