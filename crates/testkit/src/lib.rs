//! Statistical tests for samplers, estimators and images.
//!
//! Every test here has a null hypothesis ("the sampler follows its density", "the mean is this number") and returns a
//! p-value or asserts it against [`ALPHA`], shared out over several tests by Sidak's rule. Seeds are arguments: fixed,
//! and never chosen to pass.
#![forbid(unsafe_code)]

mod chi2;
mod cubature;
pub mod distribution;
mod family;
mod image;
mod ks;
mod moments;
mod rng;

pub use chi2::{ChiSquare, chi2_1d, chi2_2d, chi2_discrete, chi2_sphere, chi2_test};
pub use cubature::{integrate_1d, integrate_2d, integrate_sphere};
pub use family::{ALPHA, holm, sidak};
pub use image::{BlockTest, ImageEstimate, block_test, block_test_replicates};
pub use ks::{KsTest, ks_test};
pub use moments::{Welford, ZTest, assert_mean, z_max, z_test};
pub use rng::Rng;

#[cfg(test)]
mod tests;
