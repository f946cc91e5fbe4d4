//! `tyndall render`.

mod light;
mod output;
mod replay;
mod run;
mod stop;

use std::path::{Path, PathBuf};

use clap::Args;

pub use light::{Integrator, LightArgs, SpectralStrategy, Switch, WavelengthPdf, WavelengthRule};
pub(super) use output::needs_picture;
pub use output::{Names, OutputArgs};
pub use replay::ReplayArgs;
pub use run::{CheckpointFile, InstructionSet, RunArgs};
pub use stop::{ErrorMode, StopArgs};

use super::{Conflict, SceneArgs};

/// The scene that is rendered when none is named.
pub const BUILT_IN_SCENE: &str = "cornell-fog";

/// Arguments of `tyndall render`.
#[derive(Args, Clone, Debug)]
#[command(
    long_about = "\
Render a scene, or the built-in box of fog.

Writes NAME.exr (linear, with the film's channels), NAME.png (for the eye) and NAME.run.json (what was done, how long \
it took, and the error), where NAME is the scene's.",
    after_help = "\
Examples:
  tyndall render                                    the built-in box of fog
  tyndall render fog.pbrt -o fog.exr --spp 256
  tyndall render fog.pbrt --until rel=1% --time 9m   1 % error or 9 minutes
  tyndall render fog.pbrt --bands 400:700:10        a spectral image, 30 bands
  tyndall render fog.pbrt --resume                  go on after an interruption
  tyndall render fog.pbrt --shard 2/8               one eighth of the work, for
                                                    `tyndall merge`"
)]
pub struct RenderArgs {
    /// The scene, in pbrt-v4's format (may be gzipped) [default: the built-in box of fog]
    #[arg(value_name = "SCENE.pbrt")]
    pub scene: Option<PathBuf>,
    /// What is written.
    #[command(flatten)]
    pub output: OutputArgs,
    /// When it ends.
    #[command(flatten)]
    pub stop: StopArgs,
    /// How light is followed.
    #[command(flatten)]
    pub light: LightArgs,
    /// How the scene is read.
    #[command(flatten)]
    pub reading: SceneArgs,
    /// How the work is done.
    #[command(flatten)]
    pub run: RunArgs,
    /// One path alone.
    #[command(flatten)]
    pub replay: ReplayArgs,
}

impl RenderArgs {
    /// Names of everything this run writes.
    pub fn names(&self) -> Names {
        let stem = self.scene.as_deref().map_or_else(|| BUILT_IN_SCENE.to_owned(), stem);
        Names::new(&stem, &self.output.files, self.run.shard)
    }

    /// Refuses what cannot be combined.
    pub(super) fn check(&self) -> Result<(), Conflict> {
        self.light.check()?;
        self.output.check(self.run.shard)?;
        self.run.check()?;
        let Some(shard) = self.run.shard else { return Ok(()) };
        if self.stop.time.is_some() {
            return Err(Conflict::new(
                format!("--shard {shard} with --time: shards that end by the clock do not add up to one job"),
                "give all shards the same --spp",
            ));
        }
        if self.stop.until.is_some() && self.run.guide.is_none() {
            return Err(Conflict::new(
                format!("--shard {shard} with --until: each shard would choose its own sample counts"),
                "give all shards the same --guide FILE, or --spp instead of --until",
            ));
        }
        Ok(())
    }
}

/// `fog` for `scenes/fog.pbrt` and `scenes/fog.pbrt.gz`.
fn stem(scene: &Path) -> String {
    let name = scene.file_name().map_or_else(|| BUILT_IN_SCENE.into(), |name| name.to_string_lossy());
    let name = name.strip_suffix(".gz").unwrap_or(&name);
    name.strip_suffix(".pbrt").unwrap_or(name).to_owned()
}

#[cfg(test)]
mod tests {
    use super::super::Command;
    use super::super::tests::parse;
    use super::*;

    pub(super) fn render(options: &str) -> Result<Box<RenderArgs>, String> {
        match parse(&format!("tyndall render {options}"))? {
            Command::Render(render) => Ok(render),
            other => panic!("not render: {other:?}"),
        }
    }

    #[test]
    fn names_come_from_the_scene() {
        assert_eq!(stem(Path::new("scenes/fog.pbrt")), "fog");
        assert_eq!(stem(Path::new("fog.v2.pbrt.gz")), "fog.v2");
        assert_eq!(stem(Path::new("fog")), "fog");
        assert_eq!(
            render("").expect("valid").names().images,
            ["cornell-fog.exr", "cornell-fog.png"].map(PathBuf::from)
        );
    }

    #[test]
    fn shards_need_a_fixed_job() {
        assert!(render("--shard 1/2 --spp 64").is_ok());
        assert!(render("--shard 1/2 --time 90s").expect_err("refused").contains("--spp"));
        assert!(render("--shard 1/2 --until rel=1%").expect_err("refused").contains("--guide"));
        assert!(render("--shard 1/2 --until rel=1% --guide a.guide").is_ok());
    }
}
