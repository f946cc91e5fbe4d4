//! Cost of errors, merging and checkpoints: `cargo run --release -p tyndall-engine --example engine_cost`.

use std::sync::Arc;
use std::time::{Duration, Instant};

use tyndall_base::hash::mix64;
use tyndall_engine::{Cancel, Checkpoints, EngineError, Job, Run, Silent, State, Threads};
use tyndall_film::{ErrorMode, FilmSpec, Guide, Pass, Patch, WorkUnit};

/// Samples that cost nothing but a hash.
struct Hash;

impl Pass for Hash {
    fn render(&self, unit: &WorkUnit, guide: &Guide, out: &mut Patch) {
        for (x, y) in unit.window.pixels() {
            for sample in guide.samples_for(x, y, &unit.samples) {
                let h = mix64(u64::from(x) << 40 ^ u64::from(y) << 20 ^ u64::from(sample));
                let v = [0, 20, 40].map(|s| (h >> s & 0xf_ffff) as f32 * 1e-6);
                out.add_sample(x, y, sample, 1.0, &v);
            }
        }
    }
}

fn main() -> Result<(), EngineError> {
    for mode in [ErrorMode::Conservative, ErrorMode::REPLICATED] {
        let job = Job::new(Arc::new(FilmSpec::xyz([512, 512], mode)), 64);
        let backend = Threads::new(1);
        let cancel = Cancel::default();
        let run = Run { job: &job, pass: &Hash, backend: &backend, cancel: &cancel, checkpoints: None };
        let outcome = run.start(&mut Silent)?;
        let pixels = job.film.bounds.area() as f64;
        println!(
            "{:12} {:5.1} ns a sample in all (hash, film, merge, summaries of {} rounds)",
            mode.name(),
            outcome.seconds * 1e9 / outcome.samples as f64,
            tyndall_engine::schedule::rounds(0..64).count()
        );
        let path = std::env::temp_dir().join(format!("tyndall-cost-{}.ckpt", std::process::id()));
        let checkpoints = Checkpoints::new(&path, Duration::from_secs(60));
        let State { film, guide, position } = &outcome.state;
        let save = seconds(|| checkpoints.save(&job, film, guide, position))?;
        let bytes = std::fs::metadata(&path).map_or(0, |m| m.len()) as f64;
        let load = seconds(|| checkpoints.load(&job))?;
        let develop = seconds(|| Ok(film.develop()))?;
        checkpoints.remove();
        println!(
            "{:12} {} bytes a pixel in memory, {:.1} on disk; save {save:.3} s, load {load:.3} s, develop {develop:.3} s",
            "",
            job.film.bytes_per_pixel(),
            bytes / pixels
        );
    }
    Ok(())
}

fn seconds<T>(f: impl FnOnce() -> Result<T, EngineError>) -> Result<f64, EngineError> {
    let start = Instant::now();
    f()?;
    Ok(start.elapsed().as_secs_f64())
}
