//! Renders all cases in all ways on all threads.

use super::{
    case::Case,
    family::{FAMILIES, Family},
    judge::{Judged, judge},
    measure::{self, REPLICATES},
    report::Report,
    way::{WAYS, Way},
};
use crate::{Error, validate::Dialect};
use std::{
    sync::{
        Mutex,
        atomic::{AtomicUsize, Ordering},
    },
    time::Instant,
};
use tyndall_base::hash::mix64;

/// How much is rendered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Depth {
    /// Every case by the first way and one other, half a minute.
    Quick,
    /// Every case in every way, some minutes.
    #[default]
    Usual,
    /// The same with sixteen times the samples, an hour.
    Full,
}

impl Depth {
    /// Samples per pixel of the first way.
    const fn spp(self) -> u32 {
        match self {
            Self::Quick => 1024,
            Self::Usual => 4096,
            Self::Full => 65536,
        }
    }

    /// Name in results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Quick => "quick",
            Self::Usual => "default",
            Self::Full => "full",
        }
    }
}

/// What is to be done.
#[derive(Clone, Debug)]
pub struct Plan {
    /// How much.
    pub depth: Depth,
    /// Which families.
    pub families: Vec<&'static Family>,
    /// Threads.
    pub threads: usize,
    /// Seed of all renders; each has one of its own, made from it and its name.
    pub seed: u64,
}

impl Plan {
    /// Families by their names, or all of them.
    ///
    /// # Errors
    /// When there is no such family.
    pub fn new(depth: Depth, names: &[String], threads: usize) -> Result<Self, Error> {
        let find = |name: &String| {
            FAMILIES.iter().find(|f| f.name == name).ok_or_else(|| {
                let known: Vec<&str> = FAMILIES.iter().map(|f| f.name).collect();
                Error::options(
                    format!("--family {name}: there is no such family"),
                    format!("families are {}", known.join(", ")),
                )
            })
        };
        let mut families = names.iter().map(find).collect::<Result<Vec<_>, _>>()?;
        if families.is_empty() {
            families = FAMILIES.iter().collect();
        }
        Ok(Self { depth, families, threads: threads.max(1), seed: 1 })
    }
}

/// Hears of the work while it is done.
pub trait Watch: Sync {
    /// One more render is done.
    fn rendered(&self, done: usize, of: usize);
    /// Whether the rest shall be left undone.
    fn stop(&self) -> bool {
        false
    }
}

impl Watch for () {
    fn rendered(&self, _: usize, _: usize) {}
}

/// How it ended.
#[derive(Debug)]
pub enum Outcome {
    /// Everything was rendered.
    Done(Box<Report>),
    /// It was asked to stop.
    Stopped,
}

/// One render.
struct Task<'c> {
    family: usize,
    case: &'c Case,
    way: &'static Way,
    spp: u32,
    seed: u64,
}

/// Renders and judges.
///
/// # Errors
/// When a scene cannot be rendered at all: a fault of this program.
pub fn run(plan: &Plan, watch: &dyn Watch) -> Result<Outcome, Error> {
    let start = Instant::now();
    let cases: Vec<Vec<Case>> = plan.families.iter().map(|f| (f.cases)(Dialect::Own)).collect();
    let tasks = tasks(plan, &cases);
    let done: Mutex<Vec<(usize, Result<Judged, Error>)>> = Mutex::new(Vec::with_capacity(tasks.len()));
    let next = AtomicUsize::new(0);
    let work = || {
        while !watch.stop() {
            let i = next.fetch_add(1, Ordering::Relaxed);
            let Some(task) = tasks.get(i) else { break };
            let result = render(task);
            // a thread that panicked ends the scope anyway
            let Ok(mut done) = done.lock() else { break };
            done.push((i, result));
            watch.rendered(done.len(), tasks.len());
        }
    };
    std::thread::scope(|scope| (0..plan.threads).for_each(|_| drop(scope.spawn(work))));
    let mut done = done.into_inner().unwrap_or_default();
    if done.len() < tasks.len() {
        return Ok(Outcome::Stopped);
    }
    done.sort_by_key(|(i, _)| *i);
    let mut judged: Vec<Vec<Judged>> = plan.families.iter().map(|_| Vec::new()).collect();
    for (i, result) in done {
        judged[tasks[i].family].push(result?);
    }
    let families = plan.families.iter().copied().zip(judged).collect();
    Ok(Outcome::Done(Box::new(Report::new(plan, families, start.elapsed().as_secs_f64()))))
}

fn tasks<'c>(plan: &Plan, cases: &'c [Vec<Case>]) -> Vec<Task<'c>> {
    let mut out = Vec::new();
    let all = cases.iter().enumerate().flat_map(|(f, cases)| cases.iter().map(move |c| (f, c)));
    for (n, (family, case)) in all.enumerate() {
        let ways: Vec<&'static Way> = WAYS.iter().filter(|w| w.can(case)).collect();
        let rotated = 1 + n % (ways.len() - 1);
        for (w, way) in ways.into_iter().enumerate() {
            let half = if w == 0 { 1.0 } else { 0.5 };
            if plan.depth == Depth::Quick && w != 0 && w != rotated {
                continue;
            }
            let spp = f64::from(plan.depth.spp() * case.effort) * way.effort * half;
            // as many in each replicate
            let spp = (spp as u32).next_multiple_of(REPLICATES);
            let seed = seed(plan.seed, &[plan.families[family].name, &case.name, way.name]);
            out.push(Task { family, case, way, spp, seed });
        }
    }
    out
}

/// A seed from names, so that a family alone repeats what it was among all.
fn seed(seed: u64, names: &[&str]) -> u64 {
    let bytes = names.iter().flat_map(|n| n.bytes().chain([0]));
    bytes.fold(mix64(seed), |h, b| mix64(h ^ u64::from(b)))
}

fn render(task: &Task<'_>) -> Result<Judged, Error> {
    let start = Instant::now();
    let answers = measure::render(task.case, task.way, task.spp, task.seed)?;
    Ok(judge(task.case, task.way, &answers, start.elapsed().as_secs_f64()))
}
