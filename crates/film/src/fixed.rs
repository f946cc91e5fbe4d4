//! Exact sums in storage: integers in fixed point, so that addition commutes and associates to the bit.
//!
//! A sample `v` (f32, |v| < 2^31) enters a sum of values as `v * 2^64` in the 16 bytes of an [`ExactSum`], and a sum of
//! squares as `v^2 * 2^112` in an unsigned integer of 192 bits; what lies below the quantum is rounded to nearest, once per
//! sample. With at most 2^32 samples a sum of values cannot overflow.

use tyndall_base::exact::ExactSum;

/// Samples of at least this magnitude are refused.
pub(crate) const LIMIT: f32 = 2_147_483_648.0;

const SQUARE_BITS: i32 = 112;

/// Sum of squares, least limb first.
pub(crate) type Square = [u64; 3];

/// `m / 2^shift` rounded to nearest, ties away from zero, for a mantissa below 2^62 and `shift > 0`.
#[inline(always)]
fn shift_right(m: u64, shift: u32) -> u64 {
    if shift > 63 { 0 } else { ((m >> (shift - 1)) + 1) >> 1 }
}

/// Adds `v` to a stored sum.
#[inline(always)]
pub(crate) fn add(sum: &mut i128, v: f32) {
    let mut exact = ExactSum::from_bits(*sum);
    exact.add_f32(v);
    *sum = exact.to_bits();
}

/// Adds a stored sum to another.
#[inline(always)]
pub(crate) fn merge(sum: &mut i128, other: i128) {
    let mut exact = ExactSum::from_bits(*sum);
    exact.merge(ExactSum::from_bits(other));
    *sum = exact.to_bits();
}

/// The value of a stored sum.
#[inline]
pub(crate) fn to_f64(sum: i128) -> f64 {
    ExactSum::from_bits(sum).to_f64()
}

/// Adds `square`, a number >= 0 below 2^63 (the square of a sample); true when the sum overflowed.
#[inline(always)]
pub(crate) fn add_square(sum: &mut Square, square: f64) -> bool {
    let bits = square.to_bits();
    let biased = (bits >> 52) as i32;
    if biased == 0 {
        return false;
    }
    let m = (bits & ((1 << 52) - 1)) | (1 << 52);
    let shift = biased - 1075 + SQUARE_BITS;
    let (upper, wide) = if shift >= 0 {
        (shift >= 64, u128::from(m) << (shift & 63))
    } else {
        (false, u128::from(shift_right(m, shift.unsigned_abs())))
    };
    add_parts(sum, if upper { wide << 64 } else { wide }, if upper { (wide >> 64) as u64 } else { 0 })
}

/// Adds a sum of squares; true when it overflowed.
#[inline(always)]
pub(crate) fn add_limbs(sum: &mut Square, b: Square) -> bool {
    add_parts(sum, join(b[0], b[1]), b[2])
}

#[inline(always)]
fn add_parts(sum: &mut Square, low: u128, top: u64) -> bool {
    let (low, carry) = join(sum[0], sum[1]).overflowing_add(low);
    let (top, over) = sum[2].overflowing_add(top);
    let (top, over_again) = top.overflowing_add(u64::from(carry));
    *sum = [low as u64, (low >> 64) as u64, top];
    over | over_again
}

#[inline(always)]
fn join(low: u64, high: u64) -> u128 {
    u128::from(high) << 64 | u128::from(low)
}

/// The value of a sum of squares.
#[inline]
pub(crate) fn square_to_f64(sum: Square) -> f64 {
    let upper = (u128::from(sum[2]) << 64) | u128::from(sum[1]);
    upper as f64 * exp2i(64 - SQUARE_BITS) + sum[0] as f64 * exp2i(-SQUARE_BITS)
}

/// `2^e` for a normal exponent, exact.
const fn exp2i(e: i32) -> f64 {
    f64::from_bits(((e + 1023) as u64) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn squares_are_exact() {
        for v in [1.0f32, -1.0, 0.1, -0.3, 1e9, -2e9, 1e-6, 0.0, 0.5, 0.49999997] {
            let mut s = [0; 3];
            assert!(!add_square(&mut s, f64::from(v) * f64::from(v)));
            assert_eq!(square_to_f64(s), f64::from(v) * f64::from(v), "{v}");
        }
        let mut s = [0; 3];
        let exact = f64::from(1e-10f32) * f64::from(1e-10f32);
        add_square(&mut s, exact);
        assert!((square_to_f64(s) / exact - 1.0).abs() < 1e-12);
    }

    #[test]
    fn overflow_of_squares_is_told() {
        let mut s = [u64::MAX; 3];
        assert!(add_square(&mut s, 1.0));
    }

    proptest! {
        #[test]
        fn any_order_gives_the_same_bits(v in prop::collection::vec(-1e6f32..1e6, 1..40), seed in 0usize..1000) {
            let sum = |order: &[usize]| {
                let mut s = (0i128, [0u64; 3]);
                for &i in order {
                    add(&mut s.0, v[i]);
                    add_square(&mut s.1, f64::from(v[i]) * f64::from(v[i]));
                }
                s
            };
            let forward: Vec<usize> = (0..v.len()).collect();
            let mut other = forward.clone();
            other.rotate_left(seed % v.len());
            other.reverse();
            prop_assert_eq!(sum(&forward), sum(&other));
            let exact: f64 = v.iter().map(|&x| f64::from(x)).sum();
            prop_assert!((to_f64(sum(&forward).0) - exact).abs() <= 1e-9 * exact.abs().max(1.0));
        }
    }
}
