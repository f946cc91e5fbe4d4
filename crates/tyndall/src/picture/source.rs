//! The planes that a picture is made from: R, G, B or one band, as they are or denoised.

use super::Look;
use crate::{
    Error, Image,
    denoise::{Noisy, denoise},
};
use tyndall_files::image::{Pixels, spectral_channels};
use tyndall_film::Squares;

/// Linear numbers in the image's unit.
pub(super) enum Source {
    /// R, G, B in the image's colour space.
    Colour([Vec<f32>; 3]),
    /// One band.
    Band(Vec<f32>),
}

impl Source {
    /// What a look is at; false colour is that of R, G, B.
    pub(super) fn of(image: &Image, look: &Look) -> Result<Self, Error> {
        match look.band.filter(|_| look.false_colour.is_none()) {
            Some(nm) => band(image, nm, look.denoise).map(Self::Band),
            None => colour(image, look.denoise).map(Self::Colour),
        }
    }

    /// Luminance Y, or the band itself, in the unit of the image.
    pub(super) fn luminance(&self, image: &Image) -> Vec<f32> {
        match self {
            Self::Colour(rgb) => image.luminance_of(rgb.each_ref().map(Vec::as_slice)),
            Self::Band(plane) => plane.clone(),
        }
    }
}

fn colour(image: &Image, threads: Option<usize>) -> Result<[Vec<f32>; 3], Error> {
    let rgb = image.values.rgb();
    let rgb = rgb.ok_or_else(|| Error::options("the image has no channels R, G, B or Y", None))?;
    let Some(threads) = threads else { return Ok(rgb.map(<[f32]>::to_vec)) };
    let names = if image.values.channel("R").is_some() { "R, G, B" } else { "Y" };
    let errors = image.errors.as_ref().and_then(Pixels::rgb).ok_or_else(|| no_errors(names))?;
    let planes = clean(image, &[(rgb[0], errors[0]), (rgb[1], errors[1]), (rgb[2], errors[2])], threads)?;
    Ok(planes.try_into().expect("as many planes as channels"))
}

fn band(image: &Image, nm: f64, threads: Option<usize>) -> Result<Vec<f32>, Error> {
    let name = band_name(image, nm)?;
    let absent = || Error::options(format!("the image has no channel {name}"), None);
    let plane = image.values.channel(&name).ok_or_else(absent)?;
    let Some(threads) = threads else { return Ok(plane.to_vec()) };
    let errors = image.errors.as_ref().and_then(|e| e.channel(&name)).ok_or_else(|| no_errors(&name))?;
    Ok(clean(image, &[(plane, errors)], threads)?.swap_remove(0))
}

/// Denoised planes.
fn clean(image: &Image, planes: &[(&[f32], &[f32])], threads: usize) -> Result<Vec<Vec<f32>>, Error> {
    let noisy = Noisy::new(image.values.width(), image.values.height(), planes)?;
    denoise(&noisy.alike(image.square(), correlation(image)), threads)
}

/// Correlation of two pixels of a square where the file does not tell: assumed, for pictures alone, where a bound would blur.
const USUAL: f32 = 0.2;

/// Mean correlation of two pixels of a square, over all channels: with errors s of pixels and S of the mean over the n of a
/// square, `sum(n^2 S^2 - sum s^2) / sum((sum s)^2 - sum s^2)`, each channel's in its own unit.
fn correlation(image: &Image) -> f32 {
    let names = image.values.channels().iter().map(|c| &c.name);
    let all: Vec<f64> = names.filter_map(|name| correlation_of(&image.squares(name)?)).collect();
    if all.is_empty() { USUAL } else { (all.iter().sum::<f64>() / all.len() as f64).clamp(0.0, 1.0) as f32 }
}

/// That of one channel; `None` where no error of a square is known.
fn correlation_of(errors: &Squares<'_>) -> Option<f64> {
    let common = errors.square?;
    let (mut found, mut greatest) = (0.0, 0.0);
    for square in errors.window.tiles(errors.side) {
        let index = |(x, y)| errors.window.index(x, y);
        let se = || square.pixels().map(index).map(|p| f64::from(errors.pixel[p]));
        let (sum, alone) = (se().sum::<f64>(), se().map(|s| s * s).sum::<f64>());
        let whole = square.area() as f64 * f64::from(common[index((square.x0, square.y0))]);
        if whole.is_finite() && sum.is_finite() {
            found += whole * whole - alone;
            greatest += sum * sum - alone;
        }
    }
    (greatest > 0.0).then_some(found / greatest)
}

fn no_errors(channels: &str) -> Error {
    Error::options(
        format!("to be denoised, {channels} need standard errors, and the image has none"),
        Some("a film holds them, and NAME.error.exr beside NAME.exr does".into()),
    )
}

/// The channel of the band that holds a wavelength; the nearest one where the image does not tell the edges.
fn band_name(image: &Image, nm: f64) -> Result<String, Error> {
    let bands: Vec<_> =
        spectral_channels(&image.values).into_iter().filter(|c| c.channel.name.starts_with("S0.")).collect();
    let edges = image.band_edges();
    let holds = |i: usize| match &edges {
        Some(e) if e.len() == bands.len() + 1 => (e[i]..=e[i + 1]).contains(&nm),
        _ => false,
    };
    let nearest = || {
        let distance = |i: usize| (bands[i].lambda_nm - nm).abs();
        (0..bands.len()).filter(|_| edges.is_none()).min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
    };
    let found = (0..bands.len()).find(|&i| holds(i)).or_else(nearest);
    let Some(i) = found else {
        let have = match (bands.first(), bands.last()) {
            (Some(a), Some(b)) => format!("bands around {} to {} nm", a.lambda_nm, b.lambda_nm),
            _ => "no spectral bands".into(),
        };
        let hint = "render with --bands FROM:TO:STEP around the wavelength";
        return Err(Error::options(format!("--band {nm}: the image has {have}"), Some(hint.into())));
    };
    Ok(bands[i].channel.name.clone())
}
