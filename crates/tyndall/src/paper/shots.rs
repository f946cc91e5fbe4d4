//! Renders of the paper: what is rendered, how, and what is kept.

use super::{
    Effort, Paper, Samples,
    colour::BLOCK,
    scenes::{RANGE, RGB_EDGES, Scene, path},
};
use crate::{Error, Options, RunOptions, Source, Spectral, plan, render};
use std::{fs, path::PathBuf, time::Duration};
use tyndall_base::hash::mix64;
use tyndall_engine::{Checkpoints, End, Progress, Sink};
use tyndall_film::{Developed, ErrorMode};
use tyndall_spectral::{LambdaRange, strategy::Rule};

/// The paper's samples per pixel and wavelength.
const PAPER_SPP: u32 = 12_100;

/// One render.
#[derive(Clone, Debug)]
pub struct Shot {
    /// Name of its files.
    pub name: String,
    /// The scene.
    pub scene: Scene,
    /// `volpath` or `wang-chern`.
    pub integrator: &'static str,
    /// The strategy.
    pub spectral: Spectral,
    /// Whether lights are sampled, where that is not the integrator's default.
    pub light_sampling: Option<bool>,
    /// Samples per pixel.
    pub spp: u32,
    /// Pixels along a side.
    pub side: u32,
}

/// What a render left behind.
#[derive(Clone, Debug)]
pub struct Taken {
    /// The render.
    pub shot: Shot,
    /// R, G, B (linear sRGB) per pixel.
    pub rgb: Vec<[f64; 3]>,
    /// Their standard errors.
    pub error: Vec<[f64; 3]>,
    /// Standard errors of their means over the blocks of pixels that colours are compared in, row by row.
    pub block_error: Vec<[f64; 3]>,
    /// Seconds it took, earlier runs included.
    pub seconds: f64,
}

impl Shot {
    /// Fig. 4 and 6 by the paper's algorithm; the light is sampled unless all of the paper's paths are taken.
    pub fn paper(name: impl Into<String>, scene: Scene, effort: Effort, spectral: Spectral) -> Self {
        let size = spectral.set().map_or(80, |(n, _)| n);
        let (spp, light_sampling) = match effort {
            Effort::Quick => (80, Some(true)),
            Effort::Default => (400, Some(true)),
            Effort::Full => (PAPER_SPP * size, None),
        };
        let side = effort.side();
        Self { name: name.into(), scene, integrator: "wang-chern", spectral, light_sampling, spp, side }
    }

    /// By `volpath`, for pictures that are compared in colour.
    pub fn clean(
        name: impl Into<String>,
        scene: Scene,
        effort: Effort,
        spectral: Spectral,
        share: f64,
    ) -> Self {
        let spp = match effort {
            Effort::Quick => 32.0,
            Effort::Default => 192.0,
            Effort::Full => 8192.0,
        };
        let spp = ((spp * share) as u32).max(16);
        let side = effort.side();
        Self { name: name.into(), scene, integrator: "volpath", spectral, light_sampling: None, spp, side }
    }

    /// Paths that the render takes.
    pub fn paths(&self) -> f64 {
        f64::from(self.spp) * f64::from(self.side) * f64::from(self.side)
    }

    /// About what it costs, in paths of one wavelength by the paper's algorithm.
    pub(super) fn cost(&self) -> f64 {
        let medium = if matches!(self.scene, Scene::Clear | Scene::ClearFlat) { 0.35 } else { 1.0 };
        let per_path = match self.spectral {
            Spectral::Opow { .. } => 1.0,
            Spectral::Hero { wavelengths } => 1.9 + 0.06 * f64::from(wavelengths),
            Spectral::Swc { wavelengths } => 1.9 + 0.15 * f64::from(wavelengths),
            Spectral::Opaw { set } => 0.04 * f64::from(set.0),
        };
        self.paths() * medium * per_path
    }

    fn range(&self) -> LambdaRange {
        if self.scene == Scene::Rgb { LambdaRange { min: RGB_EDGES[0], max: RGB_EDGES[3] } } else { RANGE }
    }

    fn options(&self) -> Options {
        Options {
            spp: Some(self.spp),
            spectral: self.spectral,
            range: self.range(),
            integrator: Some(self.integrator.into()),
            light_sampling: self.light_sampling,
            resolution: Some([self.side; 2]),
            band_edges: (self.scene == Scene::Rgb).then(|| RGB_EDGES.to_vec()),
            seed: Some(self.seed()),
            errors: ErrorMode::REPLICATED,
            ..Options::default()
        }
    }

    /// Every render has its own, made from its name: renders that share random numbers share their noise, and a
    /// difference between them would tell less of it than their standard errors say.
    fn seed(&self) -> u64 {
        self.name.bytes().fold(1, |h, b| mix64(h ^ u64::from(b))) % 100_000
    }

    /// The command that repeats it.
    pub fn command(&self) -> String {
        let (range, side) = (self.range(), self.side);
        let mut text = format!("tyndall render scenes/{} -o {}.exr", self.scene.file(), self.name);
        text += &format!(" --integrator {} --spectral {}", self.integrator, self.spectral.name());
        match self.spectral {
            Spectral::Hero { wavelengths } | Spectral::Swc { wavelengths } => {
                text += &format!(" --wavelengths {wavelengths}");
            }
            _ => {}
        }
        if let Some((n, rule)) = self.spectral.set() {
            text += &format!(" --wavelengths {n} --wavelength-rule {}", format!("{rule:?}").to_lowercase());
        }
        if let Some(on) = self.light_sampling {
            text += if on { " --light-sampling on" } else { " --light-sampling off" };
        }
        if self.scene == Scene::Rgb {
            text += " --bands 380:764:128";
        }
        text + &format!(
            " --spp {} --resolution {side}x{side} --range {}:{} --errors replicated --seed {}",
            self.spp,
            range.min,
            range.max,
            self.seed()
        )
    }

    /// Renders, or goes on where an earlier run stopped, or takes what it finished.
    pub(super) fn take(self, paper: &mut Paper<'_>) -> Result<Taken, Error> {
        let plan = plan(Source::File(&path(&paper.scenes, self.scene)), &self.options())?;
        let checkpoints =
            Checkpoints::new(paper.work.join(format!("{}.ckpt", self.name)), Duration::from_secs(30));
        let resume = checkpoints.load(&plan.job).is_ok();
        if !resume {
            // of another effort or version
            checkpoints.remove();
        }
        let run = RunOptions {
            threads: paper.options.threads,
            cancel: paper.options.cancel.clone(),
            checkpoints: Some(checkpoints),
            resume,
        };
        let mut watch = Watch { paper, elapsed: 0.0, end: plan.job.spp };
        let outcome = render(&plan, &run, &mut watch)?;
        let elapsed = watch.elapsed;
        if outcome.end == End::Cancelled {
            return Err(Error::options("interrupted", Some("the same command goes on from here".into())));
        }
        if outcome.samples == 0 {
            watch.paper.meter.skip();
        }
        if let (Some(c), s) = (&run.checkpoints, &outcome.state) {
            c.save(&plan.job, &s.film, &s.guide, &s.position)?;
        }
        let seconds =
            self.time(paper, if outcome.samples > 0 { Some(elapsed.max(outcome.seconds)) } else { None });
        let developed = outcome.state.film.develop();
        Ok(Taken {
            rgb: self.colours(&developed, false),
            error: self.colours(&developed, true),
            block_error: self.block_errors(&developed),
            seconds,
            shot: self,
        })
    }

    /// Seconds are kept beside the state, so that a run that has nothing to do can still tell them.
    fn time(&self, paper: &Paper<'_>, measured: Option<f64>) -> f64 {
        let file: PathBuf = paper.work.join(format!("{}.seconds", self.name));
        match measured {
            Some(seconds) => {
                // a note for the page; without it the page says nothing of the time
                let _ = fs::write(&file, format!("{seconds}\n"));
                seconds
            }
            None => fs::read_to_string(&file).ok().and_then(|t| t.trim().parse().ok()).unwrap_or(f64::NAN),
        }
    }

    fn colours(&self, d: &Developed, errors: bool) -> Vec<[f64; 3]> {
        let planes = if errors { &d.error } else { &d.mean };
        (0..d.samples.len()).map(|p| self.order().map(|c| f64::from(planes[c][p]))).collect()
    }

    fn block_errors(&self, d: &Developed) -> Vec<[f64; 3]> {
        let error = |block, c| d.mean_over(c, block).1.variance.sqrt();
        d.bounds.tiles(BLOCK as u32).map(|block| self.order().map(|c| error(block, c))).collect()
    }

    /// The film's channels that make up R, G, B.
    fn order(&self) -> [usize; 3] {
        // three bands follow the film's own R, G, B; the shortest wavelengths carry blue
        if self.scene == Scene::Rgb { [5, 4, 3] } else { [0, 1, 2] }
    }
}

/// The shots of figure 6 by rendering, as in the paper.
pub fn figure_6(effort: Effort) -> Vec<Shot> {
    let mut all = Vec::new();
    for rule in [Rule::Midpoint, Rule::Endpoints] {
        for n in super::figure6::SIZES {
            let name = format!("fig6-{}-{n}", format!("{rule:?}").to_lowercase());
            let spectral = Spectral::Opow { set: Some((n, rule)) };
            let mut shot = Shot::paper(name, Scene::Fog, effort, spectral);
            if effort != Effort::Full {
                shot.side = 64;
            }
            all.push(shot);
        }
    }
    all
}

/// Passes the progress of a render on.
struct Watch<'w, 'p> {
    paper: &'w mut Paper<'p>,
    elapsed: f64,
    end: u32,
}

impl Sink for Watch<'_, '_> {
    fn progress(&mut self, progress: &Progress) {
        self.elapsed = progress.elapsed.as_secs_f64();
        let (spp, per_second) = (progress.spp, progress.samples_per_second);
        self.paper.tell(progress.fraction, Some(Samples { spp, end: self.end, per_second }));
    }
}
