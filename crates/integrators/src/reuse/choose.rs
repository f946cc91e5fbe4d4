//! Whether sharing pays, and among how many.

use super::{Grouping, MANY, OWN, SOME, WRONG, join::varies};
use crate::{pilot::Pilot, pixel::PixelPass, settings::Lengths};

impl PixelPass {
    /// How paths are shared, if that pays: a pure function of scene, settings and wavelengths.
    pub(crate) fn choose_grouping(&self, pilot: impl FnOnce() -> Pilot) -> Option<Grouping> {
        if !self.may_share_paths() {
            return None;
        }
        let grouping = match pilot().again {
            share if share < SOME => return None,
            share => Grouping::new(self.resolution, share >= MANY),
        };
        // in a dense cloud a pixel is wide: its neighbours lie beyond the reach of what its paths find
        let pays = || {
            let own = self.worth(grouping, Lengths::Exact).own;
            // not where no point is shared at all
            own < OWN && self.worth(grouping, Lengths::Coarse).wrong < WRONG
        };
        (!varies(&self.scene) || pays()).then_some(grouping)
    }
}
