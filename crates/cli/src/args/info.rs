//! `tyndall info`.

use std::path::PathBuf;

use clap::Args;

use super::SceneArgs;

/// Arguments of `tyndall info`.
#[derive(Args, Clone, Debug)]
#[command(
    long_about = "\
Tell what is in a scene, and what of it is used.

Lists media with units and optical depths, lights, spectral ranges, boundaries between media that contradict each \
other, and every parameter of the scene as consumed, ignored or unsupported.",
    after_help = "\
Examples:
  tyndall info fog.pbrt
  tyndall info --json fog.pbrt | python3 -m json.tool"
)]
pub struct InfoArgs {
    /// The scene, in pbrt-v4's format (may be gzipped) [default: the built-in box of fog]
    #[arg(value_name = "SCENE.pbrt")]
    pub scene: Option<PathBuf>,
    /// Print one JSON object instead of a text
    #[arg(long)]
    pub json: bool,
    /// How the scene is read.
    #[command(flatten)]
    pub reading: SceneArgs,
}

#[cfg(test)]
mod tests {
    use super::super::Command;
    use super::super::tests::parse;

    #[test]
    fn scene_and_overrides() {
        let Ok(Command::Info(info)) = parse("tyndall info a.pbrt --set fog.scale=2 --range 380:780 --strict")
        else {
            panic!("valid");
        };
        assert_eq!(info.scene.expect("given").as_os_str(), "a.pbrt");
        assert_eq!(info.reading.overrides.len(), 1);
        assert!(info.reading.strict && !info.json && info.reading.range.is_some());
    }
}
