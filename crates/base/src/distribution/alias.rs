use super::{DistributionError, STEP, STEPS, share_steps, step_of};

/// A discrete distribution drawn in constant time (Walker 1977, built as in Vose 1991, in integers and hence exact).
#[derive(Clone, Debug)]
pub struct Alias {
    columns: Vec<Column>,
    /// Steps of each entry, out of 2^24.
    steps: Vec<u32>,
    /// A column holds 2^shift steps.
    shift: u32,
}

/// The first `own` steps of a column go to its own entry, the others to `other`.
#[derive(Clone, Copy, Debug)]
struct Column {
    own: u32,
    other: u32,
}

impl Alias {
    /// Probabilities in proportion to `weights`; see the module for their rounding. At most 2^22 weights.
    pub fn new(weights: &[f64]) -> Result<Self, DistributionError> {
        let steps = share_steps(weights)?;
        let count = steps.len().next_power_of_two();
        let shift = STEPS.ilog2() - count.ilog2();
        Ok(Self { columns: fill_columns(&steps, count, 1 << shift), steps, shift })
    }

    /// The entry for a uniform number in `[0, 1)`.
    #[inline(always)]
    pub fn sample(&self, u: f32) -> usize {
        self.locate(step_of(u)).0
    }

    /// The entry and a fresh uniform number, made of what `u` has left: few bits in large tables.
    #[inline(always)]
    pub fn sample_remapped(&self, u: f32) -> (usize, f32) {
        let (entry, place, width) = self.locate(step_of(u));
        (entry, (place as f32 + 0.5) / width as f32)
    }

    /// The entry of a step, the step's place in its part of the column, and the width of that part.
    #[inline(always)]
    fn locate(&self, step: u32) -> (usize, u32, u32) {
        let index = (step >> self.shift) as usize;
        let within = step & ((1 << self.shift) - 1);
        let Column { own, other } = self.columns[index];
        if within < own {
            (index, within, own)
        } else {
            (other as usize, within - own, (1 << self.shift) - own)
        }
    }

    /// The exact probability of an entry.
    #[inline(always)]
    pub fn pmf(&self, entry: usize) -> f32 {
        self.steps[entry] as f32 * STEP
    }

    /// Number of entries.
    pub fn len(&self) -> usize {
        self.steps.len()
    }

    /// Never true: an empty distribution is refused.
    pub fn is_empty(&self) -> bool {
        self.steps.is_empty()
    }
}

/// Vose's method: each column is filled by an entry with too few steps and topped up by one with too many.
fn fill_columns(steps: &[u32], count: usize, capacity: u32) -> Vec<Column> {
    let mut left: Vec<u32> = steps.to_vec();
    left.resize(count, 0);
    let mut columns: Vec<Column> = (0..count).map(|i| Column { own: capacity, other: i as u32 }).collect();
    let (mut small, mut large): (Vec<usize>, Vec<usize>) = (0..count).partition(|&i| left[i] < capacity);
    while let Some(poor) = small.pop() {
        let rich = *large.last().expect("columns and steps have the same sum, so a deficit has its surplus");
        columns[poor] = Column { own: left[poor], other: rich as u32 };
        left[rich] -= capacity - left[poor];
        if left[rich] < capacity {
            large.pop();
            small.push(rich);
        }
    }
    columns
}
