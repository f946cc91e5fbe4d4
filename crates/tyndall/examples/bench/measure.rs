//! Renders with many seeds, in this process, on this thread.

use crate::{
    efficiency::Measurement,
    scenes::BenchScene,
    setup::Setup,
    store,
    variants::{DEFAULTS, Variant},
};
use cpu_time::ThreadTime;
use tyndall::{
    Options, Plan, Source,
    film::{Film, Guide, Pass, Patch, WorkUnit},
    plan,
};

/// The name under which our own results stand.
pub const OURS: &str = "Tyndall";

/// One cell of a table.
pub struct Task<'a> {
    pub scene: &'a BenchScene,
    pub variant: &'a Variant,
    pub resolution: u32,
    pub spp: u32,
    pub seeds: u32,
}

/// The defaults on all scenes at all numbers of samples.
pub fn defaults(setup: &Setup) -> Result<(), String> {
    for scene in &setup.scenes {
        let task = |&spp: &u32| Task {
            scene,
            variant: &DEFAULTS,
            resolution: setup.resolution(),
            spp,
            seeds: setup.seeds_at(spp),
        };
        eprintln!("{}: defaults", scene.name);
        let tasks: Vec<Task<'_>> = setup.spp().iter().map(task).collect();
        for (task, m) in tasks.iter().zip(all(setup, &tasks)?) {
            store::pictures(&setup.folder, OURS, scene.name, task.spp, &m)?;
        }
    }
    Ok(())
}

/// Measures all tasks; each seed goes through all of them before the next, so that a busy machine slows all alike.
pub fn all(setup: &Setup, tasks: &[Task<'_>]) -> Result<Vec<Measurement>, String> {
    let plans = tasks.iter().map(|t| planned(setup, t)).collect::<Result<Vec<_>, _>>()?;
    let empty = |t: &Task<'_>| Measurement {
        width: t.resolution as usize,
        spp: f64::from(t.spp),
        ..Measurement::default()
    };
    let mut out: Vec<Measurement> = tasks.iter().map(empty).collect();
    for seed in 0..tasks.iter().map(|t| t.seeds).max().unwrap_or(0) {
        for ((plan, m), _) in plans.iter().zip(&mut out).zip(tasks).filter(|(_, t)| seed < t.seeds) {
            let (picture, seconds) = picture(plan, u64::from(seed))?;
            m.pictures.push(picture);
            m.seconds.push(seconds);
        }
    }
    Ok(out)
}

fn planned(setup: &Setup, task: &Task<'_>) -> Result<Plan, String> {
    let resolution = Some([task.resolution; 2]);
    let mut options = Options { spp: Some(task.spp), resolution, ..Options::default() };
    (task.variant.options)(&mut options);
    let path = task.scene.path(&setup.scene_folder());
    let mut plan = plan(Source::File(&path), &options).map_err(|e| e.to_string())?;
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
