//! Spectra that are constant in each band: one render answers as many questions as it has bands.

use tyndall_spectral::{LambdaRange, cie};

/// Whom a scene is written for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Dialect {
    /// With this project's own parameters: steps, absolute units.
    #[default]
    Own,
    /// As far as that goes in the plain format of pbrt-v4: cliffs one unit in the last place wide for steps, scales that
    /// undo the normalisation of lights.
    Pbrt,
}

/// Bands of the same width from 400 nm on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bands {
    /// How many.
    pub count: usize,
    /// How their spectra are written.
    pub dialect: Dialect,
}

impl Bands {
    /// \[nm\]; a power of two, so that the density of wavelengths is exact for powers of two of bands.
    pub const WIDTH: f32 = 16.0;

    /// `count` bands in this project's own format.
    pub const fn new(count: usize) -> Self {
        Self { count, dialect: Dialect::Own }
    }

    /// `count` bands written for `dialect`.
    pub const fn of(count: usize, dialect: Dialect) -> Self {
        Self { count, dialect }
    }

    /// Edges of the bands \[nm\].
    pub fn edges(&self) -> Vec<f32> {
        (0..=self.count).map(|i| 400.0 + Self::WIDTH * i as f32).collect()
    }

    /// From the first to the last edge.
    pub fn range(&self) -> LambdaRange {
        let e = self.edges();
        LambdaRange { min: e[0], max: e[self.count] }
    }

    /// The parameter that makes tables of a directive piecewise constant.
    pub fn interpolation(&self) -> &'static str {
        if self.dialect == Dialect::Own { " \"string interpolation\" \"step\"" } else { "" }
    }

    /// A parameter that is constant in each band; the directive needs [`Self::interpolation`] too.
    pub fn step(&self, name: &str, values: &[f64]) -> String {
        if self.dialect == Dialect::Pbrt {
            return self.cliff(name, values);
        }
        assert_eq!(values.len(), self.count, "{name}: one value a band");
        let pairs = self.edges().into_iter().zip(values.iter().chain(values.last()));
        let text: Vec<String> = pairs.map(|(e, v)| format!("{e} {v}")).collect();
        format!(" \"spectrum {name}\" [{}]", text.join(" "))
    }

    /// The same as linear pieces whose jumps are one unit in the last place wide: for parameters without steps.
    pub fn cliff(&self, name: &str, values: &[f64]) -> String {
        assert_eq!(values.len(), self.count, "{name}: one value a band");
        let edges = self.edges();
        // the last piece holds its end, so that the table covers the range of the film
        let end = |i: usize| if i + 1 == self.count { edges[i + 1] } else { edges[i + 1].next_down() };
        let piece = |(i, v): (usize, &f64)| format!("{} {v} {} {v}", edges[i], end(i));
        let text: Vec<String> = values.iter().enumerate().map(piece).collect();
        format!(" \"spectrum {name}\" [{}]", text.join(" "))
    }

    /// Emission that is constant in each band, in absolute units: spectrum and scale of a light or a medium.
    pub fn emission(&self, name: &str, scale: &str, values: &[f64]) -> String {
        let steps = self.step(name, values);
        match self.dialect {
            Dialect::Own => format!(" \"bool absolute\" true{}{steps}", self.interpolation()),
            Dialect::Pbrt => format!("{steps} \"float {scale}\" {}", self.photometric(values)),
        }
    }

    /// What the format of pbrt-v4 divides a spectrum by: its mean under the luminous efficiency function.
    fn photometric(&self, values: &[f64]) -> f64 {
        let y = |lambda: f32| f64::from(cie::matching_functions()[1].eval(lambda));
        let band = |e: f32| (0..Self::WIDTH as usize).map(|i| y(e + i as f32)).sum::<f64>();
        let sum: f64 = self.edges().iter().zip(values).map(|(&e, v)| v * band(e)).sum();
        sum / cie::CIE_Y_INTEGRAL as f64
    }
}
