//! `tyndall paper`: figures 4, 5 and 6 of Wang and Chern (2001), rendered and measured, on one page.
//!
//! Renders go on from their checkpoints and are not repeated when they are finished, so that a run that was interrupted, or
//! whose page alone is wanted again, is short.

mod bases;
mod colour;
mod figure6;
mod page;
mod progress;
mod scenes;
mod shots;
mod sweep;
mod tables;

use crate::{Error, Spectral};
use progress::Meter;
use std::{fs, path::PathBuf};
use tyndall_engine::Cancel;
use tyndall_files::FileError;
use tyndall_spectral::{Curve, illuminant, strategy::Rule};

pub use progress::{Samples, Step};
pub use scenes::{RANGE, Scene, write as write_scenes};
pub use shots::{Shot, Taken};

/// How much is computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Effort {
    /// About a minute.
    Quick,
    /// About ten minutes on two cores.
    #[default]
    Default,
    /// The paper's 12100 samples per pixel and wavelength, by its algorithm: hours.
    Full,
}

impl Effort {
    /// Pixels along a side of the pictures.
    pub(crate) const fn side(self) -> u32 {
        match self {
            Self::Quick => 64,
            _ => 128,
        }
    }

    /// The name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Quick => "--quick",
            Self::Default => "",
            Self::Full => "--full",
        }
    }
}

/// What is asked for.
#[derive(Clone, Debug)]
pub struct PaperOptions {
    /// Where everything goes.
    pub folder: PathBuf,
    /// How much is computed.
    pub effort: Effort,
    /// Threads; what the machine allows if `None`.
    pub threads: Option<usize>,
    /// Asks to stop.
    pub cancel: Cancel,
}

/// A run of the command.
pub(crate) struct Paper<'p> {
    options: &'p PaperOptions,
    scenes: PathBuf,
    work: PathBuf,
    meter: Meter,
    watch: &'p mut dyn FnMut(&Step),
}

impl Paper<'_> {
    fn begin(&mut self, name: impl Into<String>, cost: f64) {
        (self.watch)(self.meter.begin(name.into(), cost));
    }

    fn tell(&mut self, fraction: f64, samples: Option<Samples>) {
        (self.watch)(self.meter.at(fraction, samples));
    }

    fn take(&mut self, shot: Shot) -> Result<Taken, Error> {
        self.begin(shot.name.clone(), shot.cost());
        shot.take(self)
    }
}

/// All that the page shows.
pub(crate) struct Results {
    /// Figure 4 and what stands beside it.
    pub pictures: Vec<Taken>,
    /// Two independent references, for colour differences.
    pub references: [Taken; 2],
    /// The paper's figure 6 by rendering.
    pub rendered: Vec<Taken>,
    /// Hero at several numbers of wavelengths.
    pub heroes: Vec<Taken>,
    /// Systematic errors.
    pub points: Vec<figure6::Point>,
    /// Bases against point samples.
    pub bases: Vec<bases::Row>,
}

/// Computes everything and writes `index.html` and the tables; returns the page's path.
///
/// # Errors
/// When a folder cannot be written, a render fails, or it was interrupted: the same call then goes on.
pub fn run(options: &PaperOptions, watch: &mut dyn FnMut(&Step)) -> Result<PathBuf, Error> {
    let (scenes, work) = (options.folder.join("scenes"), options.folder.join(work_folder(options.effort)));
    fs::create_dir_all(&work).map_err(|e| FileError::io(&work, "create", e))?;
    scenes::write(&scenes)?;
    let mut paper = Paper { options, scenes, work, meter: Meter::new(0, 1.0), watch };
    let results = compute(&mut paper)?;
    tables::write(&options.folder, &results)?;
    let page = options.folder.join("index.html");
    fs::write(&page, page::page(options, &results)?).map_err(|e| FileError::io(&page, "write", e))?;
    Ok(page)
}

fn work_folder(effort: Effort) -> &'static str {
    match effort {
        Effort::Quick => "work-quick",
        Effort::Default => "work",
        Effort::Full => "work-full",
    }
}

fn compute(paper: &mut Paper<'_>) -> Result<Results, Error> {
    let effort = paper.options.effort;
    let (pictures, references) = (pictures(effort), references(effort));
    let (rendered, heroes) = (shots::figure_6(effort), heroes(effort));
    let shots = || pictures.iter().chain(&references).chain(&rendered).chain(&heroes);
    let (sweeps, study) = (2.0 * sweep::cost(effort), bases::cost(paths(effort)));
    // two sweeps and the study of bases come on top
    paper.meter = Meter::new(shots().count() + 3, shots().map(Shot::cost).sum::<f64>() + sweeps + study);
    let mut all = |shots: Vec<Shot>| shots.into_iter().map(|s| paper.take(s)).collect::<Result<Vec<_>, _>>();
    let pictures = all(pictures)?;
    let mut references = all(references.into())?.into_iter();
    let references = [(); 2].map(|()| references.next().expect("as many renders as shots"));
    let (rendered, heroes) = (all(rendered)?, all(heroes)?);
    let mut points = Vec::new();
    for (scene, fog) in [(Scene::ClearFlat, false), (Scene::FogFlat, true)] {
        paper.begin(
            if fog { "spectra of the pixels, fog" } else { "spectra of the pixels, clear" },
            sweep::cost(effort),
        );
        let sweep = sweep::take(paper, scene)?;
        for (name, lamp) in &lamps()? {
            points.extend(figure6::points(&sweep, (name, lamp), fog)?);
        }
    }
    let paths = paths(effort);
    paper.begin("bases over recorded paths", bases::cost(paths));
    let bases = bases::study(paper, &lamps()?, paths)?;
    Ok(Results { pictures, references, rendered, heroes, points, bases })
}

/// Paths that the study of bases records.
const fn paths(effort: Effort) -> usize {
    if let Effort::Quick = effort { 100 } else { 600 }
}

/// Daylight and a lamp of three narrow bands.
fn lamps() -> Result<Vec<(&'static str, Curve)>, Error> {
    let lamp = |name| illuminant::illuminant(name, tyndall_spectral::Outside::Hold);
    Ok(vec![("D65", lamp("D65")?), ("F11", lamp("F11")?)])
}

/// Figure 4, and beside it what RGB rendering and the other strategies make of the fog.
fn pictures(effort: Effort) -> Vec<Shot> {
    let set = |n| Spectral::Opow { set: Some((n, Rule::Midpoint)) };
    let opaw = Spectral::Opaw { set: (80, Rule::Midpoint) };
    let hero = Spectral::Hero { wavelengths: 8 };
    vec![
        Shot::paper("figure-4a-clear", Scene::Clear, effort, set(80)),
        Shot::paper("figure-4b-5-wavelengths", Scene::Fog, effort, set(5)),
        Shot::paper("figure-4c-80-wavelengths", Scene::Fog, effort, set(80)),
        Shot::paper("opow-continuum", Scene::Fog, effort, Spectral::Opow { set: None }),
        Shot { light_sampling: None, ..Shot::paper("opow-by-chance", Scene::Fog, effort, set(80)) },
        Shot::clean("opaw", Scene::Fog, effort, opaw, 0.5),
        Shot::clean("rgb", Scene::Rgb, effort, hero, 1.0),
        Shot::clean("meyer", Scene::Fog, effort, Spectral::Opow { set: Some((4, Rule::Meyer)) }, 2.0),
        Shot::clean("swc", Scene::Fog, effort, Spectral::Swc { wavelengths: 8 }, 1.0),
    ]
}

/// The truth for colour differences, twice: what they differ by is noise.
fn references(effort: Effort) -> [Shot; 2] {
    let hero = |name, wavelengths| Shot::clean(name, Scene::Fog, effort, Spectral::Hero { wavelengths }, 1.0);
    [hero("hero", 8), hero("hero-16", 16)]
}

/// Hero with 1, 4, 8 and 16 wavelengths at the same number of paths.
fn heroes(effort: Effort) -> Vec<Shot> {
    let one = |wavelengths| Shot {
        side: 64,
        spp: if effort == Effort::Quick { 32 } else { 128 },
        ..Shot::clean(
            format!("hero-curve-{wavelengths}"),
            Scene::Fog,
            effort,
            Spectral::Hero { wavelengths },
            1.0,
        )
    };
    [1, 4, 8, 16].map(one).into()
}
