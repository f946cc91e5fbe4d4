//! Bounds of a density over boxes of space, and the walk of a ray through them.
//!
//! A pyramid of greatest and least densities over cells: level 0 holds the finest, each level above it twice the
//! edge. Cells that are thin, nearly even or empty are walked whole, so that a step costs about as much as it saves
//! (the structure of Szirmay-Kalos et al. 2011, *Free path sampling in high resolution inhomogeneous participating
//! media*, with the level chosen by optical thickness).

use super::density::Extrema;
use tyndall_base::{Vec3, vec::vec3};
use tyndall_geometry::Bounds3;

/// Null collisions, as optical depth, that a walk accepts to save one step: looking a density up costs about three
/// steps.
const SPARED: f32 = 0.3;
/// Cells of the finest level at most; beyond that they double their edge.
const MOST_CELLS: usize = 1 << 24;

/// Cells of one edge length.
#[derive(Clone, Debug)]
struct Level {
    dims: [usize; 3],
    cells: Vec<Extrema>,
}

impl Level {
    #[inline(always)]
    fn at(&self, c: [usize; 3]) -> Extrema {
        self.cells[(c[2] * self.dims[1] + c[1]) * self.dims[0] + c[0]]
    }
}

/// See the module. All points are in the space of the grid.
#[derive(Clone, Debug)]
pub struct Majorants {
    bounds: Bounds3,
    origin: Vec3,
    edge: Vec3,
    levels: Vec<Level>,
    /// For each finest cell the level at which it is walked.
    walked: Vec<u8>,
}

/// The cells to make: where the first one starts, the edges, how many.
#[derive(Clone, Copy, Debug)]
pub struct Cells {
    /// Corner of the first cell.
    pub origin: Vec3,
    /// Edges of a cell.
    pub edge: Vec3,
    /// Cells along each axis.
    pub dims: [usize; 3],
}

impl Cells {
    /// Cells with doubled edges until there are few enough.
    #[must_use]
    pub fn bounded(mut self) -> Self {
        while self.dims.iter().product::<usize>() > MOST_CELLS {
            self.edge = self.edge * 2.0;
            self.dims = self.dims.map(|n| n.div_ceil(2));
        }
        self
    }
}

/// A stretch of a ray with bounds of the density on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// Where it ends; it begins where the one before it ended.
    pub t1: f32,
    /// Greatest density.
    pub max: f32,
    /// Least density.
    pub min: f32,
}

impl Majorants {
    /// `extrema` bounds the density over a box; `thickness` is the optical depth of density 1 along the unit of the
    /// grid's space; `scale` >= 1 widens the greatest (for tests of invariance).
    pub fn new(
        bounds: Bounds3,
        cells: Cells,
        thickness: f32,
        scale: f32,
        extrema: impl Fn(Bounds3) -> Extrema,
    ) -> Self {
        let Cells { origin, edge, dims } = cells.bounded();
        let mut finest = Vec::with_capacity(dims.iter().product());
        for z in 0..dims[2] {
            for y in 0..dims[1] {
                for x in 0..dims[0] {
                    let lo = origin + edge.hadamard(vec3(x as f32, y as f32, z as f32));
                    let e = extrema(Bounds3::new(lo, lo + edge));
                    // the factor covers the rounding of interpolation
                    finest.push(Extrema { max: e.max * (scale * (1.0 + 1e-5)), min: e.min * (1.0 - 1e-5) });
                }
            }
        }
        let mut levels = vec![Level { dims, cells: finest }];
        while let Some(top) = levels.last().filter(|l| l.dims.iter().any(|&n| n > 1)) {
            levels.push(coarser(top));
        }
        let walked = choose(&levels, edge.max_component() * thickness);
        Self { bounds, origin, edge, levels, walked }
    }

    /// Where the density may differ from that outside.
    pub fn bounds(&self) -> Bounds3 {
        self.bounds
    }

    /// The greatest density anywhere.
    pub fn max(&self) -> f32 {
        self.levels.last().map_or(0.0, |l| l.cells[0].max)
    }

    /// The bounds that a walk has at the point `p` of the box.
    #[inline]
    pub fn at(&self, p: Vec3) -> Extrema {
        let dims = self.levels[0].dims;
        let v = p - self.origin;
        let mut cell = [0; 3];
        for k in 0..3 {
            cell[k] = ((v[k] / self.edge[k]).max(0.0) as usize).min(dims[k] - 1);
        }
        let level = usize::from(self.walked[self.index(cell)]);
        self.levels[level].at(cell.map(|c| c >> level))
    }

    /// Walks the ray `o + t d`, `t` in \[0, t_max\].
    #[inline]
    pub fn walk(&self, o: Vec3, d: Vec3, t_max: f32) -> Walker<'_> {
        let to_cells = |v: Vec3| vec3(v.x / self.edge.x, v.y / self.edge.y, v.z / self.edge.z);
        let (o_cell, d_cell) = (to_cells(o - self.origin), to_cells(d));
        let inverse = vec3(1.0 / d_cell.x, 1.0 / d_cell.y, 1.0 / d_cell.z);
        let (t0, t1) = self.bounds.clip(o, d, t_max).unwrap_or((0.0, -1.0));
        let p = o_cell + d_cell * t0;
        let dims = self.levels[0].dims;
        let cell = std::array::from_fn(|k| (p[k].max(0.0) as usize).min(dims[k] - 1));
        Walker { majorants: self, o: o_cell, d: d_cell, inverse, cell, t: t0, t_out: t1 }
    }

    /// Place of a finest cell in the tables.
    #[inline(always)]
    fn index(&self, c: [usize; 3]) -> usize {
        let dims = self.levels[0].dims;
        (c[2] * dims[1] + c[1]) * dims[0] + c[0]
    }
}

/// Pairs of cells along every axis become one.
fn coarser(fine: &Level) -> Level {
    let dims = fine.dims.map(|n| n.div_ceil(2));
    let mut cells = vec![Extrema::NONE; dims.iter().product()];
    for z in 0..fine.dims[2] {
        for y in 0..fine.dims[1] {
            for x in 0..fine.dims[0] {
                let up = ((z / 2) * dims[1] + y / 2) * dims[0] + x / 2;
                cells[up] = cells[up].union(fine.at([x, y, z]));
            }
        }
    }
    Level { dims, cells }
}

/// The level of every finest cell; `thickness` is the optical depth of density 1 across it.
fn choose(levels: &[Level], thickness: f32) -> Vec<u8> {
    // bottom up: cells whose children are walked whole and would spare a step as one
    let mut whole: Vec<Vec<bool>> = vec![vec![true; levels[0].cells.len()]];
    for (l, pair) in levels.windows(2).enumerate() {
        let (fine, coarse) = (&pair[0], &pair[1]);
        let mut all = vec![true; coarse.cells.len()];
        let mut sum = vec![[0.0f32; 2]; coarse.cells.len()];
        for z in 0..fine.dims[2] {
            for y in 0..fine.dims[1] {
                for x in 0..fine.dims[0] {
                    let i = (z * fine.dims[1] + y) * fine.dims[0] + x;
                    let up = ((z / 2) * coarse.dims[1] + y / 2) * coarse.dims[0] + x / 2;
                    all[up] &= whole[l][i];
                    sum[up][0] += fine.cells[i].max;
                    sum[up][1] += 1.0;
                }
            }
        }
        let edge = thickness * (2u64 << l) as f32;
        let spared = |i: usize| edge * (coarse.cells[i].max - sum[i][0] / sum[i][1]) <= SPARED;
        whole.push((0..all.len()).map(|i| all[i] && spared(i)).collect());
    }
    let dims = levels[0].dims;
    let mut out = Vec::with_capacity(levels[0].cells.len());
    for z in 0..dims[2] {
        for y in 0..dims[1] {
            for x in 0..dims[0] {
                let at = |l: usize| {
                    let n = levels[l].dims;
                    whole[l][((z >> l) * n[1] + (y >> l)) * n[0] + (x >> l)]
                };
                out.push((1..levels.len()).take_while(|&l| at(l)).count() as u8);
            }
        }
    }
    out
}

/// A ray on its way through the cells.
#[derive(Clone, Debug)]
pub struct Walker<'m> {
    majorants: &'m Majorants,
    o: Vec3,
    d: Vec3,
    inverse: Vec3,
    cell: [usize; 3],
    t: f32,
    /// Where the ray leaves the box; before `t` when nothing is left.
    t_out: f32,
}

impl Walker<'_> {
    /// Where the first stretch begins: nothing lies before.
    #[inline(always)]
    pub fn start(&self) -> f32 {
        self.t
    }

    /// The next stretch; `None` where nothing is left.
    #[inline(always)]
    pub fn step(&mut self) -> Option<Stretch> {
        if self.t_out < self.t {
            return None;
        }
        let m = self.majorants;
        let level = usize::from(m.walked[m.index(self.cell)]);
        let big = self.cell.map(|c| c >> level);
        let e = m.levels[level].at(big);
        // the nearest of the three faces through which the ray leaves
        let (mut axis, mut t1) = (0, f32::INFINITY);
        for k in 0..3 {
            let face = if self.d[k] > 0.0 { (big[k] + 1) << level } else { big[k] << level };
            let t = (face as f32 - self.o[k]) * self.inverse[k];
            if self.d[k] != 0.0 && t < t1 {
                (axis, t1) = (k, t);
            }
        }
        if t1 >= self.t_out || !self.enter(axis, big, level, t1) {
            t1 = self.t_out;
            self.t_out = -1.0;
        }
        let t1 = t1.max(self.t);
        self.t = t1;
        Some(Stretch { t1, max: e.max, min: e.min })
    }

    /// Moves to the cell behind the face of `axis`; false outside the grid.
    #[inline(always)]
    fn enter(&mut self, axis: usize, big: [usize; 3], level: usize, t: f32) -> bool {
        let dims = self.majorants.levels[0].dims;
        for k in 0..3 {
            let (lo, hi) = (big[k] << level, (((big[k] + 1) << level) - 1).min(dims[k] - 1));
            if k != axis {
                let p = self.o[k] + self.d[k] * t;
                self.cell[k] = (p.max(0.0) as usize).clamp(lo, hi);
            } else if self.d[k] > 0.0 {
                self.cell[k] = hi + 1;
            } else {
                let Some(below) = lo.checked_sub(1) else { return false };
                self.cell[k] = below;
            }
        }
        self.cell[axis] < dims[axis]
    }
}
