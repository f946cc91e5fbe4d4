//! Vectors, math that gives the same bits on every machine, counter-based random numbers, Sobol points,
//! distributions, warps and quadrature.
//!
//! Nothing here calls the platform's `libm`, and nothing contracts a product and a sum: a release build, a
//! portable build and a build for another processor give the same bits.
#![forbid(unsafe_code)]

pub mod distribution;
pub mod err;
pub mod exact;
pub mod hash;
pub mod math;
pub mod quadrature;
pub mod rng;
pub mod sobol;
pub mod vec;
pub mod warp;

pub use vec::{Vec2, Vec3};

/// `a.map(f)` as a plain loop: the standard one is not inlined into functions compiled for other instruction sets.
#[inline(always)]
pub fn each<const N: usize, A: Copy, B: Copy + Default>(a: [A; N], mut f: impl FnMut(A) -> B) -> [B; N] {
    let mut out = [B::default(); N];
    for k in 0..N {
        out[k] = f(a[k]);
    }
    out
}
