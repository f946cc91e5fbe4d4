//! How far the command is, by the cost of its steps.

use std::time::{Duration, Instant};

/// How far the command is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Step {
    /// What is being computed.
    pub name: String,
    /// Number of the step, from 1.
    pub number: usize,
    /// Steps in all.
    pub count: usize,
    /// Part of the whole that is done, by cost, 0 to 1.
    pub done: f64,
    /// Time left by the rate so far; `None` before there is one.
    pub left: Option<Duration>,
    /// Samples of the step, where it is a render.
    pub samples: Option<Samples>,
}

/// Samples of a render so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Samples {
    /// Per pixel.
    pub spp: f64,
    /// Per pixel at the end.
    pub end: u32,
    /// Per second, over all pixels.
    pub per_second: f64,
}

/// Adds up the cost of steps. Its unit is the cost of one path of one wavelength.
#[derive(Debug)]
pub(super) struct Meter {
    step: Step,
    total: f64,
    /// Cost of the steps before this one, and of this one.
    before: f64,
    cost: f64,
    /// Cost of what an earlier run had finished: it tells nothing of the rate.
    free: f64,
    start: Instant,
}

impl Meter {
    /// Before the first of `count` steps of the cost `total`.
    pub fn new(count: usize, total: f64) -> Self {
        let step = Step { count, ..Step::default() };
        Self { step, total, before: 0.0, cost: 0.0, free: 0.0, start: Instant::now() }
    }

    /// The next step starts.
    pub fn begin(&mut self, name: String, cost: f64) -> &Step {
        self.before += self.cost;
        self.cost = cost;
        self.step.name = name;
        self.step.number += 1;
        self.at(0.0, None)
    }

    /// A part of the step is done.
    pub fn at(&mut self, fraction: f64, samples: Option<Samples>) -> &Step {
        let done = self.before + fraction * self.cost;
        self.step.done = done / self.total;
        self.step.samples = samples;
        let (paid, elapsed) = (done - self.free, self.start.elapsed());
        self.step.left = (paid > 0.0 && elapsed > Duration::from_secs(1))
            .then(|| elapsed.mul_f64((self.total - done).max(0.0) / paid));
        &self.step
    }

    /// The step was finished by an earlier run.
    pub fn skip(&mut self) {
        self.free += self.cost;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cost_decides_how_far_it_is() {
        let mut meter = Meter::new(3, 10.0);
        assert_eq!((meter.begin("a".into(), 1.0).number, meter.at(1.0, None).done), (1, 0.1));
        meter.skip();
        assert_eq!(meter.begin("b".into(), 7.0).done, 0.1);
        // what was there before has no rate
        assert_eq!(meter.at(0.0, None).left, None);
        meter.start = Instant::now().checked_sub(Duration::from_secs(35)).expect("a running clock");
        let step = meter.at(0.5, None).clone();
        assert!((step.done - 0.45).abs() < 1e-12 && step.count == 3);
        // 35 s for 3.5 leave 55 s for 5.5
        let left = step.left.expect("a rate").as_secs_f64();
        assert!((left - 55.0).abs() < 0.5, "{left}");
    }
}
