//! Whether sharing pays, and among how many.

use super::{Grouping, MANY, SOME};
use crate::{pilot::Pilot, pixel::PixelPass};

impl PixelPass {
    /// How paths are shared, if that pays: a pure function of scene, settings and wavelengths.
    pub(crate) fn choose_grouping(&self, pilot: impl FnOnce() -> Pilot) -> Option<Grouping> {
        if !self.may_share_paths() {
            return None;
        }
        match pilot().again {
            share if share < SOME => None,
            share => Some(Grouping::new(self.resolution, share >= MANY)),
        }
    }
}
