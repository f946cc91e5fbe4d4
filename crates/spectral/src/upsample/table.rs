//! The coefficients on a grid of colours, for textures.
//!
//! The layout is the paper's: the greatest component `z` with `x`, `y` the other two divided by it, `z` denser near 0 and 1.
//! A point of the grid is solved when first needed, so that a picture pays for the colours it has.

use std::sync::OnceLock;

use super::solve::{Effort, Quadrature};
use crate::colour::{ColourSpace, SpaceName};
use crate::curve::SigmoidPolynomial;

/// Grid points along each axis.
const RESOLUTION: usize = 64;

/// Points of equal `z`, `[y][x]`.
type Layer = Box<[OnceLock<[f32; 3]>]>;

/// Sigmoid coefficients for RGB in \[0, 1\] by interpolation.
pub struct RgbTable {
    quadrature: Quadrature,
    /// `[greatest component][z]`, each with room for its points once one is needed.
    layers: Vec<OnceLock<Layer>>,
}

impl RgbTable {
    /// The table of a colour space, shared by all users.
    pub fn get(space: SpaceName) -> &'static Self {
        static TABLES: [OnceLock<RgbTable>; 4] = [const { OnceLock::new() }; 4];
        TABLES[space as usize].get_or_init(|| Self {
            quadrature: Quadrature::new(ColourSpace::get(space), 5),
            layers: (0..3 * RESOLUTION).map(|_| OnceLock::new()).collect(),
        })
    }

    /// Coefficients for `rgb`, components clamped to \[0, 1\].
    pub fn coefficients(&self, rgb: [f32; 3]) -> SigmoidPolynomial {
        let rgb = rgb.map(|c| if c > 0.0 { c.min(1.0) } else { 0.0 });
        if rgb[0] == rgb[1] && rgb[1] == rgb[2] {
            return SigmoidPolynomial::constant(rgb[0]);
        }
        let greatest = (0..3).fold(0, |m, i| if rgb[i] > rgb[m] { i } else { m });
        let z = rgb[greatest];
        let last = (RESOLUTION - 1) as f32;
        let [x, y] = [1, 2].map(|k| rgb[(greatest + k) % 3] / z * last);
        let zi = z_interval(z);
        let dz = (z - z_node(zi)) / (z_node(zi + 1) - z_node(zi));
        let [low, high] = [zi, zi + 1].map(|zi| self.bilinear(greatest, zi, x, y));
        SigmoidPolynomial { c: [0, 1, 2].map(|i| low[i] + dz * (high[i] - low[i])) }
    }

    fn bilinear(&self, greatest: usize, zi: usize, x: f32, y: f32) -> [f32; 3] {
        let layer = self.layers[greatest * RESOLUTION + zi]
            .get_or_init(|| (0..RESOLUTION * RESOLUTION).map(|_| OnceLock::new()).collect());
        let (xi, yi) = ((x as usize).min(RESOLUTION - 2), (y as usize).min(RESOLUTION - 2));
        let (dx, dy) = (x - xi as f32, y - yi as f32);
        let at = |i: usize, j: usize| {
            let (xi, yi) = (xi + i, yi + j);
            *layer[yi * RESOLUTION + xi].get_or_init(|| self.solve(greatest, [xi, yi, zi]))
        };
        let ([a, b], [c, d]) = ([at(0, 0), at(1, 0)], [at(0, 1), at(1, 1)]);
        std::array::from_fn(|k| {
            let (low, high) = (a[k] + dx * (b[k] - a[k]), c[k] + dx * (d[k] - c[k]));
            low + dy * (high - low)
        })
    }

    /// The coefficients at a point of the grid.
    #[cold]
    fn solve(&self, greatest: usize, [xi, yi, zi]: [usize; 3]) -> [f32; 3] {
        // the ends are solved a little inside: a sigmoid reaches 0 and 1 only in the limit
        let z = f64::from(z_node(zi)).clamp(1e-5, 1.0 - 1e-5);
        let part = |i: usize| z * i as f64 / (RESOLUTION - 1) as f64;
        let mut rgb = [z; 3];
        rgb[(greatest + 1) % 3] = part(xi);
        rgb[(greatest + 2) % 3] = part(yi);
        let c = self.quadrature.solve(rgb, self.quadrature.start(rgb), Effort::TABLE);
        c.map(|v| v as f32)
    }
}

/// Node `i` of the axis of the greatest component: two smooth steps, dense at both ends.
fn z_node(i: usize) -> f32 {
    let smooth = |v: f64| v * v * (3.0 - 2.0 * v);
    smooth(smooth(i as f64 / (RESOLUTION - 1) as f64)) as f32
}

/// The interval of nodes that holds `z`.
fn z_interval(z: f32) -> usize {
    static NODES: OnceLock<Vec<f32>> = OnceLock::new();
    let nodes = NODES.get_or_init(|| (0..RESOLUTION).map(z_node).collect());
    nodes.partition_point(|&n| n <= z).saturating_sub(1).min(RESOLUTION - 2)
}
