//! Gradient noise (Perlin, *Improving noise*, 2002) with the choice of gradients of pbrt-v4: of the twelve edges of a cube,
//! those of hashes 12 and 13 repeat (x + y) and (-x + y).
//!
//! `noise(p)` interpolates gradients of the integer lattice with `6 t^5 - 15 t^4 + 10 t^3`; it vanishes on the lattice.

use std::sync::LazyLock;
use tyndall_base::{Vec3, vec::vec3};

static PERMUTATION: LazyLock<[u8; 512]> = LazyLock::new(|| {
    let text = include_str!("../data/perlin_permutation.csv");
    let rows = text.lines().filter(|l| !l.starts_with('#'));
    let mut values = rows.flat_map(|l| l.split(',')).map(|v| v.parse().expect("the table holds bytes"));
    let mut table = [0; 512];
    for i in 0..256 {
        table[i] = values.next().expect("the table holds 256 numbers");
        table[i + 256] = table[i];
    }
    table
});

/// The gradient of a lattice corner times the offset from it.
#[inline]
fn gradient(table: &[u8; 512], corner: [usize; 3], d: Vec3) -> f32 {
    let next = |base: u8, k: usize| table[usize::from(base) + (corner[k] & 255)];
    let h = next(next(table[corner[0] & 255], 1), 2) & 15;
    let u = if h < 8 || h == 12 || h == 13 { d.x } else { d.y };
    let v = if h < 4 || h == 12 || h == 13 { d.y } else { d.z };
    (if h & 1 == 0 { u } else { -u }) + (if h & 2 == 0 { v } else { -v })
}

#[inline]
fn fade(t: f32) -> f32 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

#[inline]
fn lerp(t: f32, a: f32, b: f32) -> f32 {
    (1.0 - t) * a + t * b
}

/// Cell and offset within it.
#[inline]
fn cell(x: f32) -> (usize, f32) {
    let below = x.floor();
    // the lattice repeats, so any multiple of the period may be taken off before the conversion
    ((below.rem_euclid(256.0)) as usize & 255, x - below)
}

/// Gradient noise at `p`, about -1 to 1.
pub fn noise(p: Vec3) -> f32 {
    let table = &*PERMUTATION;
    let ((ix, dx), (iy, dy), (iz, dz)) = (cell(p.x), cell(p.y), cell(p.z));
    let corner = |x: usize, y: usize, z: usize| {
        let d = vec3(dx - x as f32, dy - y as f32, dz - z as f32);
        gradient(table, [ix + x, iy + y, iz + z], d)
    };
    let (wx, wy, wz) = (fade(dx), fade(dy), fade(dz));
    let edge = |y: usize, z: usize| lerp(wx, corner(0, y, z), corner(1, y, z));
    let face = |z: usize| lerp(wy, edge(0, z), edge(1, z));
    lerp(wz, face(0), face(1))
}

/// Forward differences of the noise over 0.01, as pbrt-v4 takes its gradient.
pub fn noise_gradient(p: Vec3) -> Vec3 {
    const STEP: f32 = 0.01;
    let n = noise(p);
    let along = |d: Vec3| (noise(p + d) - n) / STEP;
    vec3(along(vec3(STEP, 0.0, 0.0)), along(vec3(0.0, STEP, 0.0)), along(vec3(0.0, 0.0, STEP)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_vanishes_on_the_lattice_and_repeats() {
        for p in [vec3(0.0, 0.0, 0.0), vec3(3.0, -7.0, 12.0), vec3(255.0, 256.0, -1.0)] {
            assert_eq!(noise(p), 0.0);
        }
        let p = vec3(0.3, 1.7, -2.4);
        assert!((noise(p) - noise(p + Vec3::splat(256.0))).abs() < 1e-4);
        // far out, where a float holds integers only, there is no overflow
        assert_eq!(noise(vec3(1e20, -1e30, 3e38)), 0.0);
    }

    /// Along the x axis from the origin the corners are (0,0,0) and (1,0,0): perm[perm[perm[0]]] = perm[perm[151]] = perm[17]
    /// = 88 (8: u = y, v = z, so 0), perm[perm[perm[1]]] = perm[perm[160]] = perm[82 is 245] ... checked by hand below.
    #[test]
    fn a_value_by_hand() {
        let table = &*PERMUTATION;
        let h = |x: usize| table[usize::from(table[usize::from(table[x])])] & 15;
        let slope = |h: u8, d: f32| {
            let u = if h < 8 || h == 12 || h == 13 { d } else { 0.0 };
            if h & 1 == 0 { u } else { -u }
        };
        let t = 0.25_f32;
        let s = 6.0 * t.powi(5) - 15.0 * t.powi(4) + 10.0 * t.powi(3);
        let want = (1.0 - s) * slope(h(0), t) + s * slope(h(1), t - 1.0);
        assert!((noise(vec3(t, 0.0, 0.0)) - want).abs() < 1e-6, "{want}");
    }
}
