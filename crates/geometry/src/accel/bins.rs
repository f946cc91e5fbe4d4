//! Binned surface area heuristic: where to cut a set of references.

use super::build::{OTHER_COST, PARALLEL, Ref};
use super::node::LANES;
use crate::Bounds3;
use rayon::prelude::*;

/// A splitting plane: bins below `at` go left.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    axis: usize,
    pub at: usize,
    pub cost: f32,
    low: f32,
    scale: f32,
    last: usize,
}

impl Plane {
    #[inline(always)]
    pub fn bin(&self, r: &Ref) -> usize {
        (((r.middle()[self.axis] - self.low) * self.scale) as usize).min(self.last)
    }
}

/// One bin: box and counts.
#[derive(Clone, Copy)]
struct Bin {
    bounds: Bounds3,
    triangles: u32,
    others: u32,
}

/// By axis.
type Bins<const N: usize> = [[Bin; N]; 3];

const EMPTY_BIN: Bin = Bin { bounds: Bounds3::EMPTY, triangles: 0, others: 0 };

impl Bin {
    fn union(self, b: Self) -> Self {
        Self {
            bounds: self.bounds.union(b.bounds),
            triangles: self.triangles + b.triangles,
            others: self.others + b.others,
        }
    }

    fn is_empty(&self) -> bool {
        self.triangles + self.others == 0
    }

    fn cost(&self) -> f32 {
        let work = self.triangles.div_ceil(LANES as u32) + OTHER_COST * self.others;
        self.bounds.half_area() * work as f32
    }
}

/// The cheapest of the planes between bins on the three axes; `None` when all centres coincide.
pub(super) fn best_plane(refs: &[Ref], middles: Bounds3) -> Option<Plane> {
    // fine bins pay where a cut decides about many
    match refs.len() {
        0..64 => best::<16>(refs, middles),
        64..PARALLEL => best::<32>(refs, middles),
        _ => best::<64>(refs, middles),
    }
}

fn best<const N: usize>(refs: &[Ref], middles: Bounds3) -> Option<Plane> {
    let extent = middles.hi - middles.lo;
    let axis = |k: usize| {
        let scale = if extent[k] > 0.0 { N as f32 * 0.999_99 / extent[k] } else { 0.0 };
        // centres closer than an f32 can scale apart count as one
        let scale = if scale.is_finite() { scale } else { 0.0 };
        Plane { axis: k, at: 0, cost: f32::INFINITY, low: middles.lo[k], scale, last: N - 1 }
    };
    let axes = [axis(0), axis(1), axis(2)];
    let filled = fill::<N>(refs, &axes);
    let usable = axes.into_iter().filter(|p| p.scale > 0.0);
    let best = usable.map(|p| cheapest(p, &filled[p.axis])).min_by(|a, b| a.cost.total_cmp(&b.cost))?;
    (best.at > 0).then_some(best)
}

fn fill<const N: usize>(refs: &[Ref], axes: &[Plane; 3]) -> Bins<N> {
    let empty = [[EMPTY_BIN; N]; 3];
    let some = |mut bins: Bins<N>, refs: &[Ref]| {
        for r in refs {
            let triangle = u32::from(r.is_triangle());
            for (plane, row) in axes.iter().zip(&mut bins) {
                let bin = &mut row[plane.bin(r)];
                bin.bounds = bin.bounds.union(r.bounds);
                bin.triangles += triangle;
                bin.others += 1 - triangle;
            }
        }
        bins
    };
    if refs.len() < PARALLEL {
        return some(empty, refs);
    }
    let merge =
        |a: Bins<N>, b: Bins<N>| std::array::from_fn(|k| std::array::from_fn(|i| a[k][i].union(b[k][i])));
    refs.par_chunks(PARALLEL).map(|c| some(empty, c)).reduce(|| empty, merge)
}

fn cheapest<const N: usize>(mut plane: Plane, row: &[Bin; N]) -> Plane {
    let mut right = [EMPTY_BIN; N];
    let mut sum = EMPTY_BIN;
    for k in (1..N).rev() {
        sum = sum.union(row[k]);
        right[k] = sum;
    }
    let mut left = EMPTY_BIN;
    for k in 1..N {
        left = left.union(row[k - 1]);
        if left.is_empty() || right[k].is_empty() {
            continue;
        }
        let cost = left.cost() + right[k].cost();
        if cost < plane.cost {
            (plane.cost, plane.at) = (cost, k);
        }
    }
    plane
}
