//! Renders a case in one way: means with their covariances.

use super::{
    case::{Case, Measured},
    way::Way,
};
use crate::{Error, Options, Source, WavelengthPdf, plan};
use std::path::Path;
use tyndall_film::{ErrorMode, Film, Guide, Pass, Patch, Pooled, WorkUnit};
use tyndall_spectral::ColourSpace;

/// Replicates of a pixel's samples, from whose spread the errors come.
pub const REPLICATES: u32 = 32;
/// Pixels along a side of every image.
const SIDE: u32 = 4;

/// The answers of one render with their covariances, and whether every sample counted.
#[derive(Clone, Debug)]
pub struct Answers {
    /// Means and covariances, in the unit of the known answers.
    pub pooled: Pooled,
    /// Samples that were dropped.
    pub dropped: u64,
    /// Samples of the whole image.
    pub samples: u64,
}

/// Renders the whole image as one unit of work.
///
/// # Errors
/// When the scene cannot be planned: a fault of this program.
pub fn render(case: &Case, way: &Way, spp: u32, seed: u64) -> Result<Answers, Error> {
    let plan = plan(Source::Text(&case.name, &case.text, Path::new("")), &options(case, way, spp, seed))?;
    let spec = &plan.job.film;
    let unit = WorkUnit { window: spec.bounds, samples: 0..plan.job.spp, round: 0 };
    let mut patch = Patch::new(spec, unit.clone());
    plan.pass.render(&unit, &Guide::default(), &mut patch);
    let mut film = Film::new(spec)?;
    film.merge(&patch)?;
    let d = film.diagnostics();
    let (dropped, samples) = (d.non_finite + d.out_of_range, film.samples());
    let all = film.pooled();
    let pooled = match case.measured {
        Measured::Bands => {
            linear(&all, case.bands.count, |band, c| if c == band + 3 { case.factor } else { 0.0 })
        }
        Measured::Xyz => {
            let m = ColourSpace::get(plan.loaded.film.space).xyz_from_rgb.0;
            linear(&all, 3, |row, c| if c < 3 { m[row][c] * case.factor } else { 0.0 })
        }
    };
    Ok(Answers { pooled: shifted(pooled, case.offset), dropped, samples })
}

fn options(case: &Case, way: &Way, spp: u32, seed: u64) -> Options {
    let bands = case.measured == Measured::Bands;
    Options {
        spp: Some(spp),
        spectral: way.spectral(case.bands.count),
        wavelength_pdf: if bands { way.pdf } else { WavelengthPdf::Light },
        range: case.range,
        integrator: Some(way.integrator.into()),
        max_depth: Some(case.max_depth.unwrap_or(u32::MAX)),
        resolution: Some([SIDE; 2]),
        band_edges: Some(if bands { case.bands.edges() } else { Vec::new() }),
        seed: Some(seed),
        errors: ErrorMode::Replicated { replicates: REPLICATES },
        ..Options::default()
    }
}

/// Linear functions `sum_c weight(row, c) x_c` of the channels, with their covariances.
fn linear(all: &Pooled, rows: usize, weight: impl Fn(usize, usize) -> f64) -> Pooled {
    let n = all.mean.len();
    let mean = (0..rows).map(|r| (0..n).map(|c| weight(r, c) * all.mean[c]).sum()).collect();
    let mut covariance = Vec::with_capacity(rows * rows);
    for a in 0..rows {
        for b in 0..rows {
            let cell = |c: usize, d: usize| {
                let w = weight(a, c) * weight(b, d);
                if w == 0.0 { 0.0 } else { w * all.covariance(c, d) }
            };
            covariance.push((0..n).flat_map(|c| (0..n).map(move |d| (c, d))).map(|(c, d)| cell(c, d)).sum());
        }
    }
    Pooled { mean, covariance, dof: all.dof }
}

fn shifted(mut pooled: Pooled, offset: f64) -> Pooled {
    pooled.mean.iter_mut().for_each(|m| *m += offset);
    pooled
}
