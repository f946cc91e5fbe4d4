//! What one unit of work adds to the film.

use std::sync::Arc;

use crate::diagnostics::BadSample;
use crate::fixed;
use crate::planes::Planes;
use crate::{Diagnostics, FilmSpec, Weights, WorkUnit};

/// Sums over the window of one unit of work.
///
/// A sample is one f32 per channel of the [`FilmSpec`], in its units; its weight is the pixel filter's.
#[derive(Clone, Debug)]
pub struct Patch {
    spec: Arc<FilmSpec>,
    unit: WorkUnit,
    pub(crate) planes: Planes,
    pub(crate) diagnostics: Diagnostics,
    at: Option<(u32, u32, u32)>,
}

impl Patch {
    /// An empty patch over the unit's window.
    pub fn new(spec: &Arc<FilmSpec>, unit: WorkUnit) -> Self {
        let planes = Planes::new(spec, unit.window).expect("a tile's sums fit into memory");
        Self { spec: spec.clone(), unit, planes, diagnostics: Diagnostics::default(), at: None }
    }

    /// Empties the patch for another unit, keeping its memory.
    pub fn reset(&mut self, unit: WorkUnit) {
        self.planes.reset(unit.window);
        self.diagnostics.clear();
        self.unit = unit;
        self.at = None;
    }

    /// The film that the patch is for.
    pub fn spec(&self) -> &Arc<FilmSpec> {
        &self.spec
    }

    /// The unit that the patch is the result of.
    pub fn unit(&self) -> &WorkUnit {
        &self.unit
    }

    /// Notes that sample `sample` of pixel (x, y) begins, so that a failure inside it can be located.
    #[inline(always)]
    pub fn mark(&mut self, x: u32, y: u32, sample: u32) {
        self.at = Some((x, y, sample));
    }

    /// The sample last marked or added: (x, y, sample).
    pub fn last(&self) -> Option<(u32, u32, u32)> {
        self.at
    }

    /// Samples that were dropped or clamped.
    pub fn diagnostics(&self) -> &Diagnostics {
        &self.diagnostics
    }

    /// Number of samples held.
    pub fn samples(&self) -> u64 {
        self.planes.counts.iter().map(|&n| u64::from(n)).sum()
    }

    /// Adds one sample.
    ///
    /// `weight` is 1, or -1 on a negative lobe of the filter where the film has [`Weights::Signed`]. A sample that is not
    /// finite, or 2^31 or more in magnitude, is dropped, counted and remembered in [`Patch::diagnostics`].
    ///
    /// # Panics
    /// When the pixel lies outside the window, the number of values is not that of the film's channels, or the weight is
    /// none that the film allows: the caller broke the contract.
    #[inline]
    pub fn add_sample(&mut self, x: u32, y: u32, sample: u32, weight: f32, values: &[f32]) {
        assert!(self.planes.bounds.contains(x, y), "pixel ({x}, {y}) is outside the unit {:?}", self.unit);
        assert!(values.len() == self.planes.layout.channels, "a sample has one value per channel");
        self.at = Some((x, y, sample));
        let luma = luminance(&self.spec.luminance, values);
        let in_range =
            values.iter().fold(luma.abs() < f64::from(fixed::LIMIT), |ok, v| ok & (v.abs() < fixed::LIMIT));
        if !in_range {
            return self.drop_sample(x, y, sample, values);
        }
        match self.spec.clamp {
            Some(clamp) if luma.abs() > f64::from(clamp) => {
                self.add_clamped(x, y, sample, weight, values, luma, clamp)
            }
            _ => self.accumulate(x, y, sample, weight, values, luma),
        }
    }

    #[inline(always)]
    fn accumulate(&mut self, x: u32, y: u32, sample: u32, weight: f32, values: &[f32], luma: f64) {
        let l = self.planes.layout;
        let pixel = self.planes.bounds.index(x, y);
        let slot = if l.slots == 1 { 0 } else { (sample % l.slots as u32) as usize };
        self.planes.counts[pixel * l.slots + slot] += 1;
        let key = (u64::from((luma.abs() as f32).to_bits()) << 32) | u64::from(!sample);
        let largest = &mut self.planes.largest[pixel];
        *largest = (*largest).max(key);
        match self.spec.weights {
            Weights::Unit => {
                assert!(weight == 1.0, "a film of unit weights got weight {weight}");
                self.add_values(pixel, slot, values, luma, |v| v);
            }
            Weights::Signed => self.add_signed(pixel, slot, weight, values, luma),
        }
    }

    #[inline(always)]
    fn add_values(
        &mut self,
        pixel: usize,
        slot: usize,
        values: &[f32],
        luma: f64,
        sign: impl Fn(f32) -> f32,
    ) {
        let l = self.planes.layout;
        let (with, without) = values.split_at(l.with_errors);
        let sums = &mut self.planes.sums[pixel * l.sums..][..l.sums];
        let (errors, means) = sums.split_at_mut(l.slots * l.with_errors);
        let errors = &mut errors[slot * l.with_errors..][..l.with_errors];
        // the usual three channels get loops of known length
        match (errors.first_chunk_mut::<3>(), with.first_chunk::<3>()) {
            (Some(errors), Some(with)) if l.with_errors == 3 => add_all(errors, with, &sign),
            _ => add_all(errors, with, &sign),
        }
        add_all(means, without, &sign);
        if l.squares != 0 {
            let squares = &mut self.planes.squares[pixel * l.squares..][..l.squares];
            let mut overflow = fixed::add_square(&mut squares[l.with_errors], luma * luma);
            overflow |= match (squares.first_chunk_mut::<3>(), with.first_chunk::<3>()) {
                (Some(squares), Some(with)) if l.with_errors == 3 => add_squares(squares, with),
                _ => add_squares(squares, with),
            };
            self.diagnostics.overflows += u64::from(overflow);
        }
    }

    /// A sample of weight 1 or -1: also sums of weights, and unweighted sums for the error of the ratio.
    fn add_signed(&mut self, pixel: usize, slot: usize, weight: f32, values: &[f32], luma: f64) {
        assert!(weight.abs() == 1.0, "a film of signed weights got weight {weight}");
        let l = self.planes.layout;
        self.planes.weights[pixel * l.weights + slot] += weight as i32;
        self.add_values(pixel, slot, values, luma, |v| weight * v);
        if l.cross != 0 {
            add_all(&mut self.planes.cross[pixel * l.cross..][..l.cross], &values[..l.cross], &|v| v);
        }
    }

    #[cold]
    fn add_clamped(
        &mut self,
        x: u32,
        y: u32,
        sample: u32,
        weight: f32,
        values: &[f32],
        luma: f64,
        clamp: f32,
    ) {
        let scale = (f64::from(clamp) / luma.abs()) as f32;
        let values: Vec<f32> = values.iter().map(|v| v * scale).collect();
        let kept = luminance(&self.spec.luminance, &values);
        self.diagnostics.clamped += 1;
        fixed::add(&mut self.diagnostics.removed, luma as f32);
        fixed::add(&mut self.diagnostics.removed, -kept as f32);
        self.accumulate(x, y, sample, weight, &values, kept);
    }

    #[cold]
    fn drop_sample(&mut self, x: u32, y: u32, sample: u32, values: &[f32]) {
        if values.iter().all(|v| v.is_finite()) {
            self.diagnostics.out_of_range += 1;
        } else {
            self.diagnostics.non_finite += 1;
        }
        self.diagnostics.remember(BadSample { sample, y, x, seed: self.spec.seed });
    }
}

/// Y of a sample. In f64, so that its square agrees with the luminance of the channels' exact sums.
#[inline(always)]
fn luminance(weights: &[f32], values: &[f32]) -> f64 {
    weights.iter().zip(values).fold(0.0, |y, (&w, &v)| y + f64::from(w) * f64::from(v))
}

#[inline(always)]
fn add_all(sums: &mut [i128], values: &[f32], sign: &impl Fn(f32) -> f32) {
    for (sum, &v) in sums.iter_mut().zip(values) {
        // most bands of a sample are zero
        if v != 0.0 {
            fixed::add(sum, sign(v));
        }
    }
}

#[inline(always)]
fn add_squares(sums: &mut [fixed::Square], values: &[f32]) -> bool {
    let mut overflow = false;
    for (sum, &v) in sums.iter_mut().zip(values) {
        if v != 0.0 {
            overflow |= fixed::add_square(sum, f64::from(v) * f64::from(v));
        }
    }
    overflow
}
