//! `tyndall develop`.

use std::path::Path;

use tyndall::engine::{Backend, Threads};
use tyndall::files::image::{ExrOptions, Pixels, write_exr, write_png};
use tyndall::image::chromaticities;
use tyndall::spectral::{Outside, SpaceName, cie, colour, illuminant, illuminant::daylight_chromaticity};
use tyndall::table::{Region, Rows};
use tyndall::{Error, Image, Look, Picture, cube, picture, table};

use super::render::write_image;
use crate::args::value::{FileKind, WhitePoint};
use crate::args::{DevelopArgs, DevelopSpace};
use crate::exit::Failure;

/// Turns a film or an EXR into pictures, tables or images.
pub fn run(args: &DevelopArgs) -> Result<(), Failure> {
    for file in &args.output {
        refuse_to_replace(&file.path, args)?;
        if file.kind == FileKind::Film {
            return Err(Failure::input(
                format!("{}: a film is what images are developed from", file.path.display()),
                Some("write .exr, .png, .csv or .nc"),
            ));
        }
    }
    let image = Image::read(&args.input)?;
    let look = look(args)?;
    let rows = rows(args);
    for file in &args.output {
        match file.kind {
            FileKind::Csv => table::write(&file.path, &image, &rows)?,
            FileKind::Netcdf => cube::write(&file.path, &image)?,
            FileKind::Exr if is_plain(args) => {
                write_image(&image, &file.path, FileKind::Exr, None)?;
            }
            FileKind::Exr => {
                developed_exr(&file.path, &picture(&image, &exact(&look), space(args))?, space(args))?
            }
            _ => png(&file.path, &picture(&image, &look, space(args))?)?,
        }
    }
    Ok(())
}

/// Probes become regions of one pixel where there are regions too.
fn rows(args: &DevelopArgs) -> Rows {
    let probes = || args.probe.iter();
    match (args.probe.is_empty(), args.region.is_empty()) {
        (true, true) => Rows::All,
        (_, true) => Rows::Pixels(probes().map(|p| (p.x, p.y)).collect()),
        _ => {
            let regions =
                args.region.iter().map(|r| Region { x0: r.x[0], x1: r.x[1], y0: r.y[0], y1: r.y[1] });
            Rows::Regions(probes().map(|p| Region::pixel(p.x, p.y)).chain(regions).collect())
        }
    }
}

fn refuse_to_replace(path: &Path, args: &DevelopArgs) -> Result<(), Failure> {
    if path == args.input {
        return Err(Failure::input(
            format!("{}: is also the input", path.display()),
            Some("write to another name"),
        ));
    }
    if path.is_file() && !args.force {
        return Err(Failure::input(format!("{}: exists", path.display()), Some("--force replaces it")));
    }
    Ok(())
}

/// Nothing about the look is asked for: an EXR keeps all that the image has.
fn is_plain(args: &DevelopArgs) -> bool {
    let look = &args.look;
    let same =
        look.exposure.is_none() && look.white.is_none() && look.band.is_none() && look.false_colour.is_none();
    same && look.colour_space == DevelopSpace::Srgb
}

/// Linear numbers stay as they are unless an exposure is given.
fn exact(look: &Look) -> Look {
    Look { exposure: look.exposure.or(Some(0.0)), ..look.clone() }
}

const fn space(args: &DevelopArgs) -> SpaceName {
    match args.look.colour_space {
        DevelopSpace::Srgb => SpaceName::Srgb,
        DevelopSpace::DciP3 => SpaceName::DciP3,
        DevelopSpace::Rec2020 => SpaceName::Rec2020,
        DevelopSpace::Aces => SpaceName::Aces2065,
    }
}

fn look(args: &DevelopArgs) -> Result<Look, Failure> {
    Ok(Look {
        exposure: args.look.exposure,
        white: args.look.white.as_ref().map(white).transpose()?,
        band: args.look.band,
        false_colour: args.look.false_colour.map(|i| [i.from, i.to]),
        denoise: args.look.denoise.then(|| Threads::available().width()),
    })
}

fn white(white: &WhitePoint) -> Result<[f64; 2], Error> {
    Ok(match white {
        WhitePoint::Chromaticity(x, y) => [*x, *y],
        WhitePoint::Illuminant("E") => [1.0 / 3.0; 2],
        WhitePoint::Illuminant(name) => {
            colour::chromaticity(cie::xyz(&illuminant::illuminant(name, Outside::Hold)?))
        }
        // daylight from 4000 K on, a black body below
        WhitePoint::Temperature(kelvin) if *kelvin >= 4000.0 => daylight_chromaticity(*kelvin)?,
        WhitePoint::Temperature(kelvin) => {
            colour::chromaticity(cie::xyz(&tyndall::spectral::Curve::blackbody(*kelvin as f32)?))
        }
    })
}

fn png(path: &Path, picture: &Picture) -> Result<(), Error> {
    let report = write_png(path, &picture.pixels, &picture.png())?;
    if picture.denoised {
        tracing::info!("{} is denoised, for looking at", path.display());
    }
    if picture.automatic && picture.exposure != 0.0 {
        tracing::info!("{}: exposure {} stops", path.display(), picture.exposure);
    }
    for (count, what) in [
        (report.non_finite, "are not finite: shown in magenta"),
        (report.above, "are brighter than white: clipped"),
        (report.below, "lie outside of the colour space: clipped"),
    ] {
        if count > 0 {
            tracing::info!("{}: {count} of {} pixels {what}", path.display(), report.pixels);
        }
    }
    Ok(())
}

/// The picture's linear numbers, exposure applied, with the primaries of its space.
fn developed_exr(path: &Path, picture: &Picture, space: SpaceName) -> Result<(), Error> {
    let gain = 2f64.powf(picture.exposure) as f32;
    let source = &picture.pixels;
    let mut out = Pixels::cropped(source.window(), source.display());
    out.meta.clone_from(&source.meta);
    for channel in source.channels() {
        out.push(channel.name.as_str(), channel.data.iter().map(|v| v * gain).collect())?;
    }
    out.set("chromaticities", tyndall::files::image::MetaValue::Chromaticities(chromaticities(space)));
    out.set(tyndall::image::attribute::SPACE, space.name());
    // no result of the job any more
    out.meta.remove(tyndall::image::attribute::JOB);
    Ok(write_exr(path, &out, &ExrOptions { parallel: false, ..ExrOptions::default() })?)
}
