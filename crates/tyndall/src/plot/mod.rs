//! Curves of what a scene or an image holds, as SVG: spectra, media, pixels.

mod medium;
mod pixel;
mod spectrum;
mod subject;

pub use medium::medium;
pub use pixel::pixel;
pub use spectrum::spectrum;
pub use subject::Subject;

use crate::{Error, Options, page::Axis};

/// Draws a subject.
///
/// # Errors
/// When a file cannot be read, or what is asked for is not in it.
pub fn plot(subject: &Subject, options: &Options) -> Result<String, Error> {
    match subject {
        Subject::Medium { scene, medium: name } => medium(scene, name.as_deref(), options),
        Subject::Spectrum { name } => spectrum(name, options),
        Subject::Pixel { image, x, y } => pixel(image, *x, *y),
    }
}

/// The axis of wavelengths.
fn wavelength(range: tyndall_spectral::LambdaRange) -> Axis {
    Axis::new("wavelength [nm]").range(f64::from(range.min), f64::from(range.max))
}

/// Every nm of the range, at least 200 steps, with a function's value there.
fn curve(range: tyndall_spectral::LambdaRange, f: impl Fn(f32) -> f64) -> Vec<[f64; 2]> {
    let steps = (range.width().ceil() as usize).max(200);
    let at = |i: usize| range.min + range.width() * i as f32 / steps as f32;
    (0..=steps).map(at).map(|lambda| [f64::from(lambda), f(lambda)]).collect()
}
