//! Planes that no ray of a fan crosses.
//!
//! All rays start in one box and end in another. A triangle whose plane has both boxes on the same side is met by none, and
//! four are told at once. With the corners a, b, c, a box of centre m and half extents r is on one side for certain where
//!
//! ```text
//! |n . v| > |n| . r + 2^-19 A sum (|v| + r + L),   v = m - a,   n = (b - a) x (c - a)
//! ```
//!
//! with `|n|` by axis, `A` the products of `n` added without their signs, `L` the extents of both edges, and the sum over axes
//! and both boxes: the margin is more than all roundings here (some ten times 2^-24 of the sum) and than what the edge test may
//! be off (`triangle.rs`: a share of the distance from the start), so that a ray by itself would meet none of the triangles
//! left out either.

use super::bundle::{GROUP, Group};
use super::lanes::Lanes;
use super::node::Block;

/// Share of its terms that a sum has to differ from zero by: 32 half-ulps.
const MARGIN: f32 = 32.0 / (1u32 << 24) as f32;

/// Boxes around the starts of rays and around their ends: centres and half extents by axis.
pub(super) struct Hull<L: Lanes> {
    boxes: [[[L::F4; 3]; 2]; 2],
}

impl<L: Lanes> Hull<L> {
    /// Around the rays of both groups.
    #[inline(always)]
    pub fn new(l: L, groups: [&Group<L>; 2]) -> Self {
        let [g, h] = groups;
        Self { boxes: [around(l, g.starts(), h.starts()), around(l, g.ends(l), h.ends(l))] }
    }

    /// The triangles of `block`, bit by bit, whose plane some ray may cross.
    #[inline(always)]
    pub fn crosses(&self, l: L, block: &Block) -> u32 {
        let abs = |x: L::F4| l.max4(x, l.sub4(l.splat4(0.0), x));
        let corner = |c: usize, k: usize| l.load4(&block.corner[c][k]);
        let zero = l.splat4(0.0);
        let (mut e, mut f, mut extent) = ([zero; 3], [zero; 3], [zero; 3]);
        for k in 0..3 {
            e[k] = l.sub4(corner(1, k), corner(0, k));
            f[k] = l.sub4(corner(2, k), corner(0, k));
            extent[k] = l.add4(abs(e[k]), abs(f[k]));
        }
        let (mut n, mut products) = ([zero; 3], [zero; 3]);
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let (p, q) = (l.mul4(e[i], f[j]), l.mul4(e[j], f[i]));
            (n[k], products[k]) = (l.sub4(p, q), l.add4(abs(p), abs(q)));
        }
        // along every axis: the edge test mixes them
        let size = l.add4(products[0], l.add4(products[1], products[2]));
        // the edge test may be off by a share of the way from the start, so that both ends count for the margin of each
        let (mut height, mut reach, mut all) = ([zero; 2], [zero; 2], zero);
        for b in 0..2 {
            let [centre, half] = &self.boxes[b];
            for k in 0..3 {
                let v = l.sub4(centre[k], corner(0, k));
                height[b] = l.add4(height[b], l.mul4(n[k], v));
                reach[b] = l.add4(reach[b], l.mul4(abs(n[k]), half[k]));
                all = l.add4(all, l.mul4(size, l.add4(l.add4(abs(v), half[k]), extent[k])));
            }
        }
        let (mut above, mut below) = (0xf, 0xf);
        for b in 0..2 {
            let bound = l.add4(reach[b], l.mul4(all, l.splat4(MARGIN)));
            // NaN is on neither side
            above &= l.le4(bound, height[b]);
            below &= l.le4(bound, l.sub4(zero, height[b]));
        }
        !(above | below) & 0xf
    }
}

/// Centre and half extents of the box around points.
#[inline(always)]
fn around<L: Lanes>(l: L, p: [L::F8; 3], q: [L::F8; 3]) -> [[L::F4; 3]; 2] {
    let mut b = [[l.splat4(0.0); 3]; 2];
    for k in 0..3 {
        let (lo, hi) = (l.range8(l.min8(p[k], q[k])).0, l.range8(l.max8(p[k], q[k])).1);
        (b[0][k], b[1][k]) = (l.splat4(0.5 * (lo + hi)), l.splat4(0.5 * (hi - lo)));
    }
    b
}

const _: () = assert!(GROUP == 8, "ranges are over eight lanes");
