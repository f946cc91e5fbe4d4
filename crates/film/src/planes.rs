//! The accumulators of a window of pixels, shared by patches and films.

use crate::fixed::{self, Square};
use crate::spec::Layout;
use crate::{FilmError, FilmSpec, PixelBounds};

/// Sums over a window, row-major, all accumulators of a pixel side by side.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Planes {
    pub bounds: PixelBounds,
    pub layout: Layout,
    pub sums: Vec<i128>,
    pub squares: Vec<Square>,
    pub cross: Vec<i128>,
    pub counts: Vec<u32>,
    pub weights: Vec<i32>,
    /// Largest |Y| of a sample (bits of the f32 in the upper half) and the complement of its index.
    pub largest: Vec<u64>,
}

impl Planes {
    /// All zero.
    pub fn new(spec: &FilmSpec, bounds: PixelBounds) -> Result<Self, FilmError> {
        let layout = Layout::new(spec);
        let pixels = bounds.area() as usize;
        let refuse = |_| FilmError::OutOfMemory { bytes: spec.bytes() };
        Ok(Self {
            bounds,
            layout,
            sums: zeros(pixels, layout.sums).map_err(refuse)?,
            squares: zeros(pixels, layout.squares).map_err(refuse)?,
            cross: zeros(pixels, layout.cross).map_err(refuse)?,
            counts: zeros(pixels, layout.slots).map_err(refuse)?,
            weights: zeros(pixels, layout.weights).map_err(refuse)?,
            largest: zeros(pixels, 1).map_err(refuse)?,
        })
    }

    /// All zero again, over another window.
    pub fn reset(&mut self, bounds: PixelBounds) {
        let pixels = bounds.area() as usize;
        self.bounds = bounds;
        refill(&mut self.sums, pixels * self.layout.sums);
        refill(&mut self.squares, pixels * self.layout.squares);
        refill(&mut self.cross, pixels * self.layout.cross);
        refill(&mut self.counts, pixels * self.layout.slots);
        refill(&mut self.weights, pixels * self.layout.weights);
        refill(&mut self.largest, pixels);
    }

    /// Adds planes whose window lies inside; returns the number of overflows.
    pub fn merge(&mut self, other: &Self) -> u64 {
        let mut overflows = 0;
        let width = other.bounds.width() as usize;
        for y in other.bounds.y0..other.bounds.y1 {
            let to = self.bounds.index(other.bounds.x0, y);
            let from = other.bounds.index(other.bounds.x0, y);
            overflows += self.merge_row(other, to, from, width);
        }
        overflows
    }

    /// Counts of samples cannot wrap; those of a forged file may, and must not bring the program down.
    fn merge_row(&mut self, other: &Self, to: usize, from: usize, width: usize) -> u64 {
        let l = self.layout;
        let mut overflows = 0;
        rows(&mut self.sums, &other.sums, to, from, width, l.sums, fixed::merge);
        rows(&mut self.squares, &other.squares, to, from, width, l.squares, |a, b| {
            overflows += u64::from(fixed::add_limbs(a, b));
        });
        rows(&mut self.cross, &other.cross, to, from, width, l.cross, fixed::merge);
        rows(&mut self.counts, &other.counts, to, from, width, l.slots, |a, b| *a = a.wrapping_add(b));
        rows(&mut self.weights, &other.weights, to, from, width, l.weights, |a, b| *a = a.wrapping_add(b));
        rows(&mut self.largest, &other.largest, to, from, width, 1, |a, b| *a = (*a).max(b));
        overflows
    }

    /// Samples of a pixel.
    pub fn count(&self, pixel: usize) -> u32 {
        self.slot_counts(pixel).iter().sum()
    }

    /// Samples of a pixel in each slot.
    pub fn slot_counts(&self, pixel: usize) -> &[u32] {
        &self.counts[pixel * self.layout.slots..][..self.layout.slots]
    }

    /// Sum of weights of a slot.
    pub fn weight(&self, pixel: usize, slot: usize) -> f64 {
        if self.layout.weights == 0 {
            f64::from(self.slot_counts(pixel)[slot])
        } else {
            f64::from(self.weights[pixel * self.layout.slots + slot])
        }
    }

    /// Sums of the channels with errors in a slot.
    pub fn slot_sums(&self, pixel: usize, slot: usize) -> &[i128] {
        &self.sums[pixel * self.layout.sums + slot * self.layout.with_errors..][..self.layout.with_errors]
    }

    /// Sums of the channels without errors.
    pub fn mean_sums(&self, pixel: usize) -> &[i128] {
        let l = &self.layout;
        &self.sums[pixel * l.sums + l.slots * l.with_errors..][..l.channels - l.with_errors]
    }

    /// Sums of squares of the channels with errors, then of Y.
    pub fn pixel_squares(&self, pixel: usize) -> &[Square] {
        &self.squares[pixel * self.layout.squares..][..self.layout.squares]
    }

    /// Unweighted sums of signed samples.
    pub fn pixel_cross(&self, pixel: usize) -> &[i128] {
        &self.cross[pixel * self.layout.cross..][..self.layout.cross]
    }
}

fn rows<T: Copy>(
    to: &mut [T],
    from: &[T],
    to_pixel: usize,
    from_pixel: usize,
    width: usize,
    each: usize,
    mut add: impl FnMut(&mut T, T),
) {
    let to = &mut to[to_pixel * each..][..width * each];
    let from = &from[from_pixel * each..][..width * each];
    to.iter_mut().zip(from).for_each(|(a, &b)| add(a, b));
}

fn zeros<T: Clone + bytemuck::Zeroable>(
    pixels: usize,
    each: usize,
) -> Result<Vec<T>, std::collections::TryReserveError> {
    let mut v = Vec::new();
    v.try_reserve_exact(pixels.saturating_mul(each))?;
    v.resize(pixels * each, T::zeroed());
    Ok(v)
}

fn refill<T: Clone + bytemuck::Zeroable>(v: &mut Vec<T>, len: usize) {
    v.clear();
    v.resize(len, T::zeroed());
}
