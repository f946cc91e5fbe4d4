//! Non-local means: every pixel becomes a mean over those around it whose surroundings look the same, given the noise.
//!
//! `d(p, q) = ((u_p - u_q)^2 - (v_p + min(v_p, v_q))) / (K^2 (v_p + v_q))` per pixel and channel; `D(p, q)` is its mean
//! over patches around p and q and over the channels; `w = exp(-max(0, D))`. Source: Rousselle, Knaus & Zwicker 2012,
//! without their two half buffers: our variances are pooled, so that they do not follow the noise of a pixel.

use super::noisy::Noisy;
use rayon::prelude::*;
use std::ops::Range;
use tyndall_base::math::exp;

/// Reach of the search for similar pixels.
pub(super) const REACH: usize = 8;
/// Reach of a patch.
const PATCH: usize = 2;
/// Pixels around the picture, copies of its edge.
const MARGIN: usize = REACH + PATCH;
/// Sensitivity to differences.
const K2: f32 = 0.7 * 0.7;
/// Beyond this distance the weight is zero.
const BEYOND: f32 = 5.0;
/// Rows that are filtered in one go.
pub(super) const ROWS: usize = 32;

/// What the filter makes of a picture.
pub(super) struct Filtered {
    /// The means of similar pixels, one plane a channel.
    pub planes: Vec<Vec<f32>>,
    /// Sums of weights: 1 for a pixel like which there is no other.
    pub total: Vec<f32>,
}

/// Filters a picture.
pub(super) fn filter(picture: &Noisy) -> Filtered {
    let padded = Padded::new(picture);
    let strips: Vec<Range<usize>> =
        (0..picture.height).step_by(ROWS).map(|y| y..(y + ROWS).min(picture.height)).collect();
    let parts: Vec<Filtered> = strips.into_par_iter().map(|rows| Strip::new(&padded, rows).run()).collect();
    let plane = |c: usize| parts.iter().flat_map(|part| &part.planes[c]).copied().collect();
    let planes = (0..picture.channels.len()).map(plane).collect();
    Filtered { planes, total: parts.iter().flat_map(|part| &part.total).copied().collect() }
}

/// The planes with a margin on all sides.
struct Padded {
    width: usize,
    height: usize,
    stride: usize,
    /// Mean and variance of each channel.
    channels: Vec<[Vec<f32>; 2]>,
}

impl Padded {
    fn new(picture: &Noisy) -> Self {
        let (width, height) = (picture.width, picture.height);
        let pad = |plane: &[f32]| {
            let inside = |i: usize, n: usize| i.saturating_sub(MARGIN).min(n - 1);
            let rows = (0..height + 2 * MARGIN).map(|y| &plane[inside(y, height) * width..][..width]);
            rows.flat_map(|row| (0..width + 2 * MARGIN).map(move |x| row[inside(x, width)])).collect()
        };
        let channels = picture.channels.iter().map(|c| [pad(&c.mean), pad(&c.variance)]).collect();
        Self { width, height, stride: width + 2 * MARGIN, channels }
    }

    /// A piece of a row of a plane; coordinates count from the margin's corner.
    fn row(&self, channel: usize, plane: usize, x: usize, y: usize, length: usize) -> &[f32] {
        &self.channels[channel][plane][y * self.stride + x..][..length]
    }
}

/// A few rows on their way through the filter.
struct Strip<'p> {
    padded: &'p Padded,
    rows: Range<usize>,
    /// Distances of pixels, then their sums along patches' rows, one row after the other, patches' margin included.
    distance: Vec<f32>,
    along: Vec<f32>,
    patch: Vec<f32>,
    weight: Vec<f32>,
    /// Sums of `w (u_q - u_p)`, a plane a channel, and of `w`.
    shift: Vec<Vec<f32>>,
    total: Vec<f32>,
}

impl<'p> Strip<'p> {
    fn new(padded: &'p Padded, rows: Range<usize>) -> Self {
        let (width, count) = (padded.width, rows.len());
        let wide = width + 2 * PATCH;
        Self {
            padded,
            rows,
            distance: vec![0.0; wide],
            along: vec![0.0; width * (count + 2 * PATCH)],
            patch: vec![0.0; width],
            weight: vec![0.0; width],
            shift: vec![vec![0.0; width * count]; padded.channels.len()],
            total: vec![0.0; width * count],
        }
    }

    fn run(mut self) -> Filtered {
        for oy in 0..=2 * REACH {
            for ox in 0..=2 * REACH {
                self.compare(ox, oy);
                self.add(ox, oy);
            }
        }
        let (padded, width) = (self.padded, self.padded.width);
        let mut planes = self.shift;
        for (c, plane) in planes.iter_mut().enumerate() {
            for (i, (value, total)) in plane.iter_mut().zip(&self.total).enumerate() {
                let u = padded.row(c, 0, i % width + MARGIN, self.rows.start + i / width + MARGIN, 1)[0];
                *value = u + *value / total;
            }
        }
        Filtered { planes, total: self.total }
    }

    /// Distances of all pixels to those at an offset (from `-REACH`), summed along the rows of patches.
    fn compare(&mut self, ox: usize, oy: usize) {
        let (padded, width) = (self.padded, self.padded.width);
        let wide = width + 2 * PATCH;
        for j in 0..self.rows.len() + 2 * PATCH {
            let y = self.rows.start + j + REACH;
            self.distance.fill(0.0);
            for c in 0..padded.channels.len() {
                let here = [0, 1].map(|plane| padded.row(c, plane, REACH, y, wide));
                let there = [0, 1].map(|plane| padded.row(c, plane, ox, y + oy - REACH, wide));
                add_distances(&mut self.distance, here, there);
            }
            let along = &mut self.along[j * width..][..width];
            add_windows(along, &self.distance);
        }
    }

    /// Adds the pixels at an offset, as far as they lie inside of the picture.
    fn add(&mut self, ox: usize, oy: usize) {
        let (padded, width) = (self.padded, self.padded.width);
        let scale = 1.0 / ((2 * PATCH + 1) * (2 * PATCH + 1) * padded.channels.len()) as f32;
        let first = REACH.saturating_sub(ox).min(width);
        let last = width.min((width + REACH).saturating_sub(ox)).max(first);
        for j in 0..self.rows.len() {
            let y = self.rows.start + j;
            if y + oy < REACH || y + oy >= padded.height + REACH {
                continue;
            }
            self.patch.fill(0.0);
            for k in 0..=2 * PATCH {
                let row = &self.along[(j + k) * width..][..width];
                self.patch.iter_mut().zip(row).for_each(|(sum, d)| *sum += d);
            }
            weigh(&mut self.weight, &self.patch, scale);
            let weight = &self.weight[first..last];
            let total = &mut self.total[j * width..][first..last];
            total.iter_mut().zip(weight).for_each(|(sum, w)| *sum += w);
            for (c, shift) in self.shift.iter_mut().enumerate() {
                let length = last - first;
                let here = padded.row(c, 0, first + MARGIN, y + MARGIN, length);
                let there = padded.row(c, 0, first + ox + PATCH, y + oy + PATCH, length);
                let shift = &mut shift[j * width..][first..last];
                for i in 0..length {
                    shift[i] += weight[i] * (there[i] - here[i]);
                }
            }
        }
    }
}

/// Adds `d(p, q)` of a row of pixels; each side is means and variances.
fn add_distances(distance: &mut [f32], [u, v]: [&[f32]; 2], [s, t]: [&[f32]; 2]) {
    let n = distance.len();
    let (u, v, s, t) = (&u[..n], &v[..n], &s[..n], &t[..n]);
    for i in 0..n {
        let step = u[i] - s[i];
        let excess = step * step - (v[i] + v[i].min(t[i]));
        let noise = K2 * (v[i] + t[i]);
        let ratio = excess / noise;
        // without noise there are two cases only
        let exact = if step == 0.0 { 0.0 } else { FAR_APART };
        distance[i] += if noise > 0.0 { ratio } else { exact };
    }
}

/// So far apart that no patch which holds such a pixel has weight.
const FAR_APART: f32 = 1e6;

/// Sums over `2 PATCH + 1` neighbours in a row.
fn add_windows(sums: &mut [f32], values: &[f32]) {
    sums.fill(0.0);
    for k in 0..=2 * PATCH {
        let shifted = &values[k..][..sums.len()];
        sums.iter_mut().zip(shifted).for_each(|(sum, v)| *sum += v);
    }
}

/// `w = exp(-max(0, D))`, zero beyond.
fn weigh(weight: &mut [f32], patch: &[f32], scale: f32) {
    for (w, sum) in weight.iter_mut().zip(patch) {
        let d = (sum * scale).max(0.0);
        let value = exp(-d);
        *w = if d < BEYOND { value } else { 0.0 };
    }
}
