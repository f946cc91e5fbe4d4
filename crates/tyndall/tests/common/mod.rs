//! Scenes as text, rendered without the engine into bands, and judged by their own standard errors.
#![allow(dead_code)]

pub mod judge;
pub mod scene;
pub mod table;

use std::path::Path;
use tyndall::{Options, Plan, Source, Spectral, WavelengthPdf, plan};
use tyndall_film::{Developed, ErrorMode, Film, Guide, Pass, Patch, WorkUnit};
use tyndall_geometry::Dispatch;
use tyndall_spectral::{LambdaRange, strategy::Rule};

/// Replicates of a pixel's samples, from whose spread the errors come.
pub const REPLICATES: u32 = 32;

/// Bands of the same width from 400 nm on.
#[derive(Clone, Copy, Debug)]
pub struct Bands {
    pub count: usize,
}

impl Bands {
    /// \[nm\]; a power of two, so that the density of wavelengths is exact for powers of two of bands.
    pub const WIDTH: f32 = 16.0;

    pub fn edges(&self) -> Vec<f32> {
        (0..=self.count).map(|i| 400.0 + Self::WIDTH * i as f32).collect()
    }

    fn range(&self) -> LambdaRange {
        let e = self.edges();
        LambdaRange { min: e[0], max: e[self.count] }
    }

    /// A parameter that is constant in each band; the directive needs [`scene::STEP`].
    pub fn step(&self, name: &str, values: &[f64]) -> String {
        assert_eq!(values.len(), self.count, "{name}: one value a band");
        let pairs = self.edges().into_iter().zip(values.iter().chain(values.last()));
        let text: Vec<String> = pairs.map(|(e, v)| format!("{e} {v}")).collect();
        format!(" \"spectrum {name}\" [{}]", text.join(" "))
    }
}

/// How a scene is rendered.
#[derive(Clone, Debug)]
pub struct Run {
    pub bands: Bands,
    pub integrator: &'static str,
    pub spectral: Spectral,
    pub pdf: WavelengthPdf,
    pub spp: u32,
    pub side: u32,
    pub max_depth: u32,
    pub seed: u64,
    pub errors: ErrorMode,
    pub dispatch: Dispatch,
}

impl Run {
    /// 4 x 4 pixels, volpath with 8 wavelengths, uniform density over the bands, unlimited depth.
    pub fn new(bands: Bands, spp: u32) -> Self {
        Self {
            bands,
            integrator: "volpath",
            spectral: Spectral::Hero { wavelengths: 8 },
            pdf: WavelengthPdf::Uniform,
            spp,
            side: 4,
            max_depth: u32::MAX,
            seed: 1,
            errors: ErrorMode::Replicated { replicates: REPLICATES },
            dispatch: Dispatch::Detect,
        }
    }

    pub fn hero(self, wavelengths: u32) -> Self {
        Self { spectral: Spectral::Hero { wavelengths }, ..self }
    }

    pub fn opow(self) -> Self {
        Self { spectral: Spectral::Opow { set: None }, ..self }
    }

    /// One wavelength in the middle of each band.
    pub fn fixed_set(self) -> Self {
        let set = Some((self.bands.count as u32, Rule::Midpoint));
        Self { spectral: Spectral::Opow { set }, ..self }
    }

    pub fn analog(self) -> Self {
        Self { integrator: "analog", ..self }
    }

    pub fn seed(self, seed: u64) -> Self {
        Self { seed, ..self }
    }

    pub fn plan(&self, text: &str) -> Plan {
        let options = Options {
            spp: Some(self.spp),
            spectral: self.spectral,
            wavelength_pdf: self.pdf,
            range: self.bands.range(),
            integrator: Some(self.integrator.into()),
            max_depth: Some(self.max_depth),
            resolution: Some([self.side; 2]),
            band_edges: Some(self.bands.edges()),
            seed: Some(self.seed),
            errors: self.errors,
            dispatch: self.dispatch,
            ..Options::default()
        };
        plan(Source::Text("test.pbrt", text, Path::new("")), &options)
            .unwrap_or_else(|e| panic!("{e}\n{text}"))
    }

    pub fn develop(&self, text: &str) -> Developed {
        develop(&self.plan(text))
    }

    /// Band means over the whole image.
    pub fn bands(&self, text: &str) -> Vec<judge::Estimate> {
        judge::pooled(&self.develop(text)).split_off(3)
    }
}

/// Renders the whole job as one unit.
pub fn develop(plan: &Plan) -> Developed {
    let spec = &plan.job.film;
    let unit = WorkUnit { window: spec.bounds, samples: 0..plan.job.spp, round: 0 };
    let mut patch = Patch::new(spec, unit.clone());
    plan.pass.render(&unit, &Guide::default(), &mut patch);
    let mut film = Film::new(spec).expect("a tiny film fits");
    film.merge(&patch).expect("the patch belongs to the film");
    assert_eq!(
        (film.diagnostics().non_finite, film.diagnostics().out_of_range),
        (0, 0),
        "samples were dropped"
    );
    film.develop()
}
