//! Elementary functions that give the same bits on every machine.
//!
//! The platform's `libm` differs between systems and versions, so nothing that reaches the film may call it. The
//! `f32` functions here are branch-free polynomials (minimax fits by Remez exchange on the reduced range) built
//! from IEEE-exact operations only: `+`, `-`, `*`, `/`, `sqrt` and integer arithmetic. No product is ever
//! contracted with a sum. The `f64` functions in [`mod@f64`] come from the crate `libm` (a pure Rust port of musl).
//!
//! [`exp_n`] and [`ln_n`] work on lanes and vectorise; the scalar [`exp`] and [`ln`] give the bits of one lane.

mod exp;
pub mod f64;
mod inverse;
mod ln;
mod pow;
mod trig;

pub use exp::{exp, exp_n};
pub use inverse::{acos, asin, atan, atan2};
pub use ln::{ln, ln_n};
pub use pow::pow;
pub use trig::{cos, sin, sin_cos, sin_cos_turns, tan};

/// `ln 2` in 16 bits: the product with a binary exponent is exact in `f32`.
const LN2_HI: f32 = 0.693_145_751_953_125;
/// `ln 2 - LN2_HI`.
const LN2_LO: f32 = 1.428_606_765_330_187e-6;

#[cfg(test)]
mod tests;
