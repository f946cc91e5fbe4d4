//! pbrt-v4's procedural `cloud`: octaves of noise that thin out with the height y, in the medium's own space.
//!
//! `d(p) = clamp(clamp((1 - y) 4.5 density f(q), 0, 1) + 2 max(0, 1/2 - y), 0, 1)`, `f = sum_i 2^-i-1 noise(1.99^i q)` over
//! five octaves, `q = frequency p` displaced by the gradient of two octaves of noise where `wispiness` > 0.

use super::{Density, Extrema};
use crate::{
    TransportError,
    error::check,
    media::majorant::Cells,
    noise::{noise, noise_gradient},
};
use tyndall_base::Vec3;
use tyndall_geometry::Bounds3;

/// Octaves of the density and what they sum to where noise is 1.
const OCTAVES: i32 = 5;
const AMPLITUDE: f32 = 0.96875;
/// More than the noise reaches: in a cell it is at most the greatest dot product of a gradient with an offset.
const NOISE_BOUND: f32 = 1.1;
/// Finest cells along each axis.
const CELLS: usize = 16;

/// See the module.
#[derive(Clone, Copy, Debug)]
pub struct Cloud {
    bounds: Bounds3,
    density: f32,
    wispiness: f32,
    frequency: f32,
}

impl Cloud {
    /// A cloud in `bounds`, pbrt-v4's parameters.
    pub fn new(
        bounds: Bounds3,
        density: f32,
        wispiness: f32,
        frequency: f32,
    ) -> Result<Self, TransportError> {
        check(density >= 0.0 && density.is_finite(), "density", "finite and >= 0", f64::from(density))?;
        check(wispiness.is_finite(), "wispiness", "finite", f64::from(wispiness))?;
        check(frequency.is_finite(), "frequency", "finite", f64::from(frequency))?;
        Ok(Self { bounds, density, wispiness, frequency })
    }
}

impl Density for Cloud {
    fn at(&self, p: Vec3) -> f32 {
        let mut q = p * self.frequency;
        if self.wispiness > 0.0 {
            let (mut omega, mut lambda) = (0.05 * self.wispiness, 10.0);
            for _ in 0..2 {
                q = q + noise_gradient(q * lambda) * omega;
                omega *= 0.5;
                lambda *= 1.99;
            }
        }
        let (mut d, mut omega, mut lambda) = (0.0, 0.5, 1.0);
        for _ in 0..OCTAVES {
            d += omega * noise(q * lambda);
            omega *= 0.5;
            lambda *= 1.99;
        }
        let d = ((1.0 - p.y) * 4.5 * self.density * d).clamp(0.0, 1.0);
        (d + 2.0 * (0.5 - p.y).max(0.0)).clamp(0.0, 1.0)
    }

    fn extrema(&self, b: Bounds3) -> Extrema {
        let height = (1.0 - b.lo.y).abs().max((1.0 - b.hi.y).abs());
        let noisy = height * 4.5 * self.density * (AMPLITUDE * NOISE_BOUND);
        let floor = |y: f32| 2.0 * (0.5 - y).max(0.0);
        Extrema { max: (noisy.min(1.0) + floor(b.lo.y)).min(1.0), min: floor(b.hi.y).min(1.0) }
    }

    fn bounds(&self) -> Bounds3 {
        self.bounds
    }

    fn cells(&self) -> Cells {
        let edge = self.bounds.extent() * (1.0 / CELLS as f32);
        Cells { origin: self.bounds.lo, edge, dims: [CELLS; 3] }
    }

    fn detail(&self) -> f32 {
        // half a period of the finest octave
        let finest = 15.68 * self.frequency.abs();
        self.bounds.extent().max_component().min(0.5 / finest.max(1e-6))
    }
}
