//! The seam between light transport and all the ways of running it: units of work, and passes that render them.

use std::ops::Range;

use crate::{Guide, Patch};

/// A rectangle of pixels, half open: `x0 <= x < x1`, `y0 <= y < y1`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub struct PixelBounds {
    /// First column.
    pub x0: u32,
    /// First row.
    pub y0: u32,
    /// One past the last column.
    pub x1: u32,
    /// One past the last row.
    pub y1: u32,
}

impl PixelBounds {
    /// The rectangle `[x0, x1) x [y0, y1)`.
    pub const fn new(x0: u32, y0: u32, x1: u32, y1: u32) -> Self {
        Self { x0, y0, x1, y1 }
    }

    /// Number of columns, 0 when empty.
    #[inline(always)]
    pub const fn width(&self) -> u32 {
        self.x1.saturating_sub(self.x0)
    }

    /// Number of rows, 0 when empty.
    #[inline(always)]
    pub const fn height(&self) -> u32 {
        self.y1.saturating_sub(self.y0)
    }

    /// Number of pixels.
    #[inline]
    pub const fn area(&self) -> u64 {
        self.width() as u64 * self.height() as u64
    }

    /// True when the pixel lies inside.
    #[inline(always)]
    pub const fn contains(&self, x: u32, y: u32) -> bool {
        x >= self.x0 && x < self.x1 && y >= self.y0 && y < self.y1
    }

    /// True when `inner` lies wholly inside.
    pub const fn encloses(&self, inner: &Self) -> bool {
        inner.x0 >= self.x0 && inner.y0 >= self.y0 && inner.x1 <= self.x1 && inner.y1 <= self.y1
    }

    /// What both hold; empty when they do not meet.
    pub const fn intersection(&self, other: &Self) -> Self {
        const fn least(a: u32, b: u32) -> u32 {
            if a < b { a } else { b }
        }
        const fn most(a: u32, b: u32) -> u32 {
            if a > b { a } else { b }
        }
        Self {
            x0: most(self.x0, other.x0),
            y0: most(self.y0, other.y0),
            x1: least(self.x1, other.x1),
            y1: least(self.y1, other.y1),
        }
    }

    /// Row-major index of a pixel inside.
    #[inline(always)]
    pub const fn index(&self, x: u32, y: u32) -> usize {
        (y - self.y0) as usize * self.width() as usize + (x - self.x0) as usize
    }

    /// Pixels in row-major order.
    pub fn pixels(self) -> impl Iterator<Item = (u32, u32)> {
        (self.y0..self.y1).flat_map(move |y| (self.x0..self.x1).map(move |x| (x, y)))
    }

    /// Tiles of at most `size` x `size` pixels in row-major order, cut from the upper left corner.
    pub fn tiles(self, size: u32) -> impl Iterator<Item = PixelBounds> {
        let size = size.max(1) as usize;
        (self.y0..self.y1).step_by(size).flat_map(move |y| {
            (self.x0..self.x1).step_by(size).map(move |x| PixelBounds {
                x0: x,
                y0: y,
                x1: x.saturating_add(size as u32).min(self.x1),
                y1: y.saturating_add(size as u32).min(self.y1),
            })
        })
    }
}

/// A window of pixels and a range of sample indices.
///
/// With the job and the [`Guide`] it determines its [`Patch`] completely.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct WorkUnit {
    /// Pixels.
    pub window: PixelBounds,
    /// Indices of the samples of every pixel; a guide may leave out some of them, see [`Guide::samples_for`].
    pub samples: Range<u32>,
    /// Round of the schedule that the unit belongs to.
    pub round: u32,
}

/// Renders units of work: a pure function of (what it was prepared from, guide, unit) to an additive patch.
pub trait Pass: Send + Sync {
    /// Adds the samples of `unit` to `out`, which is empty and has the unit's window.
    fn render(&self, unit: &WorkUnit, guide: &Guide, out: &mut Patch);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_every_pixel_once() {
        let b = PixelBounds::new(3, 5, 40, 22);
        let mut seen = vec![0; b.area() as usize];
        for t in b.tiles(16) {
            assert!(b.encloses(&t) && t.area() > 0);
            t.pixels().for_each(|(x, y)| seen[b.index(x, y)] += 1);
        }
        assert!(seen.iter().all(|&n| n == 1));
        assert_eq!(b.pixels().count() as u64, b.area());
    }

    #[test]
    fn an_inverted_window_is_empty() {
        let b = PixelBounds::new(4, 4, 2, 9);
        assert_eq!((b.area(), b.pixels().count(), b.tiles(8).count()), (0, 0, 0));
    }
}
