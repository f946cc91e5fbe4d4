//! Renders with many seeds, and what the spread and the clock say.

use crate::{mask::Mask, scenes::BenchScene, variants::Variant};
use cpu_time::ThreadTime;
use tyndall::{
    Options, Plan, Source,
    film::{Film, Guide, Pass, Patch, WorkUnit},
    plan,
};

/// One cell of a table.
pub struct Task<'a> {
    pub scene: &'a BenchScene,
    pub variant: &'a Variant,
    pub resolution: u32,
    pub spp: u32,
}

/// Pictures of luminance, one per seed, with their times.
pub struct Measurement {
    /// Luminances, row by row.
    pub pictures: Vec<Vec<f64>>,
    /// CPU seconds of each.
    pub seconds: Vec<f64>,
    /// Samples of a picture.
    pub samples: f64,
}

/// What a renderer achieves.
#[derive(Clone, Copy, Debug)]
pub struct Efficiency {
    /// 1 / (MSE_Y x CPU seconds) without the pixels of the mask.
    pub headline: f64,
    /// Its standard error over seeds.
    pub headline_se: f64,
    /// The same of all pixels.
    pub whole: f64,
    /// Mean squared error of Y without the pixels of the mask.
    pub mse: f64,
    /// CPU seconds of a picture.
    pub seconds: f64,
    pub samples_per_second: f64,
    /// Mean of Y over all pixels and seeds.
    pub mean_y: f64,
}

/// Measures all tasks; each seed goes through all of them before the next.
pub fn all(tasks: &[Task<'_>], seeds: u32) -> Result<Vec<Measurement>, String> {
    let plans = tasks.iter().map(planned).collect::<Result<Vec<_>, _>>()?;
    let empty = |p: &Plan| Measurement {
        pictures: Vec::new(),
        seconds: Vec::new(),
        samples: p.job.film.bounds.area() as f64 * f64::from(p.job.spp),
    };
    let mut out: Vec<Measurement> = plans.iter().map(empty).collect();
    for seed in 0..seeds {
        for (plan, m) in plans.iter().zip(&mut out) {
            let (picture, seconds) = picture(plan, u64::from(seed))?;
            m.pictures.push(picture);
            m.seconds.push(seconds);
        }
    }
    Ok(out)
}

fn planned(task: &Task<'_>) -> Result<Plan, String> {
    let resolution = Some([task.resolution; 2]);
    let mut options = Options { spp: Some(task.spp), resolution, ..Options::default() };
    (task.variant.options)(&mut options);
    let mut plan = plan(Source::File(&task.scene.path()), &options).map_err(|e| e.to_string())?;
    (task.variant.settings)(&mut plan.pass.settings);
    Ok(plan)
}

/// Luminances and CPU seconds of the rendering alone.
pub fn picture(plan: &Plan, seed: u64) -> Result<(Vec<f64>, f64), String> {
    let mut pass = plan.pass.clone();
    pass.seed = seed;
    let spec = &plan.job.film;
    let unit = WorkUnit { window: spec.bounds, samples: 0..plan.job.spp, round: 0 };
    let start = ThreadTime::now();
    // what the plan has learned already, once more: it belongs to the cost of a picture
    std::hint::black_box(pass.learned(spec.resolution));
    let mut patch = Patch::new(spec, unit.clone());
    pass.render(&unit, &Guide::default(), &mut patch);
    let seconds = start.elapsed().as_secs_f64();
    let mut film = Film::new(spec).map_err(|e| e.to_string())?;
    film.merge(&patch).map_err(|e| e.to_string())?;
    if film.diagnostics().non_finite > 0 {
        return Err(format!("{} samples are not finite", film.diagnostics().non_finite));
    }
    Ok((film.develop().y.iter().map(|&y| f64::from(y)).collect(), seconds))
}

impl Measurement {
    /// The efficiency with its error from leaving out one seed at a time (jackknife).
    pub fn efficiency(&self, mask: &Mask) -> Efficiency {
        let n = self.pictures.len() as f64;
        let seconds = self.seconds.iter().sum::<f64>() / n;
        let mse = self.mse(None, Some(mask));
        let headline = |left_out| {
            let s: f64 =
                self.seconds.iter().enumerate().filter(|(i, _)| Some(*i) != left_out).map(|(_, s)| s).sum();
            let s = s / (n - f64::from(u8::from(left_out.is_some())));
            1.0 / (self.mse(left_out, Some(mask)) * s)
        };
        let without: Vec<f64> = (0..self.pictures.len()).map(|i| headline(Some(i))).collect();
        let mean = without.iter().sum::<f64>() / n;
        let spread: f64 = without.iter().map(|e| (e - mean).powi(2)).sum();
        let all: f64 = self.pictures.iter().flatten().sum();
        Efficiency {
            headline: headline(None),
            headline_se: (spread * (n - 1.0) / n).sqrt(),
            whole: 1.0 / (self.mse(None, None) * seconds),
            mse,
            seconds,
            samples_per_second: self.samples / seconds,
            mean_y: all / (n * self.pictures[0].len() as f64),
        }
    }

    /// Mean over pixels of the variance over seeds.
    fn mse(&self, left_out: Option<usize>, mask: Option<&Mask>) -> f64 {
        let kept = || self.pictures.iter().enumerate().filter(|(i, _)| Some(*i) != left_out).map(|(_, p)| p);
        let n = kept().count() as f64;
        let (mut sum, mut pixels) = (0.0, 0.0);
        for i in (0..self.pictures[0].len()).filter(|&i| mask.is_none_or(|m| !m.hides(i))) {
            let mean = kept().map(|p| p[i]).sum::<f64>() / n;
            sum += kept().map(|p| (p[i] - mean).powi(2)).sum::<f64>() / (n - 1.0);
            pixels += 1.0;
        }
        sum / pixels
    }
}
