//! Scenes as text, rendered without the engine into bands, and judged by their own standard errors.
#![allow(dead_code, unused_imports)] // every test program uses a part

pub mod judge;

pub use tyndall::validate::{Bands, Dialect, scene, table};

use std::path::Path;
use tyndall::validate::measure::REPLICATES;
use tyndall::{Options, Plan, Source, Spectral, WavelengthPdf, plan};
use tyndall_film::{Developed, ErrorMode, Film, Guide, Pass, Patch, WorkUnit};
use tyndall_geometry::Dispatch;
use tyndall_spectral::strategy::Rule;

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
    pub light_sampling: Option<bool>,
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
            light_sampling: None,
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
            light_sampling: self.light_sampling,
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
