//! Scenes and random numbers for the tests.
#![allow(dead_code, reason = "each test file uses its own part")]

pub mod meshes;

use tyndall_base::Vec3;
use tyndall_base::vec::vec3;
use tyndall_geometry::{Accel, BuildOptions, Ray, Shape, ShapeGroup, TriangleMesh};

/// SplitMix64 (Steele et al. 2014): seeded, the same everywhere.
pub struct Rng(u64);

impl Rng {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15))
    }

    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in 0..n.
    pub fn below(&mut self, n: u64) -> u64 {
        self.bits() % n
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f32 {
        (self.bits() >> 40) as f32 / (1u64 << 24) as f32
    }

    /// Uniform in [0, 1) to 53 bits.
    pub fn unit64(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform in [-1, 1).
    pub fn signed(&mut self) -> f32 {
        self.unit() * 2.0 - 1.0
    }

    pub fn in_cube(&mut self) -> Vec3 {
        vec3(self.signed(), self.signed(), self.signed())
    }

    /// Uniform direction, by rejection.
    pub fn direction(&mut self) -> Vec3 {
        loop {
            let v = self.in_cube();
            let l2 = v.length_squared();
            if l2 > 0.01 && l2 < 1.0 {
                return v.normalize();
            }
        }
    }

    /// From somewhere in twice the unit cube along a random direction.
    pub fn ray(&mut self) -> Ray {
        Ray::new(self.in_cube() * 2.0, self.direction())
    }
}

/// `n` triangles of about `size` in the unit cube.
pub fn soup(n: usize, size: f32, seed: u64) -> TriangleMesh {
    let mut rng = Rng::new(seed ^ 0x5eed);
    let mut p = Vec::with_capacity(3 * n);
    for _ in 0..n {
        let at = rng.in_cube();
        p.extend([0, 1, 2].map(|_| at + rng.in_cube() * size));
    }
    let indices = (0..n as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    TriangleMesh::new(indices, p).expect("finite vertices")
}

pub fn build(groups: Vec<ShapeGroup>) -> Accel {
    Accel::build(groups, &[], vec![], &BuildOptions::default()).expect("valid groups")
}

pub fn accel(mesh: TriangleMesh) -> Accel {
    build(vec![Shape::Triangles(mesh).into()])
}
