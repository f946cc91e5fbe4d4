//! What a render writes, and under which names.

use std::path::{Path, PathBuf};

use clap::Args;

use super::{Conflict, Switch};
use crate::args::value::{
    Aov, Bands, Crop, Duration, FileKind, ImageFile, Orders, Resolution, ServerAddress, Shard,
};

/// What is written.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Output")]
pub struct OutputArgs {
    /// Where an image goes; may be repeated (.exr, .png, .csv, .nc, .film) [default: NAME.exr and NAME.png]
    #[arg(long = "output", short = 'o', value_name = "FILE", value_parser = ImageFile::parse)]
    pub files: Vec<ImageFile>,
    /// Replace results of another job
    #[arg(long)]
    pub force: bool,
    /// Size in pixels [default: the scene's]
    #[arg(long, value_name = "WxH", value_parser = Resolution::parse)]
    pub resolution: Option<Resolution>,
    /// Render this part only, in fractions of the picture from its upper left corner
    #[arg(long, value_name = "X0,X1,Y0,Y1", value_parser = Crop::parse)]
    pub crop: Option<Crop>,
    /// Write spectral bands with these edges in nm, beside R, G, B [default: the film's]
    #[arg(long, value_name = "FROM:TO:STEP", value_parser = Bands::parse)]
    pub bands: Option<Bands>,
    /// Write these layers too, separated by commas
    #[arg(long = "aov", value_name = "LIST", value_enum, value_delimiter = ',')]
    pub aovs: Vec<Aov>,
    /// Write orders of scattering apart: `0,1,2+` is direct, single and multiple scattering
    #[arg(long, value_name = "LIST", value_parser = Orders::parse)]
    pub split_orders: Option<Orders>,
    /// Write the image so far every so often [default: only at the end]
    #[arg(long, value_name = "TIME", value_parser = Duration::parse)]
    pub write_every: Option<Duration>,
    /// Take the noise out of pictures (.png), by the standard errors; numbers stay as they are [default: the scene's, else
    /// off]
    #[arg(long, value_enum, value_name = "WHETHER")]
    pub denoise: Option<Switch>,
    /// Show the image in `tev` while it renders; port 14158 if none is given
    #[arg(long, value_name = "HOST[:PORT]", value_parser = ServerAddress::parse)]
    pub display_server: Option<ServerAddress>,
}

impl OutputArgs {
    /// Refuses what cannot be combined.
    pub(super) fn check(&self, shard: Option<Shard>) -> Result<(), Conflict> {
        let default = self.files.is_empty() && shard.is_none();
        if self.denoise == Some(Switch::On) && !default {
            needs_picture(&self.files)?;
        }
        let picture = self.files.iter().find(|file| file.kind != FileKind::Film);
        match (shard, picture) {
            (Some(shard), Some(picture)) => Err(Conflict::new(
                format!("--shard {shard} with -o {}: a shard is not an image yet", picture.path.display()),
                "write a .film, and join the films of all shards by `tyndall merge`",
            )),
            _ => Ok(()),
        }
    }
}

/// Refuses to denoise where no picture is written.
pub(in crate::args) fn needs_picture(files: &[ImageFile]) -> Result<(), Conflict> {
    if files.iter().any(|file| file.kind == FileKind::Png) {
        return Ok(());
    }
    Err(Conflict::new("--denoise takes the noise out of pictures, and none is written", "add -o NAME.png"))
}

/// Names of everything a run writes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Names {
    /// The images, or the film of a shard.
    pub images: Vec<PathBuf>,
    /// The record of the run.
    pub run_json: PathBuf,
    /// Standard errors, channel by channel like the image.
    pub error: PathBuf,
    /// The state to resume from, unless an option names another.
    pub checkpoint: PathBuf,
}

impl Names {
    pub(super) fn new(stem: &str, files: &[ImageFile], shard: Option<Shard>) -> Self {
        let images = if files.is_empty() {
            default(stem, shard)
        } else {
            files.iter().map(|file| file.path.clone()).collect()
        };
        // everything else goes beside the first image
        let first = images.first().map_or_else(|| Path::new(stem), PathBuf::as_path);
        let beside = |ending: &str| first.with_extension(ending);
        let (run_json, error, checkpoint) = (beside("run.json"), beside("error.exr"), beside("ckpt"));
        Self { images, run_json, error, checkpoint }
    }
}

fn default(stem: &str, shard: Option<Shard>) -> Vec<PathBuf> {
    let names = match shard {
        Some(shard) => vec![format!("{stem}.{}-of-{}.film", shard.index, shard.count)],
        None => vec![format!("{stem}.exr"), format!("{stem}.png")],
    };
    names.into_iter().map(PathBuf::from).collect()
}

#[cfg(test)]
mod tests {
    use super::super::tests::render;
    use super::*;

    #[test]
    fn everything_lies_beside_the_first_image() {
        let names = render("x.pbrt -o out/a.png -o b.exr").expect("valid").names();
        assert_eq!(names.images, ["out/a.png", "b.exr"].map(PathBuf::from));
        assert_eq!(names.run_json, Path::new("out/a.run.json"));
        assert_eq!(names.error, Path::new("out/a.error.exr"));
        assert_eq!(names.checkpoint, Path::new("out/a.ckpt"));
    }

    #[test]
    fn shards_have_their_own_names() {
        let names = render("x.v2.pbrt --shard 2/3").expect("valid").names();
        assert_eq!(names.images, [PathBuf::from("x.v2.2-of-3.film")]);
        assert_eq!(names.run_json, Path::new("x.v2.2-of-3.run.json"));
        assert!(render("--shard 2/3 -o a.exr").expect_err("refused").contains("merge"));
        assert!(render("--shard 2/3 -o a.film").is_ok());
    }

    #[test]
    fn only_pictures_are_denoised() {
        assert_eq!(render("--denoise off").expect("valid").output.denoise, Some(Switch::Off));
        assert!(render("--denoise on").is_ok() && render("--denoise on -o a.exr -o a.png").is_ok());
        for numbers in ["-o a.exr", "-o a.film --shard 1/2", "--shard 1/2"] {
            let refused = render(&format!("--denoise on {numbers}")).expect_err(numbers);
            assert!(refused.contains("-o NAME.png"), "{refused}");
        }
    }

    #[test]
    fn lists() {
        let output = render("--aov depth,first-scatter --split-orders 0,1,2+").expect("valid").output;
        assert_eq!(output.aovs, [Aov::Depth, Aov::FirstScatter]);
        assert_eq!(output.split_orders.expect("given").to_string(), "0,1,2+");
        assert!(render("--aov depth,nonsense").expect_err("refused").contains("possible values"));
    }
}
