//! Rows of a table: all pixels, some of them, or means over regions.

use super::{Column, Join};
use crate::Error;
use std::io::{self, Write};
use tyndall_files::image::Window;
use tyndall_film::PixelBounds;

/// Pixels from (x0, y0) up to but not including (x1, y1), counted in the whole image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// Left edge.
    pub x0: u32,
    /// Right edge.
    pub x1: u32,
    /// Upper edge.
    pub y0: u32,
    /// Lower edge.
    pub y1: u32,
}

impl Region {
    /// One pixel.
    pub const fn pixel(x: u32, y: u32) -> Self {
        Self { x0: x, x1: x.saturating_add(1), y0: y, y1: y.saturating_add(1) }
    }
}

/// What a table has a row for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Rows {
    /// Every pixel.
    All,
    /// These pixels.
    Pixels(Vec<(u32, u32)>),
    /// Means over these regions.
    Regions(Vec<Region>),
}

impl Rows {
    /// Refuses what lies outside the image.
    pub(super) fn check(&self, window: Window) -> Result<(), Error> {
        let outside = match self {
            Self::All => None,
            Self::Pixels(pixels) => pixels
                .iter()
                .find(|&&(x, y)| index(window, x, y).is_none())
                .map(|(x, y)| format!("pixel {x},{y}")),
            Self::Regions(regions) => regions
                .iter()
                .find(|r| !holds(window, r))
                .map(|r| format!("region {},{},{},{}", r.x0, r.x1, r.y0, r.y1)),
        };
        let Some(what) = outside else { return Ok(()) };
        let Window { x0, y0, width, height } = window;
        Err(Error::options(
            format!("{what} lies outside the image's window of {width} x {height} from {x0},{y0}"),
            Some("pixels count from 0 at the upper left".into()),
        ))
    }

    /// Names of the columns that tell the place.
    pub(super) const fn place(&self) -> &'static str {
        match self {
            Self::Regions(_) => "x0,x1,y0,y1,pixels",
            _ => "x,y",
        }
    }

    pub(super) fn shows(&self, column: &Column<'_>) -> bool {
        column.join != Join::None || !matches!(self, Self::Regions(_))
    }

    pub(super) fn write(
        &self,
        window: Window,
        columns: &[Column<'_>],
        out: &mut impl Write,
    ) -> io::Result<()> {
        match self {
            Self::All => (0..window.area()).try_for_each(|p| pixel(window, columns, p, out)),
            Self::Pixels(pixels) => {
                let inside = pixels.iter().filter_map(|&(x, y)| index(window, x, y));
                inside.into_iter().try_for_each(|p| pixel(window, columns, p, out))
            }
            Self::Regions(regions) => regions.iter().try_for_each(|r| region(window, columns, r, out)),
        }
    }
}

/// Row-major index of a pixel of the whole image in its window.
fn index(window: Window, x: u32, y: u32) -> Option<usize> {
    let (x, y) = (i64::from(x) - i64::from(window.x0), i64::from(y) - i64::from(window.y0));
    let inside = (0..window.width as i64).contains(&x) && (0..window.height as i64).contains(&y);
    inside.then_some(y as usize * window.width + x as usize)
}

/// Whether a region has pixels, and all of them in the window.
fn holds(window: Window, r: &Region) -> bool {
    r.x0 < r.x1
        && r.y0 < r.y1
        && index(window, r.x0, r.y0).is_some()
        && index(window, r.x1 - 1, r.y1 - 1).is_some()
}

fn pixel(window: Window, columns: &[Column<'_>], p: usize, out: &mut impl Write) -> io::Result<()> {
    let (x, y) = (window.x0 as i64 + (p % window.width) as i64, window.y0 as i64 + (p / window.width) as i64);
    write!(out, "{x},{y}")?;
    for Column { channel, errors, .. } in columns {
        write!(out, ",{}", channel.data[p])?;
        if let Some(se) = errors {
            write!(out, ",{}", se.pixel[p])?;
        }
    }
    writeln!(out)
}

/// Means over a region; squares of pixels are independent, so the variances of their sums add up ([`tyndall_film::Squares`]).
fn region(window: Window, columns: &[Column<'_>], r: &Region, out: &mut impl Write) -> io::Result<()> {
    let pixels: Vec<usize> =
        (r.y0..r.y1).flat_map(|y| (r.x0..r.x1).filter_map(move |x| index(window, x, y))).collect();
    let n = pixels.len() as f64;
    write!(out, "{},{},{},{},{n}", r.x0, r.x1, r.y0, r.y1)?;
    for Column { channel, errors, join } in columns.iter().filter(|c| c.join != Join::None) {
        let total: f64 = pixels.iter().map(|&p| f64::from(channel.data[p])).sum();
        match join {
            Join::Sum => write!(out, ",{total}")?,
            _ => write!(out, ",{}", (total / n) as f32)?,
        }
        if let Some(se) = errors {
            let error = se.sum(area(window, r), |_| true, |_| 1.0);
            write!(out, ",{}", (error.variance.sqrt() / n) as f32)?;
        }
    }
    writeln!(out)
}

/// A region inside the window, counted from the window's corner.
fn area(window: Window, r: &Region) -> PixelBounds {
    let from = |v: u32, corner: i32| (i64::from(v) - i64::from(corner)) as u32;
    PixelBounds::new(
        from(r.x0, window.x0),
        from(r.y0, window.y0),
        from(r.x1, window.x0),
        from(r.y1, window.y0),
    )
}
