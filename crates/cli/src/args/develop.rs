//! `tyndall develop`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::Conflict;
use super::value::{FileKind, ImageFile, Interval, Pixel, Region, WhitePoint, finite};

/// Arguments of `tyndall develop`.
#[derive(Args, Clone, Debug)]
#[command(
    long_about = "\
Turn a film or EXR into a picture: exposure, white point, colour space, one band, false colour in cd/m2; or write its \
numbers as a table.",
    after_help = "\
Examples:
  tyndall develop fog.exr -o fog.png --exposure 1.5
  tyndall develop fog.exr -o clean.png --denoise
  tyndall develop fog.exr -o red.png --band 650
  tyndall develop fog.exr -o luminance.png --false-colour 0.1:100
  tyndall develop fog.exr -o points.csv --probe 10,20 --probe 30,40
  tyndall develop fog.exr -o regions.csv --region 0,16,0,16 --region 16,32,0,16
  tyndall develop fog.film -o fog.nc"
)]
pub struct DevelopArgs {
    /// The film or EXR
    #[arg(value_name = "FILM|EXR")]
    pub input: PathBuf,
    /// Where the result goes; may be repeated (.png, .exr, .csv, .nc)
    #[arg(long, short, value_name = "FILE", required = true, value_parser = ImageFile::parse)]
    pub output: Vec<ImageFile>,
    /// Replace existing files
    #[arg(long)]
    pub force: bool,
    /// What the picture shows.
    #[command(flatten)]
    pub look: LookArgs,
    /// Write this pixel to the table (.csv); may be repeated [default: all pixels]
    #[arg(long, value_name = "X,Y", value_parser = Pixel::parse, help_heading = "Table")]
    pub probe: Vec<Pixel>,
    /// Write means over pixels from X0,Y0 up to but not including X1,Y1 to the table; may be repeated
    #[arg(long, value_name = "X0,X1,Y0,Y1", value_parser = Region::parse, help_heading = "Table")]
    pub region: Vec<Region>,
}

/// What the picture shows.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Picture")]
pub struct LookArgs {
    /// Exposure in stops: +1 doubles the brightness [default: 0; for images in W m^-2 sr^-1 and for single bands the one
    /// that takes the 99th percentile of luminance to white]
    #[arg(long, value_name = "STOPS", allow_negative_numbers = true, value_parser = finite)]
    pub exposure: Option<f64>,
    /// What shall look white: A, D50, D55, D60, D65, D75, E, a temperature as 3200K, or x,y [default: no change]
    #[arg(long, value_name = "WHITE", value_parser = WhitePoint::parse)]
    pub white: Option<WhitePoint>,
    /// Colour space of the result
    #[arg(long, visible_alias = "color-space", value_enum, value_name = "SPACE", default_value_t = DevelopSpace::Srgb)]
    pub colour_space: DevelopSpace,
    /// Show only the band that holds this wavelength, in grey
    #[arg(long, value_name = "NM", value_parser = super::value::positive, conflicts_with = "false_colour")]
    pub band: Option<f64>,
    /// Show luminance in false colour over this interval in cd/m2, logarithmic
    #[arg(long, visible_alias = "false-color", value_name = "MIN:MAX", value_parser = Interval::parse)]
    pub false_colour: Option<Interval>,
    /// Take the noise out, by the standard errors (of a film, or in NAME.error.exr); only for pictures (.png)
    #[arg(long)]
    pub denoise: bool,
}

/// Colour spaces of a developed picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
#[non_exhaustive]
pub enum DevelopSpace {
    /// sRGB, with its transfer function in PNG
    Srgb,
    /// DCI-P3 with a D65 white point
    DciP3,
    /// ITU-R BT.2020
    Rec2020,
    /// ACES2065-1
    Aces,
}

impl DevelopArgs {
    /// Refuses what cannot be combined.
    pub(super) fn check(&self) -> Result<(), Conflict> {
        let tables = self.output.iter().any(|file| file.kind.is_table());
        let rows = !self.probe.is_empty() || !self.region.is_empty();
        if rows && !tables {
            return Err(Conflict::new(
                "--probe and --region choose rows of a table, and no table is written",
                "add -o NAME.csv",
            ));
        }
        let numbers = self.output.iter().find(|file| file.kind != FileKind::Png);
        match numbers.filter(|_| self.look.denoise) {
            Some(file) => Err(Conflict::new(
                format!(
                    "--denoise with -o {}: numbers without noise would have no errors either",
                    file.path.display()
                ),
                "write .png; another `tyndall develop` without --denoise writes the rest",
            )),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Command;
    use super::super::tests::parse;
    use super::*;

    #[test]
    fn looks() {
        let line = "tyndall develop a.exr -o a.png --exposure -1.5 --white 3200K --color-space rec2020";
        let Ok(Command::Develop(develop)) = parse(line) else { panic!("valid") };
        assert_eq!(develop.look.exposure, Some(-1.5));
        assert_eq!(develop.look.white, Some(WhitePoint::Temperature(3200.0)));
        assert_eq!(develop.look.colour_space, DevelopSpace::Rec2020);
    }

    #[test]
    fn refusals() {
        assert!(parse("tyndall develop a.exr").is_err(), "no output");
        assert!(parse("tyndall develop a.exr -o a.png --band 550 --false-colour 1:10").is_err());
        assert!(parse("tyndall develop a.exr -o a.png --exposure inf").is_err());
        assert!(parse("tyndall develop a.exr -o a.png --probe 1,2").expect_err("no table").contains("hint"));
        assert!(parse("tyndall develop a.exr -o a.csv --probe 1,2").is_ok());
        let numbers =
            parse("tyndall develop a.exr -o a.png -o b.exr --denoise").expect_err("b.exr holds numbers");
        assert!(numbers.contains("--denoise with -o b.exr"), "{numbers}");
        assert!(parse("tyndall develop a.exr -o a.png --denoise").is_ok());
    }
}
