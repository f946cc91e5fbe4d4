//! Synthetic passes whose samples are hashes of (seed, pixel, sample), with known means.
#![allow(dead_code, clippy::unwrap_used)] // each test file uses a part; a failure here is a failed test

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use tyndall_base::hash::mix64;
use tyndall_engine::{Cancel, EngineError, Job, Outcome, Progress, Run, Sink, Threads};
use tyndall_film::{ErrorMode, Film, FilmSpec, Guide, Pass, Patch, PixelBounds, WorkUnit};

/// The distribution of a pixel's samples, with mean 1 (or 0 where `Black`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// Uniform on [0, 2].
    Smooth,
    /// Exponential.
    Exponential,
    /// Lognormal with sigma = 1: skewness 6.2.
    Lognormal,
    /// 25 with probability 1/25, else 0.
    Rare,
    /// A mixture over the image of all of these, with dark and black pixels.
    Mixed,
}

pub struct Hashed {
    pub seed: u64,
    pub shape: Shape,
    pub calls: AtomicU64,
}

impl Hashed {
    pub fn new(seed: u64, shape: Shape) -> Self {
        Self { seed, shape, calls: AtomicU64::new(0) }
    }

    pub fn uniform(&self, x: u32, y: u32, sample: u32, dimension: u64) -> f64 {
        let h = mix64(self.seed ^ mix64(u64::from(x) << 32 | u64::from(y)) ^ mix64(dimension + 77));
        let h = mix64(h ^ mix64(u64::from(sample) + 0x9e37));
        ((h >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }

    /// Mean of Y at a pixel.
    pub fn mean(&self, x: u32, y: u32) -> f64 {
        if self.shape != Shape::Mixed {
            return 1.0;
        }
        match (x / 4 + y / 4) % 6 {
            0 => 0.0,
            1 => 0.004,
            k => f64::from(k),
        }
    }

    fn unit(&self, x: u32, y: u32, sample: u32) -> f64 {
        let u = self.uniform(x, y, sample, 0);
        let shape = match self.shape {
            Shape::Mixed => {
                [Shape::Smooth, Shape::Exponential, Shape::Lognormal][((x / 4 + 2 * (y / 4)) % 3) as usize]
            }
            shape => shape,
        };
        use tyndall_base::math::f64 as math;
        match shape {
            Shape::Smooth | Shape::Mixed => 2.0 * u,
            Shape::Exponential => -math::ln(u),
            Shape::Lognormal => {
                let r = (-2.0 * math::ln(u)).sqrt();
                let z = r * math::cos(std::f64::consts::TAU * self.uniform(x, y, sample, 1));
                math::exp(z - 0.5)
            }
            Shape::Rare => 25.0 * f64::from(u8::from(u < 0.04)),
        }
    }
}

impl Pass for Hashed {
    fn render(&self, unit: &WorkUnit, guide: &Guide, out: &mut Patch) {
        for (x, y) in unit.window.pixels() {
            let mean = self.mean(x, y);
            for sample in guide.samples_for(x, y, &unit.samples) {
                let v = self.unit(x, y, sample) * mean;
                let other = self.uniform(x, y, sample, 2);
                out.add_sample(x, y, sample, 1.0, &[(v * other) as f32, v as f32, (v + other) as f32]);
                self.calls.fetch_add(1, Ordering::Relaxed);
            }
        }
    }
}

pub fn spec(w: u32, h: u32, mode: ErrorMode) -> Arc<FilmSpec> {
    Arc::new(FilmSpec { seed: 5, ..FilmSpec::xyz([w, h], mode) })
}

/// A crop whose tiles are cut, in both directions.
pub fn cropped(mode: ErrorMode) -> Arc<FilmSpec> {
    let bounds = PixelBounds::new(3, 5, 40, 42);
    Arc::new(FilmSpec { bounds, seed: 5, ..FilmSpec::xyz([64, 48], mode) })
}

pub fn run(job: &Job, pass: &dyn Pass, threads: usize) -> Result<Outcome, EngineError> {
    let cancel = Cancel::default();
    let backend = Threads::new(threads);
    Run { job, pass, backend: &backend, cancel: &cancel, checkpoints: None }
        .start(&mut tyndall_engine::Silent)
}

pub fn film(job: &Job, pass: &dyn Pass, threads: usize) -> Film {
    run(job, pass, threads).unwrap().state.film
}

/// Remembers what it is told.
#[derive(Default)]
pub struct Notes {
    pub progress: Vec<Progress>,
    pub warnings: Vec<String>,
    pub rounds: u32,
    pub patches: u32,
}

impl Sink for Notes {
    fn progress(&mut self, p: &Progress) {
        self.progress.push(p.clone());
    }
    fn patch(&mut self, _patch: &Patch) {
        self.patches += 1;
    }
    fn round(&mut self, _film: &Film) {
        self.rounds += 1;
    }
    fn warning(&mut self, text: &str) {
        self.warnings.push(text.into());
    }
}

/// Asks to stop after a number of patches.
pub struct StopAfter {
    pub patches: u32,
    pub cancel: Cancel,
}

impl Sink for StopAfter {
    fn patch(&mut self, _patch: &Patch) {
        self.patches = self.patches.saturating_sub(1);
        if self.patches == 0 {
            self.cancel.cancel();
        }
    }
}
