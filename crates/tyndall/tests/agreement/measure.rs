//! Renders a variant and reduces it to a few means with errors.

use crate::{scenes::SmallScene, variants::Variant};
use std::{path::Path, sync::Arc};
use tyndall::{Options, Source, integrators::pixel::PixelPass, plan};
use tyndall_engine::Job;
use tyndall_film::{Developed, ErrorMode, Film, Guide, Pass, Patch, PixelBounds, WorkUnit};
use tyndall_testkit::{ALPHA, distribution::student_two_sided, sidak};

/// Five bands of 94 nm, each of 16 wavelengths of a fixed set of 80.
const BANDS: [f32; 6] = [360.0, 454.0, 548.0, 642.0, 736.0, 830.0];

/// The names of the first and the last.
const OUTER: [&str; 2] = ["360-", "736-"];

/// Side of the largest squares of pixels that share paths: the parts are the same for all who are compared.
const SQUARE: u32 = 8;

/// A mean over pixels.
#[derive(Clone, Copy, Debug)]
pub struct Mean {
    pub value: f64,
    pub variance: f64,
    pub dof: f64,
}

/// The means of R, G, B and the bands, over the whole picture and over four parts of it, each of whole squares of pixels that
/// share paths.
pub type Means = Vec<(String, Mean)>;

/// The scene rendered in this way.
pub fn render(scene: &SmallScene, variant: &Variant, effort: u32, seed: u64) -> Means {
    let mut options = Options {
        spp: Some(scene.spp * effort),
        max_depth: Some(scene.max_depth),
        band_edges: Some(BANDS.to_vec()),
        errors: ErrorMode::REPLICATED,
        seed: Some(seed),
        ..Options::default()
    };
    (variant.options)(&mut options);
    let mut plan = plan(Source::Text(scene.name, scene.text, Path::new("")), &options)
        .unwrap_or_else(|e| panic!("{}: {}: {e}", scene.name, variant.name));
    (variant.settings)(&mut plan.pass.settings);
    let pass = plan.pass.learning(plan.job.film.resolution);
    Arc::make_mut(&mut plan.job.film).square = pass.shared_side();
    let film = film(&pass, &plan.job);
    assert!(film.diagnostics().is_clean(), "{}: {}: {:?}", scene.name, variant.name, film.diagnostics());
    regions(&film.develop())
}

fn film(pass: &PixelPass, job: &Job) -> Film {
    let unit = WorkUnit { window: job.film.bounds, samples: 0..job.spp, round: 0 };
    let mut patch = Patch::new(&job.film, unit.clone());
    pass.render(&unit, &Guide::default(), &mut patch);
    let mut film = Film::new(&job.film).expect("a film of a small scene");
    film.merge(&patch).expect("the patch belongs to the film");
    film
}

fn regions(film: &Developed) -> Means {
    let all = film.bounds;
    let half = |length: u32| (length / 2).next_multiple_of(SQUARE);
    let middle = [all.x0 + half(all.width()), all.y0 + half(all.height())];
    let (left, right) = (PixelBounds { x1: middle[0], ..all }, PixelBounds { x0: middle[0], ..all });
    let (upper, lower) = (PixelBounds { y1: middle[1], ..all }, PixelBounds { y0: middle[1], ..all });
    let inside = [
        ("", all),
        (" upper left", upper.intersection(&left)),
        (" upper right", upper.intersection(&right)),
        (" lower left", lower.intersection(&left)),
        (" lower right", lower.intersection(&right)),
    ];
    let mut out = Means::new();
    for (c, name) in film.names.iter().enumerate() {
        for (region, area) in inside {
            let (value, error) = film.mean_over(c, area);
            let mean = Mean { value, variance: error.variance, dof: error.dof() };
            out.push((format!("{name}{region}"), mean));
        }
    }
    out
}

impl Mean {
    /// Student's t of the difference, and its p-value (Welch).
    pub fn against(&self, other: &Self) -> (f64, f64) {
        let variance = self.variance + other.variance;
        let t = (self.value - other.value) / variance.sqrt();
        let part = |m: &Self| if m.variance > 0.0 { m.variance * m.variance / m.dof } else { 0.0 };
        (t, student_two_sided(t, (variance * variance / (part(self) + part(other))).min(1e6)))
    }
}

/// Renders the scene in all `variants` and compares each with `reference`; `times` multiplies all samples.
pub fn agree(scene: &SmallScene, reference: &Variant, variants: &[Variant], times: u32) {
    let truth = render(scene, reference, times * reference.effort, 1);
    let level = sidak(ALPHA, variants.len() * truth.len());
    let mut wrong = Vec::new();
    for (i, variant) in variants.iter().enumerate() {
        let means = render(scene, variant, times * variant.effort, 100 + i as u64);
        let (mut worst, mut squares) = (("", 0.0f64, 1.0f64), 0.0);
        let counts =
            |name: &str| !(variant.blind_to_outer_bands && OUTER.iter().any(|b| name.starts_with(b)));
        for ((name, a), (_, b)) in means.iter().zip(&truth).filter(|((name, _), _)| counts(name)) {
            let (t, p) = a.against(b);
            squares += t * t;
            if t.abs() > worst.1.abs() || t.is_nan() {
                worst = (name, t, p);
            }
            if p.is_nan() || p <= level {
                wrong.push(format!(
                    "{}: {}: {name}: {:.6} against {:.6}: t = {t:.2}",
                    scene.name, variant.name, a.value, b.value
                ));
            }
        }
        let se = (means[5].1.variance + truth[5].1.variance).sqrt() / truth[5].1.value;
        println!(
            "{:<58} worst t {:6.2} ({}), mean t^2 {:.2}, resolves {:.2} % of green",
            variant.name,
            worst.1,
            worst.0,
            squares / means.len() as f64,
            100.0 * se
        );
    }
    assert!(
        wrong.is_empty(),
        "{} of {} means differ:\n{}",
        wrong.len(),
        variants.len() * truth.len(),
        wrong.join("\n")
    );
}
