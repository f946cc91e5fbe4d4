//! What a ray that only asks whether it is blocked notes on its way.

use crate::Hit;

/// Hits that are remembered.
const ROOM: usize = 4;
/// Hits nearer to each other than this, relative to their distance, have no certain order.
const NEAR: f32 = 1e-5;

/// Hits on the way of a ray, in no order until they are asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Notes {
    hits: [Hit; ROOM],
    /// How many there are, also of those that found no room.
    len: u32,
}

impl Notes {
    /// Most hits that are remembered.
    pub const MOST: usize = ROOM;

    /// No hit.
    pub const NONE: Self =
        Self { hits: [Hit { t: 0.0, shape: 0, prim: 0, instance: 0, u: 0.0, v: 0.0 }; ROOM], len: 0 };

    /// Whether there is none.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// One more.
    #[inline(always)]
    pub fn push(&mut self, hit: Hit) {
        let at = self.len as usize;
        if at < ROOM {
            self.hits[at] = hit;
        }
        self.len += 1;
    }

    /// Those nearer than `t`, in the order of their distances; `None` where some found no room or their order is not certain,
    /// also against `t`.
    #[inline(never)]
    pub fn in_order_before(&mut self, t: f32) -> Option<&[Hit]> {
        if self.len as usize > ROOM {
            return None;
        }
        let mut kept = 0;
        for i in 0..self.len as usize {
            let hit = self.hits[i];
            if hit.t <= t {
                self.hits[kept] = hit;
                kept += 1;
            }
        }
        self.len = kept as u32;
        let hits = self.in_order()?;
        let certain = hits.last().is_none_or(|last| t - last.t > NEAR * last.t);
        certain.then_some(hits)
    }

    /// All in the order of their distances; `None` where some found no room or their order is not certain, as at an edge
    /// that two primitives share.
    #[inline(never)]
    pub fn in_order(&mut self) -> Option<&[Hit]> {
        let n = self.len as usize;
        if n > ROOM {
            return None;
        }
        for i in 1..n {
            let hit = self.hits[i];
            let mut k = i;
            while k > 0 && self.hits[k - 1].t > hit.t {
                self.hits[k] = self.hits[k - 1];
                k -= 1;
            }
            self.hits[k] = hit;
        }
        for i in 1..n {
            if self.hits[i].t - self.hits[i - 1].t <= NEAR * self.hits[i].t {
                return None;
            }
        }
        Some(&self.hits[..n])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(t: f32) -> Hit {
        Hit { t, shape: 0, prim: t as u32, instance: 0, u: 0.0, v: 0.0 }
    }

    #[test]
    fn hits_come_in_order_where_that_is_certain() {
        let mut notes = Notes::NONE;
        assert_eq!(notes.in_order().map(<[Hit]>::len), Some(0));
        [3.0, 1.0, 2.0].into_iter().for_each(|t| notes.push(at(t)));
        let order: Vec<f32> = notes.in_order().expect("apart").iter().map(|h| h.t).collect();
        assert_eq!(order, [1.0, 2.0, 3.0]);
        notes.push(at(2.000_001));
        assert!(notes.in_order().is_none(), "two at one place");
    }

    #[test]
    fn what_lies_beyond_is_left_out() {
        let mut notes = Notes::NONE;
        [3.0, 1.0, 2.0].into_iter().for_each(|t| notes.push(at(t)));
        assert_eq!(notes.in_order_before(2.5).map(<[Hit]>::len), Some(2));
        assert_eq!(notes.in_order_before(f32::INFINITY).map(<[Hit]>::len), Some(2));
        assert!(notes.in_order_before(2.000_001).is_none(), "two at one place");
        assert_eq!(notes.in_order_before(0.5).map(<[Hit]>::len), Some(0));
    }

    #[test]
    fn more_than_there_is_room_for_is_told() {
        let mut notes = Notes::NONE;
        (0..5).for_each(|i| notes.push(at(1.0 + i as f32)));
        assert!(notes.in_order().is_none() && !notes.is_empty());
    }
}
