//! The same bits for any number of threads, any order of units, any end of the schedule, and honest failures.
#![allow(clippy::unwrap_used)] // a failure here is a failed test

mod common;

use std::ops::ControlFlow;
use std::time::Duration;

use common::{Hashed, Notes, Shape, cropped, film, run, spec};
use tyndall_engine::backend::{Deliver, Units, Work};
use tyndall_engine::{Backend, Cancel, End, EngineError, Job, Run, Silent, Target, Threads};
use tyndall_film::{ErrorMode, Guide, Pass, Patch, WorkUnit};

fn jobs() -> Vec<Job> {
    let plain = [ErrorMode::Conservative, ErrorMode::REPLICATED].map(|mode| Job::new(cropped(mode), 41));
    let target =
        Job { target: Some(Target::luminance(0.1)), ..Job::new(cropped(ErrorMode::REPLICATED), 4096) };
    plain.into_iter().chain([target]).collect()
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    for job in jobs() {
        let pass = Hashed::new(1, Shape::Mixed);
        let one = film(&job, &pass, 1);
        assert!(one.samples() > 0);
        for threads in [2, 3, 8] {
            assert!(film(&job, &pass, threads).same_bits(&one), "{threads} threads");
        }
        assert!(!film(&job, &Hashed::new(2, Shape::Mixed), 1).same_bits(&one), "another seed");
    }
}

/// Takes all units, renders them in an order of its own.
struct Shuffled(u64);

impl Backend for Shuffled {
    fn run(
        &self,
        work: Work<'_>,
        units: &mut Units<'_>,
        deliver: &mut Deliver<'_>,
    ) -> Result<(), EngineError> {
        let mut units: Vec<_> = units.collect();
        let mut rng = tyndall_testkit::Rng::new(self.0);
        for k in (1..units.len()).rev() {
            units.swap(k, rng.below(k as u32 + 1) as usize);
        }
        for unit in units {
            let mut patch = Patch::new(work.film, unit.clone());
            work.pass.render(&unit, work.guide, &mut patch);
            if deliver(&patch) == ControlFlow::Break(()) {
                break;
            }
        }
        Ok(())
    }

    fn width(&self) -> usize {
        1
    }
}

#[test]
fn any_order_of_units_gives_the_same_bits() {
    for job in jobs() {
        let pass = Hashed::new(1, Shape::Mixed);
        let one = film(&job, &pass, 1);
        for seed in 0..4 {
            let cancel = Cancel::default();
            let run =
                Run { job: &job, pass: &pass, backend: &Shuffled(seed), cancel: &cancel, checkpoints: None };
            assert!(run.start(&mut Silent).unwrap().state.film.same_bits(&one));
        }
    }
}

/// A time limit ends on a whole round, with the bits of a run of that many samples.
#[test]
fn a_time_limit_gives_the_bits_of_a_run_of_that_many_samples() {
    struct Slow(Hashed);
    impl Pass for Slow {
        fn render(&self, unit: &WorkUnit, guide: &Guide, out: &mut Patch) {
            std::thread::sleep(Duration::from_micros(300));
            self.0.render(unit, guide, out);
        }
    }
    let pass = Slow(Hashed::new(4, Shape::Exponential));
    let job = Job {
        time: Some(Duration::from_millis(120)),
        ..Job::new(cropped(ErrorMode::Conservative), 1_000_000)
    };
    let outcome = run(&job, &pass, 2).unwrap();
    assert_eq!(outcome.end, End::TimeUp);
    let spp = (outcome.state.film.samples() / job.film.bounds.area()) as u32;
    assert_eq!(outcome.state.film.samples() % job.film.bounds.area(), 0);
    assert!((4..1_000_000).contains(&spp));
    let counted = film(&Job { time: None, spp, ..job.clone() }, &pass.0, 1);
    assert!(outcome.state.film.same_bits(&counted), "{spp} samples");
    // an impossible limit still gives one whole round
    let hasty = run(&Job { time: Some(Duration::ZERO), ..job }, &pass, 2).unwrap();
    assert_eq!(hasty.state.film.samples() / hasty.state.film.spec().bounds.area(), 4);
}

#[test]
fn a_panic_in_a_worker_is_an_error_that_names_the_sample() {
    struct Faulty(Hashed);
    impl Pass for Faulty {
        fn render(&self, unit: &WorkUnit, guide: &Guide, out: &mut Patch) {
            if unit.window.contains(20, 20) && unit.samples.contains(&9) {
                out.mark(20, 20, 9);
                panic!("division of nothing by {}", 0);
            }
            self.0.render(unit, guide, out);
        }
    }
    let job = Job::new(spec(32, 32, ErrorMode::Conservative), 16);
    for threads in [1, 4] {
        let error = run(&job, &Faulty(Hashed::new(1, Shape::Smooth)), threads).unwrap_err();
        assert!(matches!(error, EngineError::Worker { at: Some((20, 20, 9)), .. }));
        let text = error.to_string();
        assert!(text.contains("pixel (20, 20), sample 9: division of nothing by 0"), "{text}");
    }
}

/// Loses every tenth unit, or delivers it twice.
struct Careless {
    twice: bool,
}

impl Backend for Careless {
    fn run(
        &self,
        work: Work<'_>,
        units: &mut Units<'_>,
        deliver: &mut Deliver<'_>,
    ) -> Result<(), EngineError> {
        for (k, unit) in units.enumerate() {
            let mut patch = Patch::new(work.film, unit.clone());
            work.pass.render(&unit, work.guide, &mut patch);
            let times = if k % 10 != 3 { 1 } else { 2 * u32::from(self.twice) };
            if (0..times).any(|_| deliver(&patch) == ControlFlow::Break(())) {
                break;
            }
        }
        Ok(())
    }

    fn width(&self) -> usize {
        1
    }
}

#[test]
fn a_backend_that_loses_or_repeats_units_is_caught() {
    let job = Job::new(spec(64, 64, ErrorMode::Conservative), 4);
    for (twice, reason) in [(false, "not delivered"), (true, "came twice")] {
        let cancel = Cancel::default();
        let pass = Hashed::new(1, Shape::Smooth);
        let run =
            Run { job: &job, pass: &pass, backend: &Careless { twice }, cancel: &cancel, checkpoints: None };
        let text = run.start(&mut Silent).unwrap_err().to_string();
        assert!(text.contains(reason), "{text}");
    }
}

#[test]
fn progress_grows_to_one_and_reports_errors() {
    let job = Job::new(cropped(ErrorMode::REPLICATED), 128);
    let (cancel, mut notes) = (Cancel::default(), Notes::default());
    let pass = Hashed::new(1, Shape::Exponential);
    let backend = Threads::new(2);
    let run = Run { job: &job, pass: &pass, backend: &backend, cancel: &cancel, checkpoints: None };
    let outcome = run.start(&mut notes).unwrap();
    assert_eq!((outcome.end, notes.rounds), (End::Complete, 6));
    assert!(notes.progress.windows(2).all(|w| w[0].fraction <= w[1].fraction));
    let last = notes.progress.last().unwrap();
    assert_eq!((last.fraction, last.spp, last.remaining), (1.0, 128.0, Some(Duration::ZERO)));
    // exponential samples: relative standard error 1/sqrt(128)
    let median = last.errors.as_ref().unwrap().median_rel_se_y;
    assert!((median * 128f64.sqrt() - 1.0).abs() < 0.1, "{median}");
    assert_eq!(outcome.samples, job.film.bounds.area() * 128);
}

/// The memory of a film and its refusal come before any work.
#[test]
fn a_refused_job_renders_nothing() {
    let pass = Hashed::new(1, Shape::Smooth);
    let job = Job::new(spec(0, 4, ErrorMode::Conservative), 4);
    assert!(run(&job, &pass, 1).is_err());
    assert_eq!(pass.calls.into_inner(), 0);
}
