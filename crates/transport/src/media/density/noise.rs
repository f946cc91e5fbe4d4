//! Gradient noise after Perlin (2002, *Improving noise*), with the choice of gradients of pbrt-v4: of the twelve edges
//! of a cube, those of hashes 12 and 13 repeat (x + y) and (-x + y).

use super::split;
use std::sync::OnceLock;
use tyndall_base::{Vec3, vec::vec3};

/// Coordinates are taken modulo this.
const FAR: f32 = (1u32 << 30) as f32;
/// The published permutation.
const TABLE: &str = include_str!("../../../data/perlin_permutation.csv");

fn permutation() -> &'static [u8; 256] {
    static P: OnceLock<[u8; 256]> = OnceLock::new();
    P.get_or_init(|| {
        let mut numbers = TABLE.split([',', '\n']).filter_map(|w| w.trim().parse().ok());
        std::array::from_fn(|_| numbers.next().unwrap_or(0))
    })
}

/// Noise at `p`: zero at integers, between -1 and 1 but for rounding.
pub fn noise(p: Vec3) -> f32 {
    let table = permutation();
    let axis = |x: f32| {
        // far out, f32 has no fractions and i32 no room
        let x = if x.abs() < FAR { x } else { x % FAR };
        let (below, rest) = split(x);
        ((below & 255) as usize, rest)
    };
    let ((ix, dx), (iy, dy), (iz, dz)) = (axis(p.x), axis(p.y), axis(p.z));
    let at = |i: usize| usize::from(table[i & 255]);
    let corner = |x: usize, y: usize, z: usize| {
        let hash = at(at(at(ix + x) + iy + y) + iz + z);
        gradient(hash, dx - x as f32, dy - y as f32, dz - z as f32)
    };
    let mix = |t: f32, a: f32, b: f32| (1.0 - t) * a + t * b;
    let (wx, wy, wz) = (fade(dx), fade(dy), fade(dz));
    let edge = |y: usize, z: usize| mix(wx, corner(0, y, z), corner(1, y, z));
    mix(wz, mix(wy, edge(0, 0), edge(1, 0)), mix(wy, edge(0, 1), edge(1, 1)))
}

/// Forward differences of the noise over 0.01, as pbrt-v4 takes its gradient.
pub fn noise_gradient(p: Vec3) -> Vec3 {
    const STEP: f32 = 0.01;
    let n = noise(p);
    let along = |d: Vec3| (noise(p + d) - n) / STEP;
    vec3(along(vec3(STEP, 0.0, 0.0)), along(vec3(0.0, STEP, 0.0)), along(vec3(0.0, 0.0, STEP)))
}

/// `6 t^5 - 15 t^4 + 10 t^3`.
#[inline(always)]
fn fade(t: f32) -> f32 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

#[inline(always)]
fn gradient(hash: usize, x: f32, y: f32, z: f32) -> f32 {
    let h = hash & 15;
    let u = if h < 8 || h == 12 || h == 13 { x } else { y };
    let v = if h < 4 || h == 12 || h == 13 { y } else { z };
    (if h & 1 == 0 { u } else { -u }) + (if h & 2 == 0 { v } else { -v })
}
