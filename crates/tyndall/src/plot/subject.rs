//! What can be drawn, as people write it.

use std::path::PathBuf;

/// What is drawn.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Subject {
    /// The media of a scene, or one of them.
    Medium {
        /// The scene's file.
        scene: PathBuf,
        /// The medium's name; all of them when `None`.
        medium: Option<String>,
    },
    /// A file of wavelengths and values, or a spectrum that scenes can name.
    Spectrum {
        /// Path or name.
        name: String,
    },
    /// A pixel of a spectral image.
    Pixel {
        /// The image's file.
        image: PathBuf,
        /// From the left, from 0.
        x: u32,
        /// From the top, from 0.
        y: u32,
    },
}

impl Subject {
    /// Reads `SCENE.pbrt`, `SCENE.pbrt:MEDIUM`, `IMAGE@x,y`, or else the file or name of a spectrum.
    ///
    /// # Errors
    /// What was expected instead.
    pub fn parse(text: &str) -> Result<Self, String> {
        if let Some((image, pixel)) = text.rsplit_once('@') {
            let number = |t: &str| t.trim().parse().ok();
            let xy = pixel.split_once(',').and_then(|(x, y)| Some((number(x)?, number(y)?)));
            let Some((x, y)) = xy else {
                return Err(format!(
                    "expected a pixel x,y counted from 0 at the upper left after @, such as fog.exr@10,20, got `{pixel}`"
                ));
            };
            return Ok(Self::Pixel { image: image.into(), x, y });
        }
        for ending in [".pbrt", ".pbrt.gz"] {
            if text.ends_with(ending) {
                return Ok(Self::Medium { scene: text.into(), medium: None });
            }
            if let Some((scene, name)) = text.rsplit_once(':')
                && scene.ends_with(ending)
            {
                return Ok(Self::Medium { scene: scene.into(), medium: Some(name.into()) });
            }
        }
        if text.ends_with(".exr") || text.ends_with(".film") {
            return Err(format!("expected a pixel of the image, such as {text}@10,20"));
        }
        Ok(Self::Spectrum { name: text.into() })
    }

    /// A name for the drawing: `fog.svg`, `fog.mist.svg`, `fog.10-20.svg`.
    pub fn file_name(&self) -> String {
        let stem = |path: &std::path::Path| {
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            name.split('.').next().filter(|s| !s.is_empty()).unwrap_or("plot").to_owned()
        };
        let plain = |text: &str| -> String {
            text.chars().map(|c| if c.is_alphanumeric() || c == '-' { c } else { '_' }).collect()
        };
        match self {
            Self::Medium { scene, medium: None } => format!("{}.svg", stem(scene)),
            Self::Medium { scene, medium: Some(name) } => format!("{}.{}.svg", stem(scene), plain(name)),
            Self::Spectrum { name } => format!("{}.svg", stem(std::path::Path::new(name))),
            Self::Pixel { image, x, y } => format!("{}.{x}-{y}.svg", stem(image)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_people_write() {
        let medium = |text: &str| match Subject::parse(text) {
            Ok(Subject::Medium { scene, medium }) => (scene.display().to_string(), medium),
            other => panic!("{other:?}"),
        };
        assert_eq!(medium("a/fog.pbrt"), ("a/fog.pbrt".into(), None));
        assert_eq!(medium("fog.pbrt:mist"), ("fog.pbrt".into(), Some("mist".into())));
        assert_eq!(medium("c:fog.pbrt.gz:a b"), ("c:fog.pbrt.gz".into(), Some("a b".into())));
        let pixel = Subject::parse("out/x.exr@3, 4").expect("a pixel");
        assert_eq!(pixel, Subject::Pixel { image: "out/x.exr".into(), x: 3, y: 4 });
        assert_eq!(pixel.file_name(), "x.3-4.svg");
        assert_eq!(Subject::parse("glass-BK7"), Ok(Subject::Spectrum { name: "glass-BK7".into() }));
        assert!(Subject::parse("x.exr@3").is_err() && Subject::parse("x.exr").is_err());
        let named = Subject::parse("fog.pbrt:a/b").expect("a medium");
        assert_eq!(named.file_name(), "fog.a_b.svg");
    }
}
