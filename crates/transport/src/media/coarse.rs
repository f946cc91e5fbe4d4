//! Coarse means of a density: lengths of rays by a few looks, close to the true ones.

use super::{density::Density, majorant::Majorants};
use tyndall_base::{Vec3, vec::vec3};

/// Cells along the longest axis, at most.
const MOST: f32 = 128.0;
/// Positions are whole numbers of this part of a cell, as a power of two: a look takes three additions and no rounding.
const PART: i32 = 16;

/// See the module. Points are in the space of the grid.
#[derive(Clone, Debug)]
pub(super) struct Coarse {
    /// The corner of the first cell, which lies beyond the bounds: rounding does not lead out of the cells.
    origin: Vec3,
    /// Cells per unit.
    per_unit: f32,
    row: i32,
    layer: i32,
    cells: Vec<f32>,
}

impl Coarse {
    /// Means of `density`, which `majorants` bound.
    pub fn new(majorants: &Majorants, density: &impl Density) -> Self {
        let b = majorants.bounds();
        let size = b.hi - b.lo;
        let edge = density.detail().max(size.max_component() / MOST);
        // one look for a voxel; at greater cells two along each axis
        let looks = if edge > density.detail() { 2 } else { 1 };
        let origin = b.lo - Vec3::splat(edge);
        let dims: [usize; 3] = std::array::from_fn(|k| ((size[k] / edge).ceil() as usize).max(1) + 2);
        let mut cells = Vec::with_capacity(dims.iter().product());
        let at = |i: usize, look: usize| (i as f32 + (look as f32 + 0.5) / looks as f32) * edge;
        for z in 0..dims[2] {
            for y in 0..dims[1] {
                for x in 0..dims[0] {
                    let mut sum = 0.0;
                    for look in 0..looks * looks * looks {
                        let (i, j, k) = (look % looks, look / looks % looks, look / (looks * looks));
                        let p = origin + vec3(at(x, i), at(y, j), at(z, k));
                        if b.contains(p) && majorants.at(p).max > 0.0 {
                            sum += density.at(p);
                        }
                    }
                    cells.push(sum / (looks * looks * looks) as f32);
                }
            }
        }
        let (row, layer) = (dims[0] as i32, (dims[0] * dims[1]) as i32);
        Self { origin, per_unit: 1.0 / edge, row, layer, cells }
    }

    /// The sum of means along the ray `o + t d` from `t0` to `t1`, which lies in the bounds.
    #[inline(always)]
    pub fn length(&self, o: Vec3, d: Vec3, [t0, t1]: [f32; 2]) -> f32 {
        if t1 <= t0 {
            return 0.0;
        }
        let d = d * self.per_unit;
        let looks = ((t1 - t0) * d.length()) as i32 + 1;
        let dt = (t1 - t0) / looks as f32;
        let fixed = |v: Vec3| [v.x, v.y, v.z].map(|x| (x * (1 << PART) as f32) as i32);
        let [mut x, mut y, mut z] = fixed((o - self.origin) * self.per_unit + d * (t0 + 0.5 * dt));
        let [dx, dy, dz] = fixed(d * dt);
        let mut sum = 0.0;
        for _ in 0..looks {
            let at = (z >> PART) * self.layer + (y >> PART) * self.row + (x >> PART);
            // outside by rounding: nothing
            sum += self.cells.get(at as usize).copied().unwrap_or(0.0);
            (x, y, z) = (x.wrapping_add(dx), y.wrapping_add(dy), z.wrapping_add(dz));
        }
        sum * dt
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::media::{Dense, Edge};
    use tyndall_testkit::Rng;

    const N: usize = 10;

    fn coarse(edge: Edge, value: impl Fn(f32) -> f32) -> (Coarse, Majorants) {
        let values: Vec<f32> = (0..N * N * N).map(|i| value((i % N) as f32 + 0.5)).collect();
        let density = Dense::new([N; 3], &values, edge).expect("a grid");
        let majorants = Majorants::new(density.bounds(), density.cells(), 1.0, 1.0, |b| density.extrema(b));
        (Coarse::new(&majorants, &density), majorants)
    }

    /// Rays between points in and around the grid, with what of them lies in it.
    fn rays(majorants: &Majorants, mut check: impl FnMut(Vec3, Vec3, [f32; 2])) {
        let rng = &mut Rng::new(3);
        let mut met = 0;
        for _ in 0..2000 {
            let mut point = || vec3(rng.f32(), rng.f32(), rng.f32()) * 14.0 - Vec3::splat(2.0);
            let (o, d) = (point(), point());
            let d = d - o;
            if let Some((t0, t1)) = majorants.bounds().clip(o, d, 1.0) {
                met += 1;
                check(o, d, [t0, t1]);
            }
        }
        assert!(met > 1000, "{met}");
    }

    #[test]
    fn lengths_through_an_even_grid_are_exact() {
        let (coarse, majorants) = coarse(Edge::Clamp, |_| 2.5);
        rays(&majorants, |o, d, [t0, t1]| {
            let length = coarse.length(o, d, [t0, t1]);
            assert!((length - 2.5 * (t1 - t0)).abs() < 1e-5, "{length} {}", 2.5 * (t1 - t0));
        });
    }

    /// The density rises along x; a look is at most half a cell off in each direction.
    #[test]
    fn lengths_through_a_slope_are_close() {
        let (coarse, majorants) = coarse(Edge::Clamp, |x| x);
        rays(&majorants, |o, d, [t0, t1]| {
            let middle = (o + d * (0.5 * (t0 + t1))).x;
            let (length, exact) = (coarse.length(o, d, [t0, t1]), middle * (t1 - t0));
            assert!((length - exact).abs() <= 0.55 * (t1 - t0), "{length} {exact}");
        });
    }

    #[test]
    fn a_ray_that_misses_has_no_length() {
        let (coarse, _) = coarse(Edge::Fade, |_| 1.0);
        assert!(coarse.length(Vec3::ZERO, Vec3::splat(1.0), [0.5, 0.5]) == 0.0);
        assert!(coarse.length(Vec3::ZERO, Vec3::splat(1.0), [0.5, 0.2]) == 0.0);
    }
}
