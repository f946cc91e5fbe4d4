//! What is made of [gradient noise](crate::noise): `fbm`, `wrinkled`, `windy`.
//!
//! Sums of octaves, `sum omega^i noise(1.99^i p)`, take all octaves: the samples of a pixel do the filtering.
//! Source: Musgrave's fractional Brownian motion and Perlin's turbulence with pbrt's
//! constants.

use super::TextureContext;
use crate::noise::noise;
use tyndall_base::Vec3;
use tyndall_geometry::Transform;

/// Ratio of the frequencies of neighbouring octaves.
const LACUNARITY: f32 = 1.99;

/// What turbulence takes for the mean of |noise| where an octave is cut.
const MEAN_MAGNITUDE: f32 = 0.2;

fn octaves(p: Vec3, omega: f32, count: u32, value: impl Fn(f32) -> f32) -> f32 {
    let (mut sum, mut frequency, mut weight) = (0.0, 1.0, 1.0);
    for _ in 0..count {
        sum += weight * value(noise(p * frequency));
        frequency *= LACUNARITY;
        weight *= omega;
    }
    sum
}

/// `sum omega^i noise(1.99^i p)`.
pub fn fbm(p: Vec3, omega: f32, count: u32) -> f32 {
    octaves(p, omega, count, |n| n)
}

/// `sum omega^i |noise(1.99^i p)|`, and the mean of the octave after the last, as pbrt has it.
pub fn turbulence(p: Vec3, omega: f32, count: u32) -> f32 {
    let last = (0..count).fold(1.0, |weight: f32, _| weight * omega);
    octaves(p, omega, count, f32::abs) + MEAN_MAGNITUDE * last
}

/// Which sum of octaves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoiseKind {
    /// Fractional Brownian motion.
    Fbm {
        /// Weight of an octave over the one before.
        omega: f32,
        /// Their number.
        octaves: u32,
    },
    /// Turbulence.
    Wrinkled {
        /// Weight of an octave over the one before.
        omega: f32,
        /// Their number.
        octaves: u32,
    },
    /// Waves whose height varies slowly: `|fbm(p / 10)| fbm(p)`.
    Windy,
}

/// Noise in the texture's space.
#[derive(Clone, Debug)]
pub struct NoiseTexture {
    /// The scene to texture space.
    pub to_texture: Transform,
    /// Which sum.
    pub kind: NoiseKind,
}

impl NoiseTexture {
    /// The value at `at`.
    pub fn eval(&self, at: &TextureContext) -> f32 {
        let p = self.to_texture.point(at.p);
        match self.kind {
            NoiseKind::Fbm { omega, octaves } => fbm(p, omega, octaves),
            NoiseKind::Wrinkled { omega, octaves } => turbulence(p, omega, octaves),
            NoiseKind::Windy => fbm(p * 0.1, 0.5, 3).abs() * fbm(p, 0.5, 6),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_base::vec::vec3;

    #[test]
    fn sums_of_octaves() {
        let p = vec3(0.4, 0.2, 0.9);
        let two = noise(p) + 0.3 * noise(p * LACUNARITY);
        assert!((fbm(p, 0.3, 2) - two).abs() < 1e-6);
        let two = noise(p).abs() + 0.3 * noise(p * LACUNARITY).abs() + 0.09 * MEAN_MAGNITUDE;
        assert!((turbulence(p, 0.3, 2) - two).abs() < 1e-6);
    }
}
