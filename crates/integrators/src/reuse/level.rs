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
/// Parts of the wavelengths, of equal probability.
const PARTS: usize = 8;

/// Radiance by part of the wavelengths, over what paths are weighed by; zero for none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
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
        // sums of L B and of B^2
        let mut sums = [[0.0; 2]; PARTS];
        for n in 0..(PATHS / number) as u32 {
            let square = grouping.square(sobol::sobol_2d(n, SEED as u32), self.resolution);
            let common: Common<8> = self.common(&square, n);
            let (mut members, origins) = self.depart((&square, grouping), (n, 0, 0), &common, |_| ());
            let mut shares = Shares::new(true);
            for (k, member) in members.iter_mut().enumerate() {
                let Some(member) = member else { continue };
                self.go_on(&yardsticks, member, (&origins, &mut links), k, &common.w, &mut shares);
            }
            for (l, b) in shares.light.iter().zip(&shares.lack).take(number) {
                for k in 0..8 {
                    let [lb, bb] = &mut sums[part::<8>(common.u, k)];
                    if l[k].is_finite() && b[k].is_finite() {
                        (*lb, *bb) = (*lb + l[k] * b[k], *bb + b[k] * b[k]);
                    }
                }
            }
        }
        Level(sums.map(|[lb, bb]| if bb > 0.0 { (-lb / bb).max(0.0) } else { 0.0 }))
    }
}
