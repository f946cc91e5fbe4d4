//! `marble`: veins where a plane wave, bent by noise, passes: a colour along a chain of Bezier curves.
//!
//! `t = (1 + sin(y + variation fbm(p))) / 2` with `p` scaled; the colour runs through nine knots, of which each four in
//! turn are the control points of a cubic, as in pbrt. Source: Perlin, *An image synthesizer*, 1985.

use super::{RgbKind, RgbRule, TextureContext, noise::fbm};
use tyndall_base::math;
use tyndall_geometry::Transform;
use tyndall_spectral::{Spectrum, Wavelengths, colour::SpaceName};

/// Veined stone.
#[derive(Clone, Debug)]
pub struct Marble {
    /// The scene to texture space.
    pub to_texture: Transform,
    /// Number of octaves of noise.
    pub octaves: u32,
    /// Weight of an octave over the one before.
    pub omega: f32,
    /// Factor on the point.
    pub scale: f32,
    /// How much the noise bends the wave.
    pub variation: f32,
}

const STONE: [f32; 3] = [0.58, 0.58, 0.6];
const KNOTS: [[f32; 3]; 9] =
    [STONE, STONE, STONE, [0.5, 0.5, 0.5], [0.6, 0.59, 0.58], STONE, STONE, [0.2, 0.2, 0.33], STONE];
/// Cubics between the knots.
const PIECES: usize = KNOTS.len() - 3;
const BRIGHTNESS: f32 = 1.5;

impl Marble {
    /// The reflectance at `at` for the wavelengths `w`.
    pub fn eval<const N: usize>(&self, at: &TextureContext, w: &Wavelengths<N>) -> Spectrum<N> {
        RgbRule { space: SpaceName::Srgb, kind: RgbKind::Albedo }.sample(self.colour(at), w)
    }

    fn colour(&self, at: &TextureContext) -> [f32; 3] {
        let p = self.to_texture.point(at.p) * self.scale;
        let wave = math::sin(p.y + self.variation * fbm(p, self.omega, self.octaves));
        let t = (0.5 + 0.5 * wave) * PIECES as f32;
        let first = (t as usize).min(PIECES - 1);
        let t = t - first as f32;
        let s = 1.0 - t;
        let weights = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
        let channel = |c: usize| {
            let sum = (0..4).fold(0.0, |sum, k| sum + weights[k] * KNOTS[first + k][c]);
            (BRIGHTNESS * sum).clamp(0.0, 1.0)
        };
        [channel(0), channel(1), channel(2)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_base::vec::{vec2, vec3};

    fn colour(y: f32) -> [f32; 3] {
        let marble =
            Marble { to_texture: Transform::IDENTITY, octaves: 4, omega: 0.5, scale: 1.0, variation: 0.0 };
        marble.colour(&TextureContext { p: vec3(0.0, y, 0.0), n: vec3(0.0, 0.0, 1.0), uv: vec2(0.0, 0.0) })
    }

    #[test]
    fn ends_of_the_wave_have_the_colours_of_the_knots() {
        let quarter = std::f32::consts::FRAC_PI_2;
        let near = |a: [f32; 3], b: [f32; 3]| (0..3).all(|k| (a[k] - (1.5 * b[k]).min(1.0)).abs() < 1e-3);
        assert!(near(colour(-quarter), KNOTS[0]) && near(colour(quarter), KNOTS[8]));
        // at the wave's zero the fourth cubic begins
        assert!(near(colour(0.0), KNOTS[3]), "{:?}", colour(0.0));
    }
}
