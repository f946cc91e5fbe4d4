//! What is known of a pixel's errors beside their size: planes of `NAME.error.exr`, columns of tables.

use crate::Error;
use tyndall_files::image::Pixels;
use tyndall_film::Developed;

/// Samples that are in the pixel.
pub const SAMPLES: &str = "statistics.samples";
/// Degrees of freedom of the pixel's standard errors.
pub const FREEDOM: &str = "statistics.freedom";
/// 1 where one sample carries half of the variance of Y or more: a heavy tail, whose error may be too small.
pub const DOMINATED: &str = "statistics.dominated";
/// 1 where the errors are those of the pixel's tile, because it has too few samples for its own.
pub const POOLED: &str = "statistics.pooled";

/// Layer of the standard errors of means over squares of pixels that have errors in common.
const SQUARE: &str = "square.";

/// All of them, in the order of tables.
pub const NAMES: [&str; 4] = [SAMPLES, FREEDOM, DOMINATED, POOLED];

/// Adds the planes behind the standard errors.
///
/// # Errors
/// When the image has another size.
pub(crate) fn add(pixels: &mut Pixels, d: &Developed) -> Result<(), Error> {
    let number = |v: &Vec<u32>| v.iter().map(|&n| n as f32).collect::<Vec<f32>>();
    let mark = |v: &Vec<bool>| v.iter().map(|&m| f32::from(u8::from(m))).collect::<Vec<f32>>();
    let planes = [number(&d.samples), number(&d.dof), mark(&d.flagged), mark(&d.pooled)];
    for (name, plane) in NAMES.into_iter().zip(planes) {
        pixels.push(name, plane)?;
    }
    Ok(())
}

/// Adds the standard errors of means over squares, under the names of their channels in a layer of their own.
///
/// # Errors
/// When they have another size.
pub(crate) fn add_squares(pixels: &mut Pixels, squares: &Pixels) -> Result<(), Error> {
    for channel in squares.channels() {
        pixels.push(square_name(&channel.name), channel.data.clone())?;
    }
    Ok(())
}

/// Name of the plane that holds the standard errors of a channel's means over squares.
pub(crate) fn square_name(channel: &str) -> String {
    format!("{SQUARE}{channel}")
}

/// Whether a plane is one of these.
pub(crate) fn is_of_squares(channel: &str) -> bool {
    channel.starts_with(SQUARE)
}

/// Number of pixels that a plane marks; `None` where the file has no such plane.
pub fn marked(errors: Option<&Pixels>, name: &str) -> Option<u64> {
    Some(errors?.channel(name)?.iter().filter(|&&m| m > 0.0).count() as u64)
}
