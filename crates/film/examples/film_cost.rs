//! Cost of a sample: `cargo run --release -p tyndall-film --example film_cost`.

use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use tyndall_film::{Channels, ErrorMode, Film, FilmSpec, Patch, PixelBounds, WorkUnit};
use tyndall_spectral::{Spectrum, Wavelengths};

const SPP: u32 = 64;

fn main() -> Result<(), tyndall_film::FilmError> {
    for mode in [ErrorMode::Conservative, ErrorMode::REPLICATED] {
        let xyz = Channels::xyz()?;
        let bands: Vec<f32> = (0..=40).map(|k| 380.0 + 10.0 * k as f32).collect();
        report(mode, "XYZ", &xyz)?;
        report(mode, "XYZ + 40 bands", &xyz.with_bands(&bands)?)?;
    }
    Ok(())
}

fn report(mode: ErrorMode, name: &str, channels: &Channels) -> Result<(), tyndall_film::FilmError> {
    let spec = Arc::new(FilmSpec::new([256, 256], channels.group(""), channels.luminance(), mode));
    let window = PixelBounds::new(0, 0, 16, 16);
    let mut patch = Patch::new(&spec, WorkUnit { window, samples: 0..SPP, round: 0 });
    let mut film = Film::new(&spec)?;
    let samples = sample_values(channels);
    let add = best(|| {
        for (x, y) in window.pixels() {
            for i in 0..SPP {
                let values = &samples[(i as usize * 7 + x as usize) % samples.len()];
                patch.add_sample(x, y, i, 1.0, black_box(values));
            }
        }
    });
    let merge = best(|| film.merge(&patch).expect("the patch is the film's"));
    let mut out = vec![0.0; channels.len()];
    let lambda: Vec<Wavelengths<8>> = (0..251).map(wavelengths).collect();
    let respond = best(|| {
        for i in 0..256 * SPP {
            let w = &lambda[i as usize % lambda.len()];
            channels.respond(black_box(&Spectrum::splat(0.7)), black_box(w), &mut out);
            black_box(&out);
        }
    });
    let per_sample = 1e9 / f64::from(256 * SPP);
    println!(
        "{:12} {name:15} add {:5.1} ns  respond (N = 8) {:5.1} ns  merge {:6.1} ns/pixel  {} bytes/pixel",
        mode.name(),
        add * per_sample,
        respond * per_sample,
        merge * 1e9 / 256.0,
        spec.bytes_per_pixel()
    );
    Ok(())
}

fn wavelengths(i: u32) -> Wavelengths<8> {
    let u = (i as f32 * 0.618_034).fract();
    let lambda = std::array::from_fn(|k| 360.0 + 470.0 * (u + k as f32 / 8.0).fract());
    Wavelengths { lambda, pdf: [1.0 / 470.0; 8], line: [u16::MAX; 8] }
}

fn sample_values(channels: &Channels) -> Vec<Vec<f32>> {
    let sample = |i: u32| {
        let mut out = vec![0.0; channels.len()];
        let w = wavelengths(i);
        channels.respond(
            &Spectrum::from_fn(|k| 0.01 * (1 + (i * 7 + k as u32 * 3) % 11) as f32),
            &w,
            &mut out,
        );
        out
    };
    (0..251).map(sample).collect()
}

/// Seconds of the fastest of many runs.
fn best(mut f: impl FnMut()) -> f64 {
    let run = |f: &mut dyn FnMut()| {
        let start = Instant::now();
        f();
        start.elapsed().as_secs_f64()
    };
    (0..60).map(|_| run(&mut f)).fold(f64::INFINITY, f64::min)
}
