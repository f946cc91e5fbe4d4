//! An image as a table (CSV): one row a pixel, units in the header.

use crate::{
    Error, Image,
    image::{attribute, ordered},
    units,
};
use std::{
    fs::File,
    io::{self, BufRead, BufReader, Write},
    path::Path,
};
use tyndall_files::{
    atomic::write_atomic,
    image::{Channel, MetaValue, Window},
};

const JOB_LINE: &str = "# job: ";

/// Writes the pixels `rows`, or all of them when there are none, counted in the whole image.
///
/// # Errors
/// When a pixel lies outside, or writing fails.
pub fn write(path: &Path, image: &Image, rows: &[(u32, u32)]) -> Result<(), Error> {
    let window = image.values.window();
    let inside = |&(x, y): &(u32, u32)| {
        let (x, y) = (i64::from(x) - i64::from(window.x0), i64::from(y) - i64::from(window.y0));
        (0..window.width as i64).contains(&x) && (0..window.height as i64).contains(&y)
    };
    if let Some((x, y)) = rows.iter().find(|p| !inside(p)) {
        let what =
            format!("pixel {x},{y} lies outside the image's window of {} x {}", window.width, window.height);
        return Err(Error::options(what, Some("pixels count from 0 at the upper left".into())));
    }
    let columns = columns(image);
    write_atomic(path, |out| {
        header(image, &columns, out)?;
        if rows.is_empty() {
            (0..window.area()).try_for_each(|p| row(window, &columns, p, out))
        } else {
            let index = |(x, y): (u32, u32)| {
                (i64::from(y) - i64::from(window.y0)) as usize * window.width
                    + (i64::from(x) - i64::from(window.x0)) as usize
            };
            rows.iter().try_for_each(|&pixel| row(window, &columns, index(pixel), out))
        }
    })?;
    Ok(())
}

/// A channel and its standard errors.
struct Column<'i> {
    channel: &'i Channel,
    errors: Option<&'i [f32]>,
}

fn columns(image: &Image) -> Vec<Column<'_>> {
    let errors = |c: &Channel| image.errors.as_ref()?.channel(&c.name);
    ordered(&image.values).into_iter().map(|channel| Column { channel, errors: errors(channel) }).collect()
}

fn header(image: &Image, columns: &[Column<'_>], out: &mut impl Write) -> io::Result<()> {
    let text = |name: &str| match image.values.meta.get(name) {
        Some(MetaValue::Text(t)) => Some(t.as_str()),
        _ => None,
    };
    if let Some(software) = text("software") {
        writeln!(out, "# {software}")?;
    }
    if let Some(job) = text(attribute::JOB) {
        writeln!(out, "{JOB_LINE}{job}")?;
    }
    writeln!(out, "# unit of spectral radiance: {}", text(attribute::UNITS).unwrap_or("unknown"))?;
    writeln!(
        out,
        "# pixels count from 0 at the upper left; se: standard error of the value before it, in its unit"
    )?;
    let absolute = image.is_absolute();
    write!(out, "x,y")?;
    for Column { channel, errors } in columns {
        write!(out, ",{}", cell(&format!("{} [{}]", channel.name, unit(&channel.name, absolute))))?;
        if errors.is_some() {
            write!(out, ",{}", cell(&format!("{} se", channel.name)))?;
        }
    }
    writeln!(out)
}

/// Decimal commas of spectral names would split a cell without quotes (RFC 4180).
fn cell(text: &str) -> String {
    if text.contains(',') { format!("\"{text}\"") } else { text.to_owned() }
}

/// The unit of a channel.
fn unit(name: &str, absolute: bool) -> &'static str {
    let layer = name.split('.').next().unwrap_or(name);
    match layer {
        "depth" | "first-scatter" => "m",
        "normal" | "albedo" | "transmittance" => "1",
        _ if !absolute => units::NORMALISED,
        _ if name.ends_with("nm") => units::ABSOLUTE,
        _ => units::INTEGRATED,
    }
}

fn row(window: Window, columns: &[Column<'_>], p: usize, out: &mut impl Write) -> io::Result<()> {
    let (x, y) = (window.x0 as i64 + (p % window.width) as i64, window.y0 as i64 + (p / window.width) as i64);
    write!(out, "{x},{y}")?;
    for Column { channel, errors } in columns {
        write!(out, ",{}", channel.data[p])?;
        if let Some(se) = errors {
            write!(out, ",{}", se[p])?;
        }
    }
    writeln!(out)
}

/// The job that a table belongs to.
pub(crate) fn job_of(path: &Path) -> Option<String> {
    let lines = BufReader::new(File::open(path).ok()?).lines().map_while(Result::ok);
    lines.take(4).find_map(|l| l.strip_prefix(JOB_LINE).map(str::to_owned))
}
