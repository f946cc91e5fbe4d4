//! A scene with known answers.

use super::{bands::Bands, scene};
use tyndall_spectral::LambdaRange;

/// What of an image is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measured {
    /// The mean radiance of each band.
    Bands,
    /// X, Y and Z.
    Xyz,
}

/// A scene with known answers: `expected = offset + factor * (mean over the image)`, one a band, or X, Y, Z.
#[derive(Clone, Debug)]
pub struct Case {
    /// Name within the family.
    pub name: String,
    /// The scene.
    pub text: String,
    /// Its bands.
    pub bands: Bands,
    /// Its spectral range.
    pub range: LambdaRange,
    /// What is compared.
    pub measured: Measured,
    /// Known answers.
    pub expected: Vec<f64>,
    /// What each of them belongs to.
    pub labels: Vec<String>,
    /// Standard error, or rounding, of the known answers themselves.
    pub uncertainty: f64,
    /// See the type.
    pub offset: f64,
    /// See the type.
    pub factor: f64,
    /// Most scatterings of a path; no limit when `None`.
    pub max_depth: Option<u32>,
    /// Multiplies the samples of every run: rare or heavy contributions need more.
    pub effort: u32,
    /// Whether paths meet the source by chance, so that analog walks see it.
    pub by_chance: bool,
    /// Whether wavelengths may share every decision of a path: no extinction, phase function or index varies with
    /// wavelength. Albedos and reflectances may by a little: OPAW's roulette goes by their mean m, and a wavelength of
    /// albedo a with a^2 > m has no finite variance on paths without an end.
    pub grey: bool,
    /// The greatest contribution that is not rare, in the unit of the answers: `expected / brightest` is the share of paths
    /// that tell something.
    pub brightest: f64,
}

impl Case {
    /// Bands of a scene without a limit of depth that is lit by what paths meet by chance.
    pub fn new(name: impl Into<String>, bands: Bands, text: String, expected: Vec<f64>) -> Self {
        let labels = (0..expected.len()).map(|i| format!("band {i}")).collect();
        Self {
            name: name.into(),
            text,
            bands,
            range: bands.range(),
            measured: Measured::Bands,
            expected,
            labels,
            uncertainty: 0.0,
            offset: 0.0,
            factor: 1.0,
            max_depth: None,
            effort: 1,
            by_chance: true,
            grey: false,
            brightest: 1.0,
        }
    }

    /// X, Y and Z over a spectral range instead of bands, times `factor`.
    #[must_use]
    pub fn xyz(self, range: LambdaRange, factor: f64) -> Self {
        let labels = ["X", "Y", "Z"].map(String::from).into();
        Self { measured: Measured::Xyz, range, factor, labels, ..self }
    }

    /// What each answer belongs to.
    #[must_use]
    pub fn labels(self, labels: Vec<String>) -> Self {
        Self { labels, ..self }
    }

    /// Rounding or standard error of the known answers.
    #[must_use]
    pub fn uncertainty(self, uncertainty: f64) -> Self {
        Self { uncertainty, ..self }
    }

    /// The answer as a function of the image's mean.
    #[must_use]
    pub fn affine(self, offset: f64, factor: f64) -> Self {
        Self { offset, factor, ..self }
    }

    /// A limit of depth.
    #[must_use]
    pub fn depth(self, max_depth: u32) -> Self {
        Self { text: scene::limited(&self.text, max_depth), max_depth: Some(max_depth), ..self }
    }

    /// More samples.
    #[must_use]
    pub fn effort(self, effort: u32) -> Self {
        Self { effort, ..self }
    }

    /// Lit by what no path meets by chance.
    #[must_use]
    pub fn light_sampling_only(self) -> Self {
        Self { by_chance: false, ..self }
    }

    /// Grey but for albedos and reflectances.
    #[must_use]
    pub fn grey(self) -> Self {
        Self { grey: true, ..self }
    }

    /// Whether the optical depth of every medium has a closed form.
    pub fn homogeneous(&self) -> bool {
        !self.text.contains("\"uniformgrid\"")
    }

    /// The greatest contribution that is not rare.
    #[must_use]
    pub fn brightest(self, brightest: f64) -> Self {
        Self { brightest, ..self }
    }

    /// Why pbrt-v4 cannot read the scene, if it cannot.
    pub fn beyond_pbrt(&self) -> Option<&'static str> {
        let needs = [
            (
                "\"string phase\"",
                "phase functions other than Henyey-Greenstein with one g for all wavelengths",
            ),
            ("\"float lines\"", "spectral lines"),
            ("\"string equiangular\"", "switches of the integrator"),
            ("\"string edge\"", "grids that keep their value up to their faces"),
        ];
        needs.iter().find(|(word, _)| self.text.contains(word)).map(|(_, why)| *why)
    }
}
