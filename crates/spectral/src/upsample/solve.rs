//! The coefficients of a sigmoid with a given colour, by damped Gauss-Newton steps on L*a*b*.

use tyndall_base::math::f64::cbrt;

use crate::cie::matching_functions;
use crate::colour::{ColourSpace, Matrix3};

/// Largest coefficient; colours that no smooth reflectance reaches would let them grow without end. The paper's value.
const LIMIT: f64 = 200.0;
/// When to stop: the squared distance in L*a*b* at which a colour counts as met, and the number of steps.
#[derive(Clone, Copy)]
pub(super) struct Effort {
    met: f64,
    steps: usize,
}

impl Effort {
    /// For single colours.
    pub(super) const EXACT: Self = Self { met: 1e-12, steps: 60 };
    /// For tables: a distance of 1e-4, and as many steps as the paper takes.
    pub(super) const TABLE: Self = Self { met: 1e-8, steps: 15 };
}

/// Nodes and weights that turn a reflectance into RGB under the white of a colour space.
pub(super) struct Quadrature {
    /// `(lambda - 360 nm) / 470 nm` of the nodes.
    t: Vec<f64>,
    /// Weights for R, G, B.
    weights: Vec<[f64; 3]>,
    xyz_from_rgb: Matrix3,
    white: [f64; 3],
}

/// A colour and its derivatives by the three coefficients (`derivatives[i][channel]`).
struct Colour {
    value: [f64; 3],
    derivatives: [[f64; 3]; 3],
}

impl Quadrature {
    /// Nodes every `step_nm` (a divisor of 470). The 1 nm weights are spread over the two nearest nodes, which is exact
    /// for reflectances that are straight between nodes.
    pub(super) fn new(space: &ColourSpace, step_nm: usize) -> Self {
        let nodes = 470 / step_nm + 1;
        let mut weights = vec![[0.0f64; 3]; nodes];
        for i in 0..=470usize {
            let l = 360.0 + i as f32;
            let light = f64::from(space.illuminant.eval(l));
            let xyz = [0, 1, 2].map(|k| f64::from(matching_functions()[k].eval(l)) * light);
            let rgb = space.rgb_from_xyz.apply(xyz);
            let (node, part) = (i / step_nm, (i % step_nm) as f64 / step_nm as f64);
            for k in 0..3 {
                weights[node][k] += (1.0 - part) * rgb[k];
                weights[(node + 1).min(nodes - 1)][k] += part * rgb[k];
            }
        }
        let mut sums = [0.0; 3];
        weights.iter().for_each(|w| (0..3).for_each(|k| sums[k] += w[k]));
        weights.iter_mut().for_each(|w| (0..3).for_each(|k| w[k] /= sums[k]));
        let t = (0..nodes).map(|n| (n * step_nm) as f64 / 470.0).collect();
        Self { t, weights, xyz_from_rgb: space.xyz_from_rgb, white: space.white }
    }

    /// Where to begin for a colour: the constant of its mean component.
    pub(super) fn start(&self, rgb: [f64; 3]) -> [f64; 3] {
        let v = ((rgb[0] + rgb[1] + rgb[2]) / 3.0).clamp(1e-3, 1.0 - 1e-3);
        [0.0, 0.0, (v - 0.5) / (v * (1.0 - v)).sqrt()]
    }

    /// RGB of the sigmoid with coefficients `c`, with derivatives.
    fn colour(&self, c: [f64; 3]) -> Colour {
        let mut value = [0.0; 3];
        let mut derivatives = [[0.0; 3]; 3];
        for (&t, w) in self.t.iter().zip(&self.weights) {
            let x = (c[0] * t + c[1]) * t + c[2];
            let root = (1.0 + x * x).sqrt();
            let s = 0.5 + 0.5 * x / root;
            let slope = 0.5 / (root * root * root);
            for k in 0..3 {
                value[k] += w[k] * s;
                let d = w[k] * slope;
                derivatives[2][k] += d;
                derivatives[1][k] += d * t;
                derivatives[0][k] += d * t * t;
            }
        }
        Colour { value, derivatives }
    }

    /// RGB of the sigmoid with coefficients `c`.
    #[cfg(test)]
    pub(super) fn rgb(&self, c: [f64; 3]) -> [f64; 3] {
        self.colour(c).value
    }

    /// L*a*b* of RGB, and of small changes of it: the columns of `changes` mapped by the derivative.
    fn lab(&self, rgb: [f64; 3], changes: [[f64; 3]; 3]) -> ([f64; 3], [[f64; 3]; 3]) {
        let xyz = self.xyz_from_rgb.apply(rgb);
        let (f, slope): (Vec<f64>, Vec<f64>) = (0..3).map(|i| lab_curve(xyz[i] / self.white[i])).unzip();
        let combine = |f: [f64; 3]| [116.0 * f[1], 500.0 * (f[0] - f[1]), 200.0 * (f[1] - f[2])];
        let mapped = changes.map(|change| {
            let d = self.xyz_from_rgb.apply(change);
            combine([0, 1, 2].map(|i| slope[i] * d[i] / self.white[i]))
        });
        (combine([f[0], f[1], f[2]]), mapped)
    }

    /// Coefficients whose colour is `rgb`, or is nearest to it within the limit, from `start` on: Levenberg-Marquardt.
    pub(super) fn solve(&self, rgb: [f64; 3], start: [f64; 3], effort: Effort) -> [f64; 3] {
        let target = self.lab(rgb, [[0.0; 3]; 3]).0;
        let residual = |c: [f64; 3]| {
            let colour = self.colour(c);
            let (lab, jacobian) = self.lab(colour.value, colour.derivatives);
            ([0, 1, 2].map(|k| target[k] - lab[k]), jacobian)
        };
        let norm = |r: [f64; 3]| r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
        let mut c = start;
        let (mut r, mut jacobian) = residual(c);
        let mut damping = 1e-3;
        for _ in 0..effort.steps {
            if norm(r) < effort.met || damping > 1e12 {
                break;
            }
            let Some(step) = damped_step(&jacobian, r, damping) else {
                damping *= 10.0;
                continue;
            };
            let next = limited([0, 1, 2].map(|i| c[i] + step[i]));
            let (next_r, next_jacobian) = residual(next);
            if norm(next_r) < norm(r) {
                (c, r, jacobian) = (next, next_r, next_jacobian);
                damping = (damping * 0.1).max(1e-15);
            } else {
                damping *= 10.0;
            }
        }
        c
    }
}

/// The L*a*b* function of CIE 1976 and its derivative.
fn lab_curve(t: f64) -> (f64, f64) {
    let edge = 6.0 / 29.0;
    if t > edge * edge * edge {
        let root = cbrt(t);
        (root, 1.0 / (3.0 * root * root))
    } else {
        (t / (3.0 * edge * edge) + 4.0 / 29.0, 1.0 / (3.0 * edge * edge))
    }
}

/// `(J^T J + damping diag(J^T J)) step = J^T r`; `jacobian[i]` is the change of the residual's target by coefficient i.
fn damped_step(jacobian: &[[f64; 3]; 3], r: [f64; 3], damping: f64) -> Option<[f64; 3]> {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let mut normal: [[f64; 3]; 3] =
        std::array::from_fn(|i| std::array::from_fn(|j| dot(jacobian[i], jacobian[j])));
    for (i, row) in normal.iter_mut().enumerate() {
        row[i] = row[i] * (1.0 + damping) + 1e-300;
    }
    let step = Matrix3(normal).inverse()?.apply([0, 1, 2].map(|i| dot(jacobian[i], r)));
    step.iter().all(|s| s.is_finite()).then_some(step)
}

/// Coefficients scaled down to the limit.
fn limited(c: [f64; 3]) -> [f64; 3] {
    let greatest = c.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    if greatest > LIMIT { c.map(|v| v * (LIMIT / greatest)) } else { c }
}
