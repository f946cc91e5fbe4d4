//! Spectra of every pixel, 1 nm apart, all from the same paths: the ground of figure 6.
//!
//! With a lamp of radiance 1 a pixel's spectrum is the transfer from lamp to pixel; times any lamp's spectrum it is the
//! radiance in that light. Sums over N wavelengths of it differ by their quadrature alone, since all wavelengths share
//! their paths. Two halves of the samples are kept apart, so that the noise that remains is measured.

use super::{
    Effort, Paper,
    scenes::{RANGE, Scene, path},
};
use crate::{Error, Options, Plan, Source, Spectral, plan};
use std::{fs, sync::mpsc, thread};
use tyndall_files::FileError;
use tyndall_integrators::{Equiangular, Guiding};
use tyndall_spectral::strategy::Rule;

/// Scatterings of a path, without roulette.
const DEPTH: u32 = 16;
/// Wavelengths: 380, 381 ... 780 nm.
pub const NODES: usize = 401;
/// What a path of all wavelengths costs against one of one wavelength, as timed.
const COST: f64 = 250.0;
/// Independent parts of the samples.
pub const HALVES: usize = 2;

/// Transfer spectra of an image.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// Per half, pixel and node.
    data: Vec<f32>,
    pixels: usize,
}

impl Sweep {
    /// Pixels of the image.
    pub fn pixels(&self) -> usize {
        self.pixels
    }

    /// The spectrum of a pixel from one half of the samples.
    pub fn spectrum(&self, half: usize, pixel: usize) -> &[f32] {
        let start = (half * self.pixels + pixel) * NODES;
        &self.data[start..start + NODES]
    }
}

/// Transfer at `lambda` \[nm\] within a spectrum: straight lines between its whole nanometres.
pub fn at(spectrum: &[f32], lambda: f64) -> f64 {
    let x = (lambda - f64::from(RANGE.min)).clamp(0.0, (NODES - 1) as f64);
    let i = (x as usize).min(NODES - 2);
    let t = x - i as f64;
    f64::from(spectrum[i]) * (1.0 - t) + f64::from(spectrum[i + 1]) * t
}

/// Side of the image and samples per half.
fn size(effort: Effort) -> (u32, u32) {
    match effort {
        Effort::Quick => (32, 2),
        Effort::Default => (64, 6),
        Effort::Full => (128, 32),
    }
}

/// Cost of a sweep, in paths of one wavelength.
pub(super) fn cost(effort: Effort) -> f64 {
    let (side, samples) = size(effort);
    COST * HALVES as f64 * f64::from(side * side * samples)
}

fn sweep_plan(paper: &Paper<'_>, scene: Scene, side: u32) -> Result<Plan, Error> {
    let options = Options {
        spectral: Spectral::Opow { set: Some((8, Rule::Midpoint)) },
        range: RANGE,
        max_depth: Some(DEPTH),
        resolution: Some([side; 2]),
        ..Options::default()
    };
    let mut plan = plan(Source::File(&path(&paper.scenes, scene)), &options)?;
    let s = &mut plan.pass.settings;
    (s.roulette_depth, s.equiangular) = (u32::MAX, Equiangular::Off);
    (s.glow, s.guiding) = (false, Guiding::Off);
    Ok(plan)
}

/// Renders the sweep of a scene, or takes the one of an earlier run.
pub(super) fn take(paper: &mut Paper<'_>, scene: Scene) -> Result<Sweep, Error> {
    let (side, samples) = size(paper.options.effort);
    let pixels = (side * side) as usize;
    let file =
        paper.work.join(format!("sweep-{}-{side}-{samples}.f32", scene.file().trim_end_matches(".pbrt")));
    let expected = HALVES * pixels * NODES;
    if let Some(data) = fs::read(&file).ok().filter(|b| b.len() == 4 * expected) {
        paper.meter.skip();
        let number = |b: &[u8]| f32::from_le_bytes([b[0], b[1], b[2], b[3]]);
        return Ok(Sweep { data: data.chunks_exact(4).map(number).collect(), pixels });
    }
    let plan = sweep_plan(paper, scene, side)?;
    let mut sweep = Sweep { data: vec![0.0; expected], pixels };
    render(paper, &plan, side, samples, &mut sweep)?;
    let bytes: Vec<u8> = sweep.data.iter().flat_map(|v| v.to_le_bytes()).collect();
    fs::write(&file, bytes).map_err(|e| FileError::io(&file, "write", e))?;
    Ok(sweep)
}

/// Rows of pixels on all threads.
fn render(
    paper: &mut Paper<'_>,
    plan: &Plan,
    side: u32,
    samples: u32,
    sweep: &mut Sweep,
) -> Result<(), Error> {
    let threads = paper
        .options
        .threads
        .unwrap_or_else(|| thread::available_parallelism().map_or(1, usize::from))
        .max(1) as u32;
    let cancel = paper.options.cancel.clone();
    let (send, receive) = mpsc::channel();
    let mut rows = 0;
    thread::scope(|scope| {
        for first in 0..threads {
            let (send, cancel) = (send.clone(), cancel.clone());
            scope.spawn(move || {
                for y in (first..side).step_by(threads as usize) {
                    if cancel.is_cancelled() || send.send((y, row(plan, y, side, samples))).is_err() {
                        return;
                    }
                }
            });
        }
        drop(send);
        for (y, row) in receive {
            let width = side as usize * NODES;
            for (half, part) in row.chunks_exact(width).enumerate() {
                let at = half * sweep.pixels * NODES + y as usize * width;
                sweep.data[at..at + width].copy_from_slice(part);
            }
            rows += 1;
            paper.tell(f64::from(rows) / f64::from(side), None);
        }
    });
    if rows < side {
        return Err(Error::options("interrupted", Some("the same command goes on from here".into())));
    }
    Ok(())
}

/// One row: both halves, one after the other.
fn row(plan: &Plan, y: u32, side: u32, samples: u32) -> Vec<f32> {
    let nodes: Vec<f32> = (0..NODES).map(|i| RANGE.min + i as f32).collect();
    let width = side as usize * NODES;
    let mut out = vec![0.0; HALVES * width];
    let mut one = vec![0.0; NODES];
    for x in 0..side {
        for sample in 0..samples * HALVES as u32 {
            plan.pass.spectrum(x, y, sample, &nodes, &mut one);
            let start = sample as usize % HALVES * width + x as usize * NODES;
            let sums = &mut out[start..start + NODES];
            sums.iter_mut().zip(&one).for_each(|(s, v)| *s += v / samples as f32);
        }
    }
    out
}
