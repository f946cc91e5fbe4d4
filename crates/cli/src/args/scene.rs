//! Options of every command that reads a scene.

use clap::Args;

use super::value::{Override, Range};

/// How a scene is read.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Scene")]
pub struct SceneArgs {
    /// Override a parameter of the scene; may be repeated
    ///
    /// NAME is a named medium, material or texture, or one of `camera`, `film`, `integrator`, `sampler`; VALUE is
    /// written as in the scene file, without type and quotes. Example: --set fog.scale=0.5
    #[arg(long = "set", value_name = "NAME.PARAM=VALUE", value_parser = Override::parse)]
    pub overrides: Vec<Override>,
    /// Spectral range in nm [default: 360:830, widened to hold --bands]
    #[arg(long, value_name = "FROM:TO", value_parser = Range::parse)]
    pub range: Option<Range>,
    /// Make every warning about the scene an error (spectra that end inside the spectral range, for one)
    #[arg(long)]
    pub strict: bool,
}
