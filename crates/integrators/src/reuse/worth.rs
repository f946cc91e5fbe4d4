//! What links would bring: a few squares are tried before the picture.

use super::{Grouping, join::Yardsticks};
use crate::{pixel::PixelPass, reuse::depart::Common, settings::Lengths};
use tyndall_base::sobol;

/// Squares that are tried.
const SQUARES: u32 = 32;
/// The same for all seeds of a picture.
const SEED: u64 = 0x6c69_6e6b;

/// Means over the points that would be shared.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Worth {
    /// The part that the own path has in the density of a point: one over those who really share.
    pub own: f32,
    /// Squared error of coarse lengths, as what it does to that density.
    pub wrong: f32,
}

impl PixelPass {
    /// Tries `grouping` with weights of such lengths: a pure function of scene, settings, wavelengths and the size of the image.
    pub(super) fn worth(&self, grouping: Grouping, weigh: Lengths) -> Worth {
        Self { seed: SEED, ..self.clone() }.links(grouping, weigh)
    }

    /// The same with the seed of the pass.
    #[inline(never)]
    fn links(&self, grouping: Grouping, weigh: Lengths) -> Worth {
        let yardsticks = Yardsticks::of(&self.scene, &self.settings, weigh);
        let mut links = Vec::with_capacity(grouping.members());
        let (mut worth, mut points) = (Worth::default(), 0.0);
        for n in 0..SQUARES {
            let square = grouping.square(sobol::sobol_2d(n, self.seed as u32), self.resolution);
            let common: Common<8> = self.common(&square, n);
            let (mut members, origins) = self.depart((&square, grouping), (n, 0, 0), &common, |_| ());
            for (k, member) in members.iter_mut().enumerate() {
                let Some(member) = member else { continue };
                let company = self.company(&yardsticks, (&origins, &mut links), k, member, &common.w);
                if let Some([own, skew]) = company.map(|company| company.own()) {
                    points += 1.0;
                    worth.own += own;
                    worth.wrong += (skew - 1.0).powi(2);
                }
            }
        }
        Worth { own: worth.own / points, wrong: worth.wrong / points }
    }
}
