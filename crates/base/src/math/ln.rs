use super::{LN2_HI, LN2_LO};
use std::hint::select_unpredictable as select;

/// Bits of `sqrt(1/2)`: mantissas are centred on one, in `[sqrt(1/2), sqrt(2))`.
const SQRT_HALF: u32 = 0x3f35_04f3;

/// Natural logarithm: relative error below 1.2e-7, `-inf` at zero, NaN for negative numbers and NaN.
///
/// `x = 2^e m`, `f = m - 1`, `s = f / (2 + f)`: `ln(1 + f) = 2 atanh s`, whose leading `2 s` is rewritten as
/// `f - f^2/2 + s f^2/2` so that rounding of the quotient does not matter.
#[inline(always)]
pub fn ln(x: f32) -> f32 {
    // a subnormal is scaled to a normal number
    let subnormal = x < f32::MIN_POSITIVE;
    let normal = select(subnormal, x * 8_388_608.0, x);
    let bias = select(subnormal, -23.0, 0.0);
    let offset = normal.to_bits().wrapping_sub(SQRT_HALF);
    let e = ((offset as i32) >> 23) as f32 + bias;
    let f = f32::from_bits((offset & 0x007f_ffff).wrapping_add(SQRT_HALF)) - 1.0;
    let s = f / (2.0 + f);
    let z = s * s;
    let tail = z * (0.666_667_76 + z * (0.399_775_7 + z * 0.298_710_73));
    let half_f2 = 0.5 * f * f;
    let y = e * LN2_HI + (f - (half_f2 - (s * (half_f2 + tail) + e * LN2_LO)));
    let above = select(x < f32::INFINITY, y, x);
    let below = select(x == 0.0, f32::NEG_INFINITY, f32::NAN);
    select(x > 0.0, above, below)
}

/// [`ln`] of each lane; the loop vectorises.
#[inline(always)]
pub fn ln_n<const N: usize>(mut x: [f32; N]) -> [f32; N] {
    for v in &mut x {
        *v = ln(*v);
    }
    x
}
