//! Inner loops, one call at a time: what a phase function, a BSDF, a set of wavelengths, a sampler's number costs, and
//! whole samples on a small film.

use crate::{measure, setup::Setup, store};
use cpu_time::ThreadTime;
use serde_json::json;
use std::hint::black_box;
use tyndall::{
    Options, Plan, Source,
    base::{Vec3, hash, vec::vec3},
    plan,
    scatter::{
        bsdf::{Bsdf, Conductor, Dielectric, Diffuse, TrowbridgeReitz},
        phase::{Draine, FournierForand, HenyeyGreenstein, PhaseFunction, Rayleigh, Schlick, TwoLobe},
    },
    spectral::{
        Spectrum, Wavelengths,
        curve::Curve,
        range::{LambdaRange, Outside},
        strategy::{Density, WavelengthSampler},
    },
    transport::sampler::{PathSampler, SamplerKind},
};

/// Lanes, as the program's default has them.
const LANES: usize = 8;
/// Calls of one timed run.
const CALLS: u32 = 2000;

/// A loop: does its work so many times, and returns something that depends on all of it.
pub struct Inner {
    /// What it is.
    pub name: String,
    /// Calls that one unit of work stands for.
    pub calls: f64,
    /// The loop.
    pub run: Box<dyn FnMut(u32) -> Result<f32, String>>,
}

fn inner(name: &str, mut run: impl FnMut(u32) -> f32 + 'static) -> Inner {
    Inner { name: name.into(), calls: 1.0, run: Box::new(move |n| Ok(run(n))) }
}

/// A number of \[0, 1).
fn unit(i: u32, k: u32) -> f32 {
    hash::to_unit_f32(hash::hash2(i, k))
}

fn direction(i: u32) -> Vec3 {
    tyndall::base::warp::sample_uniform_sphere([unit(i, 1), unit(i, 2)])
}

/// A direction that the loop really makes, whatever becomes of it.
fn given(i: u32) -> Vec3 {
    black_box(direction(i))
}

fn upwards(i: u32) -> Vec3 {
    black_box(tyndall::base::warp::sample_cosine_hemisphere([unit(i, 3), unit(i, 4)]))
}

fn wavelengths() -> Wavelengths<LANES> {
    WavelengthSampler::uniform(LambdaRange::VISIBLE).sample(0.37)
}

/// A line from `a` at 360 nm to `b` at 830 nm.
fn ramp(a: f32, b: f32) -> Result<Curve, String> {
    Curve::linear(&[360.0, 830.0], &[a, b], Outside::Hold).map_err(|e| e.to_string())
}

fn phases() -> Result<Vec<(&'static str, PhaseFunction)>, String> {
    let text = |e: tyndall::scatter::ScatterError| e.to_string();
    Ok(vec![
        ("isotropic", PhaseFunction::Isotropic),
        (
            "Henyey-Greenstein",
            PhaseFunction::HenyeyGreenstein(HenyeyGreenstein::new(ramp(0.8, 0.6)?).map_err(text)?),
        ),
        ("Rayleigh", PhaseFunction::Rayleigh(Rayleigh::IDEAL)),
        ("Draine", PhaseFunction::Draine(Draine::new(ramp(0.8, 0.2)?, ramp(0.5, 30.0)?).map_err(text)?)),
        ("Schlick", PhaseFunction::Schlick(Schlick::new(ramp(0.9, 0.2)?).map_err(text)?)),
        (
            "two lobes",
            PhaseFunction::TwoLobe(
                TwoLobe::new([ramp(0.9, 0.7)?, ramp(-0.2, -0.6)?], ramp(0.95, 0.5)?).map_err(text)?,
            ),
        ),
        ("Fournier-Forand", PhaseFunction::FournierForand(FournierForand::new(1.1, 3.5835).map_err(text)?)),
    ])
}

fn bsdfs() -> Vec<(&'static str, Bsdf<'static, LANES>)> {
    let half = Spectrum::from_fn(|k| 0.4 + 0.05 * k as f32);
    let index = Spectrum::from_fn(|k| 1.3 + 0.02 * k as f32);
    let rough = TrowbridgeReitz::new(0.2, 0.2);
    let conductor = |distribution| Bsdf::Conductor(Conductor { eta: half, k: index, distribution });
    vec![
        ("diffuse", Bsdf::Diffuse(Diffuse { reflectance: half })),
        ("smooth metal", conductor(TrowbridgeReitz::SMOOTH)),
        ("rough metal", conductor(rough)),
        ("smooth glass", Bsdf::Dielectric(Dielectric::new(Spectrum::splat(1.5), TrowbridgeReitz::SMOOTH))),
        ("rough glass", Bsdf::Dielectric(Dielectric::new(Spectrum::splat(1.5), rough))),
    ]
}

fn scattering() -> Result<Vec<Inner>, String> {
    let mut all = Vec::new();
    for (name, phase) in phases()? {
        let (w, p) = (wavelengths(), phase.clone());
        all.push(inner(&format!("phase function, evaluate: {name}"), move |n| {
            (0..n).map(|i| p.eval(given(i), given(!i), black_box(&w)).sum()).sum()
        }));
        all.push(inner(&format!("phase function, sample: {name}"), move |n| {
            let draw = |i| phase.sample(given(i), [unit(i, 5), unit(i, 6)], black_box(&w));
            (0..n).map(draw).map(|s| s.p.sum() + s.wi.z).sum()
        }));
    }
    for (name, bsdf) in bsdfs() {
        all.push(inner(&format!("BSDF, evaluate with density: {name}"), move |n| {
            let f = |i| black_box(&bsdf).eval_pdf(upwards(i), upwards(!i));
            (0..n).map(f).map(|(f, pdf)| f.sum() + pdf.sum()).sum()
        }));
        all.push(inner(&format!("BSDF, sample: {name}"), move |n| {
            let draw = |i| black_box(&bsdf).sample(upwards(i), unit(i, 5), [unit(i, 6), unit(i, 7)]);
            (0..n).map(|i| draw(i).map_or(0.0, |s| s.wi.z)).sum()
        }));
    }
    Ok(all)
}

fn numbers() -> Result<Vec<Inner>, String> {
    let uniform = WavelengthSampler::uniform(LambdaRange::VISIBLE);
    let visible: WavelengthSampler =
        Density::visible(LambdaRange::VISIBLE).map_err(|e| e.to_string())?.into();
    let set = |name: &str, sampler: WavelengthSampler| {
        inner(name, move |n| (0..n).map(|i| black_box(&sampler).sample::<LANES>(unit(i, 1)).pdf[3]).sum())
    };
    let path = |name: &str, kind| {
        inner(name, move |n| {
            let one = |i: u32| {
                let mut s = PathSampler::new(kind, 1, i & 63, i >> 6 & 63, i >> 12, 1);
                (0..8).map(|_| s.next_2d()).map(|u| u.x + u.y).sum::<f32>()
            };
            (0..n).map(one).sum()
        })
    };
    Ok(vec![
        inner("the two directions that phase functions are evaluated at", |n| {
            (0..n).map(|i| given(i).z + given(!i).x).sum()
        }),
        set("8 wavelengths, uniform", uniform),
        set("8 wavelengths, by the eye", visible),
        path("8 pairs of Owen-scrambled Sobol numbers, a new path", SamplerKind::OwenSobol),
        path("8 pairs of hashed numbers, a new path", SamplerKind::Independent),
        inner("point on the unit sphere", |n| (0..n).map(|i| direction(i).dot(vec3(0.1, 0.2, 0.3))).sum()),
    ])
}

/// Pixels along each side of the film that whole samples are counted on.
const SIDE: u32 = 16;

/// Whole samples of a scene, or first flights alone (no scattering). The scene is read when the loop first runs.
fn samples(setup: &Setup, scene: &str, max_depth: Option<u32>) -> Inner {
    let options = Options { spp: Some(1), resolution: Some([SIDE; 2]), max_depth, ..Options::default() };
    let path = setup.scene_folder().join(scene).with_extension("pbrt");
    let mut loaded: Option<Plan> = None;
    let what = if max_depth.is_some() { "camera ray and flight through the medium" } else { "whole sample" };
    let run = move |n: u32| {
        let plan = match &mut loaded {
            Some(plan) => plan,
            none => none.insert(plan(Source::File(&path), &options).map_err(|e| e.to_string())?),
        };
        plan.job.spp = n;
        measure::picture(plan, 0).map(|(y, _)| y.iter().sum::<f64>() as f32)
    };
    Inner { name: format!("{what}: {scene}"), calls: f64::from(SIDE * SIDE), run: Box::new(run) }
}

/// All loops.
pub fn loops(setup: &Setup) -> Result<Vec<Inner>, String> {
    let mut all = scattering()?;
    all.extend(numbers()?);
    all.push(samples(setup, "cloud-grid", Some(0)));
    for scene in ["fog-box", "empty-box", "cloud-grid", "room"] {
        all.push(samples(setup, scene, None));
    }
    Ok(all)
}

/// Nanoseconds of every loop: the best of many runs, since others only ever add.
pub fn times(setup: &Setup) -> Result<(), String> {
    let rounds = if setup.quick { 5 } else { 200 };
    for mut l in loops(setup)? {
        let whole = l.calls > 1.0;
        let (calls, rounds) = if whole { (8, rounds.min(20)) } else { (CALLS, rounds) };
        let mut best = f64::INFINITY;
        for _ in 0..rounds {
            let start = ThreadTime::now();
            black_box((l.run)(calls)?);
            best = best.min(start.elapsed().as_secs_f64());
        }
        let nanoseconds = best * 1e9 / (f64::from(calls) * l.calls);
        eprintln!("{:60} {nanoseconds:10.1} ns", l.name);
        store::line(&setup.folder, &json!({ "kind": "inner", "loop": l.name, "nanoseconds": nanoseconds }))?;
    }
    Ok(())
}
