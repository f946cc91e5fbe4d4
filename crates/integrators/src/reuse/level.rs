//! What shared points send back on average: a control variate.
//!
//! The parts `w_ik` of the shared points `y_k` in pixel i add up to the weight `w_i` that the pixel's own path has there: on
//! average, not in each group. Light that all points have in common need not suffer from that. With its level `c`, known
//! before the picture,
//!
//! ```text
//! L_i = sum_k w_ik S(y_k) + c B_i,    B_i = w_i - sum_k w_ik
//! ```
//!
//! has the same mean for every `c`, since that of `B_i` is zero, and the least variance for `c = -Cov(L_i, B_i) / Var(B_i)`. A few
//! groups are tried for that; near zero where points differ much, as under a lamp, it is most of the light under a sky.

use super::{Grouping, group::Shares, join::Yardsticks};
use crate::{pixel::PixelPass, reuse::depart::Common, settings::Lengths};
use tyndall_base::sobol;
use tyndall_spectral::Spectrum;

/// Paths that are tried.
const PATHS: usize = 512;
/// Their seed, the same for all seeds of a picture.
const SEED: u64 = 0x006c_6576_656c;
/// The part of what varies in a square that a level has to explain: summing up `B` costs about this much time.
const WORTH: f64 = 0.02;
/// Parts of the wavelengths, of equal probability.
const PARTS: usize = 8;

/// Radiance by part of the wavelengths, over what paths are weighed by; zero for none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level([f32; PARTS]);

impl Level {
    /// Nothing in common.
    pub const NONE: Self = Self([0.0; PARTS]);

    /// At wavelengths that were drawn by `u`.
    #[inline(always)]
    pub(super) fn at<const N: usize>(&self, u: f32) -> Spectrum<N> {
        Spectrum::from_fn(|k| self.0[part::<N>(u, k)])
    }
}

/// The part that the wavelength of lane `k` lies in, where lane 0 was drawn by `u`.
#[inline(always)]
fn part<const N: usize>(u: f32, k: usize) -> usize {
    ((u + k as f32 / N as f32) * PARTS as f32) as usize % PARTS
}

impl PixelPass {
    /// The level where paths are shared: a pure function of scene, settings, wavelengths and the size of the image.
    pub fn find_level(&self) -> Level {
        match self.grouping {
            Some(grouping) if self.settings.level => Self { seed: SEED, ..self.clone() }.regress(grouping),
            _ => Level::NONE,
        }
    }

    /// The same with the seed of the pass.
    #[inline(never)]
    fn regress(&self, grouping: Grouping) -> Level {
        let yardsticks = Yardsticks::of(&self.scene, &self.settings, Lengths::Coarse);
        let number = grouping.members();
        let mut links = Vec::with_capacity(number);
        let mut squares = Vec::with_capacity(PATHS / number);
        for n in 0..(PATHS / number) as u32 {
            let square = grouping.square(sobol::sobol_2d(n, SEED as u32), self.resolution);
            let common: Common<8> = self.common(&square, n);
            let (mut members, origins) = self.depart((&square, grouping), (n, 0, 0), &common, |_| ());
            let (mut shares, mut sums) = (Shares::new(true), [Sums::default(); PARTS]);
            for (k, member) in members.iter_mut().enumerate() {
                let Some(member) = member else { continue };
                self.go_on(&yardsticks, member, (&origins, &mut links), k, &common.w, &mut shares);
            }
            for i in (0..number).filter(|&i| members[i].is_some()) {
                for k in 0..8 {
                    sums[part::<8>(common.u, k)].add(shares.light[i][k], shares.lack[i][k]);
                }
            }
            squares.push(sums);
        }
        level(&squares)
    }
}

/// Sums over the pixels of a square, in one part of the wavelengths.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    n: f64,
    l: f64,
    ll: f64,
    lb: f64,
    bb: f64,
}

impl Sums {
    fn add(&mut self, l: f32, b: f32) {
        let (l, b) = (f64::from(l), f64::from(b));
        if l.is_finite() && b.is_finite() {
            let Self { n, l: sum, ll, lb, bb } = *self;
            *self = Self { n: n + 1.0, l: sum + l, ll: ll + l * l, lb: lb + l * b, bb: bb + b * b };
        }
    }

    /// `sum (L - mean)^2` over the square.
    fn variation(&self) -> f64 {
        if self.n > 0.0 { self.ll - self.l * self.l / self.n } else { 0.0 }
    }
}

/// The level that squares tell of; none where it explains too little of what varies.
fn level(squares: &[[Sums; PARTS]]) -> Level {
    let (mut level, mut explained, mut all) = (Level::NONE, 0.0, 0.0);
    for (k, level) in level.0.iter_mut().enumerate() {
        let part: Vec<Sums> = squares.iter().map(|square| square[k]).collect();
        let c = slope(&part);
        explained -= c * part.iter().map(|s| s.lb).sum::<f64>();
        all += part.iter().map(Sums::variation).sum::<f64>();
        *level = c as f32;
    }
    if explained > WORTH * all { level } else { Level::NONE }
}

/// `c = -sum L B / sum B^2`, less by what its own error makes of it: `c (1 - se^2 / c^2)`, and never negative.
fn slope(squares: &[Sums]) -> f64 {
    let sum = |of: fn(&Sums) -> f64| squares.iter().map(of).sum::<f64>();
    let (bb, n) = (sum(|s| s.bb), squares.len() as f64);
    let c = -sum(|s| s.lb) / bb;
    // the error of a ratio, from what each square is off
    let off: f64 = squares.iter().map(|s| (s.lb + c * s.bb).powi(2)).sum();
    let square_of_error = off / (bb * bb) * n / (n - 1.0);
    let shrunk = c - square_of_error / c;
    // not for what is no number
    if c > 0.0 && shrunk > 0.0 { shrunk } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_testkit::Rng;

    /// 32 squares of 16 pixels with `L = 1 - c B + noise`.
    fn squares(rng: &mut Rng, c: f32, noise: f32) -> Vec<[Sums; PARTS]> {
        let mut even = |width: f32| width * (2.0 * rng.f32() - 1.0);
        let mut sums = || {
            let mut sums = Sums::default();
            for _ in 0..16 {
                let b = even(1.0);
                sums.add(1.0 - c * b + even(noise), b);
            }
            sums
        };
        (0..32).map(|_| std::array::from_fn(|_| sums())).collect()
    }

    #[test]
    fn the_level_is_found_and_noise_is_none() {
        let rng = &mut Rng::new(4);
        // the error of a part is about ((1 + noise^2 / 3) / (512 / 3))^(1/2) = 0.08
        for _ in 0..20 {
            for c in level(&squares(rng, 2.0, 0.2)).0 {
                assert!((c - 2.0).abs() < 0.4, "{c}");
            }
            assert_eq!(level(&squares(rng, 0.0, 3.0)), Level::NONE);
            assert_eq!(level(&squares(rng, -2.0, 0.2)), Level::NONE);
        }
        assert_eq!(level(&[[Sums::default(); PARTS]; 4]), Level::NONE);
        assert_eq!(level(&[]), Level::NONE);
    }
}
