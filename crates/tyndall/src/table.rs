//! An image as a table (CSV): one row a pixel or region, units in the header.

mod rows;

use crate::{
    Error, Image,
    image::{attribute, ordered},
    statistics, units,
};
pub use rows::{Region, Rows};
use std::{
    fs::File,
    io::{self, BufRead, BufReader, Write},
    path::Path,
};
use tyndall_files::{
    atomic::write_atomic,
    image::{Channel, MetaValue},
};
use tyndall_film::Squares;

const JOB_LINE: &str = "# job: ";

/// Writes the rows, which are counted in the whole image.
///
/// # Errors
/// When a row lies outside, or writing fails.
pub fn write(path: &Path, image: &Image, rows: &Rows) -> Result<(), Error> {
    rows.check(image.values.window())?;
    let columns = columns(image);
    write_atomic(path, |out| {
        header(image, &columns, rows, out)?;
        rows.write(image.values.window(), &columns, out)
    })?;
    Ok(())
}

/// A channel, with its standard errors where they are known.
struct Column<'i> {
    channel: &'i Channel,
    errors: Option<Squares<'i>>,
    /// How pixels make up a region.
    join: Join,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Join {
    Mean,
    Sum,
    /// Makes no sense for a region.
    None,
}

/// Channels as people expect them, then what is known of the errors.
fn columns(image: &Image) -> Vec<Column<'_>> {
    let values = ordered(&image.values).into_iter().map(|channel| Column {
        channel,
        errors: image.squares(&channel.name),
        join: Join::Mean,
    });
    let find = |name: &str| image.errors.as_ref()?.channels().iter().find(|c| c.name == name);
    let marks = statistics::NAMES.into_iter().filter_map(|name| {
        let join = if name == statistics::FREEDOM { Join::None } else { Join::Sum };
        find(name).map(|channel| Column { channel, errors: None, join })
    });
    values.chain(marks).collect()
}

fn header(image: &Image, columns: &[Column<'_>], rows: &Rows, out: &mut impl Write) -> io::Result<()> {
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
    if let Rows::Regions(_) = rows {
        writeln!(
            out,
            "# regions: means over the pixels from x0,y0 up to but not including x1,y1; statistics: sums"
        )?;
        if image.square() > 1 {
            writeln!(out, "# {}", shared(image))?;
        }
    }
    let absolute = image.is_absolute();
    write!(out, "{}", rows.place())?;
    for Column { channel, errors, .. } in columns.iter().filter(|c| rows.shows(c)) {
        write!(out, ",{}", cell(&format!("{} [{}]", channel.name, unit(&channel.name, absolute))))?;
        if errors.is_some() {
            write!(out, ",{}", cell(&format!("{} se", channel.name)))?;
        }
    }
    writeln!(out)
}

/// What the errors of regions are where pixels share paths.
fn shared(image: &Image) -> String {
    let (n, window) = (image.square(), image.values.window());
    let known = image
        .errors
        .as_ref()
        .is_some_and(|e| e.channels().iter().any(|c| statistics::is_of_squares(&c.name)));
    let bound = if known { "upper bounds where a region cuts one" } else { "upper bounds" };
    format!(
        "pixels of a square of {n} x {n}, counted from {},{}, share paths; errors of regions: {bound}",
        window.x0, window.y0
    )
}

/// Decimal commas of spectral names would split a cell without quotes (RFC 4180).
fn cell(text: &str) -> String {
    if text.contains(',') { format!("\"{text}\"") } else { text.to_owned() }
}

/// The unit of a channel.
pub(crate) fn unit(name: &str, absolute: bool) -> &'static str {
    let layer = name.split('.').next().unwrap_or(name);
    match layer {
        "depth" | "first-scatter" => "m",
        "normal" | "albedo" | "transmittance" | "statistics" => "1",
        _ if !absolute => units::NORMALISED,
        _ if name.ends_with("nm") => units::ABSOLUTE,
        _ => units::INTEGRATED,
    }
}

/// The job that a table belongs to.
pub(crate) fn job_of(path: &Path) -> Option<String> {
    let lines = BufReader::new(File::open(path).ok()?).lines().map_while(Result::ok);
    lines.take(4).find_map(|l| l.strip_prefix(JOB_LINE).map(str::to_owned))
}
