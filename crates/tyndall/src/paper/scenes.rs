//! The paper's scene and its variants, as files in the folder of the results: every picture can be repeated from them.

use crate::Error;
use std::{
    fs,
    path::{Path, PathBuf},
};
use tyndall_files::FileError;
use tyndall_spectral::{
    Curve, LambdaRange, Outside, cie,
    colour::{ColourSpace, SpaceName},
};

/// The paper's range \[nm\].
pub const RANGE: LambdaRange = LambdaRange { min: 380.0, max: 780.0 };
/// Edges of the three bands that carry red, green and blue of [`Scene::Rgb`], blue first \[nm\].
pub const RGB_EDGES: [f32; 4] = [380.0, 508.0, 636.0, 764.0];

const BOX: &str = include_str!("../../scenes/paper/box.pbrt");
const FOG: &str = include_str!("../../scenes/paper/fog.pbrt");
const CLEAR: &str = include_str!("../../scenes/paper/clear.pbrt");
const NOTICE: &str = include_str!("../../scenes/paper/NOTICE.md");
const SPECTRA: [(&str, &str); 5] = [
    ("cornell-white.spd", include_str!("../../scenes/paper/cornell-white.spd")),
    ("cornell-green.spd", include_str!("../../scenes/paper/cornell-green.spd")),
    ("cornell-red.spd", include_str!("../../scenes/paper/cornell-red.spd")),
    ("fog-sigma-s.spd", include_str!("../../scenes/paper/fog-sigma-s.spd")),
    ("fog-sigma-a.spd", include_str!("../../scenes/paper/fog-sigma-a.spd")),
];
const LAMP: &str = "\"float scale\" 0.15 \"spectrum L\" \"stdillum-D65\"";

/// A variant of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scene {
    /// The box without fog.
    Clear,
    /// With fog.
    Fog,
    /// Without fog, with a lamp of radiance 1 at all wavelengths.
    ClearFlat,
    /// With fog and that lamp.
    FogFlat,
    /// With fog; every spectrum replaced by its red, green and blue.
    Rgb,
}

impl Scene {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Clear, Self::Fog, Self::ClearFlat, Self::FogFlat, Self::Rgb];

    /// The file's name.
    pub const fn file(self) -> &'static str {
        match self {
            Self::Clear => "clear.pbrt",
            Self::Fog => "fog.pbrt",
            Self::ClearFlat => "clear-flat.pbrt",
            Self::FogFlat => "fog-flat.pbrt",
            Self::Rgb => "fog-rgb.pbrt",
        }
    }

    fn text(self) -> String {
        match self {
            Self::Clear => CLEAR.into(),
            Self::Fog => FOG.into(),
            Self::ClearFlat => CLEAR.replace("box.pbrt", "box-flat.pbrt"),
            Self::FogFlat => FOG.replace("box.pbrt", "box-flat.pbrt"),
            Self::Rgb => coloured(FOG).replace("box.pbrt", "box-rgb.pbrt"),
        }
    }
}

/// Writes all scenes and their spectra into `folder`.
///
/// # Errors
/// What the system says.
pub fn write(folder: &Path) -> Result<(), Error> {
    let put = |name: &str, text: &str| -> Result<(), Error> {
        let path = folder.join(name);
        // an unchanged file keeps its time
        if fs::read_to_string(&path).is_ok_and(|old| old == text) {
            return Ok(());
        }
        fs::write(&path, text).map_err(|e| FileError::io(&path, "write", e).into())
    };
    fs::create_dir_all(folder).map_err(|e| FileError::io(folder, "create", e))?;
    put("box.pbrt", BOX)?;
    put("box-flat.pbrt", &BOX.replace(LAMP, "\"spectrum L\" [380 1 780 1]"))?;
    put("box-rgb.pbrt", &coloured(BOX))?;
    put("NOTICE.md", NOTICE)?;
    SPECTRA.iter().try_for_each(|(name, text)| put(name, text))?;
    Scene::ALL.iter().try_for_each(|s| put(s.file(), &s.text()))
}

/// The path of a scene in `folder`.
pub fn path(folder: &Path, scene: Scene) -> PathBuf {
    folder.join(scene.file())
}

/// A spectrum of the scene by its file's name, held at its ends.
pub fn spectrum(name: &str) -> Curve {
    let (_, text) = SPECTRA.iter().find(|(n, _)| *n == name).expect("a spectrum of the scene");
    let numbers: Vec<f32> = text
        .lines()
        .filter(|l| !l.starts_with('#'))
        .flat_map(|l| l.split_whitespace().map(|v| v.parse::<f32>().expect("a table of numbers")))
        .collect();
    Curve::interleaved(&numbers, Outside::Hold).expect("an ascending table")
}

/// The lamp \[W m^-2 sr^-1 nm^-1\].
pub fn lamp() -> Curve {
    tyndall_spectral::named::named_spectrum("stdillum-D65").expect("a named illuminant").scaled(0.15)
}

/// A scene's text with red, green and blue in three bands in place of every spectrum: an RGB renderer's view.
fn coloured(text: &str) -> String {
    let white = rgb(&lamp());
    let mut out = text.replace(&format!(" {LAMP}"), &bands("L", white));
    for (name, _) in SPECTRA {
        let parameter = if name.ends_with("-s.spd") {
            "sigma_s"
        } else if name.ends_with("-a.spd") {
            "sigma_a"
        } else {
            "reflectance"
        };
        // as a surface in the lamp's light, relative to white
        let lit = rgb(&lamp().times(&spectrum(name)));
        let value: [f64; 3] = std::array::from_fn(|c| (lit[c] / white[c]).max(0.0));
        let limit = if parameter == "reflectance" { 1.0 } else { f64::INFINITY };
        out = out.replace(
            &format!(" \"spectrum {parameter}\" \"{name}\""),
            &bands(parameter, value.map(|v| v.min(limit))),
        );
    }
    out
}

/// Linear sRGB of a light.
fn rgb(light: &Curve) -> [f64; 3] {
    ColourSpace::get(SpaceName::Srgb).rgb_from_xyz.apply(cie::xyz_over(light, RANGE))
}

/// Constant in each of the three bands, blue first, with jumps one unit in the last place wide.
fn bands(name: &str, [r, g, b]: [f64; 3]) -> String {
    let e = RGB_EDGES;
    let piece = |i: usize, v: f64| format!("{} {v:e} {} {v:e}", e[i], e[i + 1].next_down());
    format!(" \"spectrum {name}\" [{} {} {}]", piece(0, b), piece(1, g), piece(2, r))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variants_differ_where_they_should() {
        let rgb = coloured(BOX) + &coloured(FOG);
        assert!(!rgb.contains(".spd") && !rgb.contains("stdillum"), "{rgb}");
        assert!(BOX.contains(LAMP) && !Scene::ClearFlat.text().contains("\"box.pbrt\""));
        assert!(FOG.contains("fog-sigma-s.spd") && !CLEAR.contains("MediumInterface"));
    }

    #[test]
    fn the_fog_has_the_ranges_of_figure_5() {
        let (s, a) = (spectrum("fog-sigma-s.spd"), spectrum("fog-sigma-a.spd"));
        assert!(s.eval(475.0) > 4.0 * s.eval(700.0) && a.eval(700.0) > 10.0 * a.eval(475.0));
        assert_eq!(spectrum("cornell-red.spd").eval(380.0), 0.04);
    }
}
