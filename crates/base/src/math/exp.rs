use super::{LN2_HI, LN2_LO};
use std::hint::select_unpredictable as select;

/// Adding 1.5 * 2^23 rounds an `f32` of modest size to an integer, kept in the low bits of the sum.
const ROUND: f32 = 12_582_912.0;
/// Below `ln(2^-126)` the result would be subnormal and is flushed to zero.
const FLUSH: f32 = -87.336_54;
/// Above `ln(f32::MAX)` the result is infinite.
const OVERFLOW: f32 = 88.722_83;

/// `e^x`: relative error below 1.8e-7 (1.5 ulp), zero below -87.33654, infinite above 88.72283, NaN for NaN.
///
/// `e^x = 2^n e^r` with `n = round(x / ln 2)` and `r` within `ln(2) / 2` (Cody & Waite 1980).
#[inline(always)]
pub fn exp(x: f32) -> f32 {
    let t = x * std::f32::consts::LOG2_E + ROUND;
    let n = t - ROUND;
    let r = (x - n * LN2_HI) - n * LN2_LO;
    let q = 0.499_999_93 + r * (0.166_665_21 + r * (0.041_668_388 + r * (0.008_368_717 + r * 0.001_381_461)));
    let e_r = 1.0 + (r + r * r * q);
    // n goes straight into the exponent field: e_r lies in [0.7, 1.42]
    let scaled = f32::from_bits(e_r.to_bits().wrapping_add(t.to_bits() << 23));
    let flushed = select(x < FLUSH, 0.0, scaled);
    select(x <= OVERFLOW, flushed, x * f32::INFINITY)
}

/// [`exp`] of each lane; the loop vectorises.
#[inline(always)]
pub fn exp_n<const N: usize>(mut x: [f32; N]) -> [f32; N] {
    for v in &mut x {
        *v = exp(*v);
    }
    x
}
