//! A pixel of a spectral image, with error bars where errors are known.

use crate::{
    Error, Image,
    image::attribute,
    page::{Axis, Chart, Series},
    statistics,
};
use std::path::Path;
use tyndall_files::image::{MetaValue, Pixels, spectral_channels};

/// The bands of a pixel with their standard errors (`NAME.error.exr` beside the image, or those of a film).
///
/// # Errors
/// When the image cannot be read, has no spectral channels, or no such pixel.
pub fn pixel(path: &Path, x: u32, y: u32) -> Result<String, Error> {
    let image = Image::read(path)?;
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let at = index(&image.values, x, y).ok_or_else(|| outside(&name, &image.values, x, y))?;
    let points = bands(&image.values, at);
    if points.is_empty() {
        return Err(Error::options(
            format!("{name}: has no spectral channels"),
            "render with --bands FROM:TO:STEP".to_owned(),
        ));
    }
    let unit = match image.values.meta.get(attribute::UNITS) {
        Some(MetaValue::Text(unit)) => unit.clone(),
        _ => "unknown unit".into(),
    };
    let series = match &image.errors {
        Some(errors) if bands(errors, at).len() == points.len() => {
            let bars = bands(errors, at).iter().map(|p| p[1]).collect();
            Series::points("mean and standard error", points.clone()).errors(bars)
        }
        _ => Series::points("", points.clone()),
    };
    let title = format!("{name}, pixel {x},{y}");
    let edges = image.band_edges().filter(|e| e.len() == points.len() + 1);
    let ends = edges.as_ref().map_or([points[0][0], points[points.len() - 1][0]], |e| [e[0], e[e.len() - 1]]);
    let wavelength = Axis::new("wavelength [nm]");
    // one wavelength alone spans no axis
    let wavelength = if ends[0] < ends[1] { wavelength.range(ends[0], ends[1]) } else { wavelength };
    let chart = Chart::new(&title, wavelength, Axis::new(&format!("radiance [{unit}]")));
    let line = match edges {
        Some(edges) => {
            let values: Vec<f64> = points.iter().map(|p| p[1]).collect();
            Series::bins("", &edges, &values)
        }
        None => Series::line("", points),
    };
    Ok(chart.with(line).with(series.colour("#000000")).to_svg())
}

/// Wavelength and value of every spectral channel of the image itself.
fn bands(pixels: &Pixels, at: usize) -> Vec<[f64; 2]> {
    let own = spectral_channels(pixels).into_iter().filter(|c| !statistics::is_of_squares(&c.channel.name));
    let mut points: Vec<[f64; 2]> = own.map(|c| [c.lambda_nm, f64::from(c.channel.data[at])]).collect();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    points
}

fn index(pixels: &Pixels, x: u32, y: u32) -> Option<usize> {
    let window = pixels.window();
    let column = usize::try_from(i64::from(x) - i64::from(window.x0)).ok()?;
    let row = usize::try_from(i64::from(y) - i64::from(window.y0)).ok()?;
    (column < window.width && row < window.height).then_some(row * window.width + column)
}

fn outside(name: &str, pixels: &Pixels, x: u32, y: u32) -> Error {
    let w = pixels.window();
    Error::options(
        format!(
            "{name}: pixel {x},{y} lies outside the image's window of {} x {} pixels from {},{}",
            w.width, w.height, w.x0, w.y0
        ),
        "pixels count from 0 at the upper left".to_owned(),
    )
}
