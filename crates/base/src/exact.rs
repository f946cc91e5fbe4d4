//! Sums that do not depend on the order of their terms, to the bit.
//!
//! Each term is rounded once to a whole number of quanta (2^-64, to nearest, ties away from zero) and added as an integer
//! of 128 bits: integer addition commutes and associates, so threads, shards and resumed runs cannot matter.

/// An order-free sum of numbers below 2^39 in magnitude, in 16 bytes.
///
/// A term that is not finite or too large, and a sum beyond 2^63, *saturate*: the sum is lost for good and says so. Terms of
/// other sizes use a scale: [`Self::add_scaled`] adds `v 2^exponent`, [`Self::to_f64_scaled`] takes it back.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ExactSum(i128);

/// Exponent of the quantum: 2^-64.
const QUANTUM: i32 = -64;
/// Marks a saturated sum; no other sum takes this value.
const SATURATED: i128 = i128::MIN;
/// Terms have magnitudes below 2^103 quanta, so that 2^24 of the greatest fit whatever their order.
const TERM_BITS: i32 = 103;

impl ExactSum {
    /// The empty sum.
    pub const ZERO: Self = Self(0);

    /// Adds a term.
    #[inline(always)]
    pub fn add_f32(&mut self, v: f32) {
        self.add_scaled(v, 0);
    }

    /// Adds `v 2^exponent`.
    #[inline(always)]
    pub fn add_scaled(&mut self, v: f32, exponent: i32) {
        let bits = v.to_bits();
        let biased = (bits >> 23) & 0xff;
        // a subnormal has the exponent of the least normal number and no hidden bit
        let mantissa = (bits & 0x007f_ffff) | (u32::from(biased != 0) << 23);
        let shift = biased.max(1) as i32 - 150 - QUANTUM + exponent;
        self.add_term(u64::from(mantissa), shift, 24, bits >> 31 != 0, biased == 0xff);
    }

    /// Adds a term in double precision.
    #[inline(always)]
    pub fn add_f64(&mut self, v: f64) {
        let bits = v.to_bits();
        let biased = (bits >> 52) & 0x7ff;
        let mantissa = (bits & 0x000f_ffff_ffff_ffff) | (u64::from(biased != 0) << 52);
        let shift = biased.max(1) as i32 - 1075 - QUANTUM;
        self.add_term(mantissa, shift, 53, bits >> 63 != 0, biased == 0x7ff);
    }

    /// Adds `+-mantissa 2^shift` quanta, `mantissa < 2^width`.
    #[inline(always)]
    fn add_term(&mut self, mantissa: u64, shift: i32, width: i32, negative: bool, not_finite: bool) {
        if not_finite | (shift > TERM_BITS - width) {
            if mantissa != 0 {
                self.0 = SATURATED;
            }
            return;
        }
        let magnitude = if shift >= 0 {
            u128::from(mantissa) << shift
        } else {
            // halves round up; a shift of 64 or more leaves nothing
            let down = shift.unsigned_abs();
            u128::from(if down > 63 { 0 } else { ((mantissa >> (down - 1)) + 1) >> 1 })
        };
        let sign = -i128::from(negative);
        self.add_quanta((magnitude as i128 ^ sign) - sign);
    }

    #[inline(always)]
    fn add_quanta(&mut self, quanta: i128) {
        let (sum, overflow) = self.0.overflowing_add(quanta);
        self.0 = if overflow | (self.0 == SATURATED) { SATURATED } else { sum };
    }

    /// Adds another sum.
    #[inline(always)]
    pub fn merge(&mut self, other: Self) {
        self.add_quanta(other.0);
        if other.is_saturated() {
            self.0 = SATURATED;
        }
    }

    /// True when a term was refused or the sum overflowed; the value is then lost.
    #[inline(always)]
    pub fn is_saturated(self) -> bool {
        self.0 == SATURATED
    }

    /// The sum, rounded to nearest; NaN when saturated.
    #[inline]
    pub fn to_f64(self) -> f64 {
        self.to_f64_scaled(0)
    }

    /// The sum times `2^-exponent`, rounded to nearest; NaN when saturated. `exponent` within +-900.
    #[inline]
    pub fn to_f64_scaled(self, exponent: i32) -> f64 {
        let power = QUANTUM - exponent;
        assert!((-1022..=895).contains(&power), "expected an exponent within +-900, got {exponent}");
        let quantum = f64::from_bits(((power + 1023) as u64) << 52);
        if self.is_saturated() { f64::NAN } else { self.0 as f64 * quantum }
    }

    /// The sum as a whole number of quanta of 2^-64, for storage; `i128::MIN` when saturated.
    #[inline]
    pub const fn to_bits(self) -> i128 {
        self.0
    }

    /// The sum that [`Self::to_bits`] came from.
    #[inline]
    pub const fn from_bits(bits: i128) -> Self {
        Self(bits)
    }
}

impl Extend<f32> for ExactSum {
    fn extend<I: IntoIterator<Item = f32>>(&mut self, terms: I) {
        terms.into_iter().for_each(|v| self.add_f32(v));
    }
}

impl FromIterator<f32> for ExactSum {
    fn from_iter<I: IntoIterator<Item = f32>>(terms: I) -> Self {
        let mut sum = Self::ZERO;
        sum.extend(terms);
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// `v 2^64` to the nearest integer, by shifting one bit at a time: terms of any size, ties away from zero.
    fn quanta(v: f64) -> i128 {
        let (mut m, mut e) = (v.abs(), 64);
        // exact: powers of two
        while m != 0.0 && m < 9e15 {
            m *= 2.0;
            e -= 1;
        }
        let (mut q, mut half) = (m as i128, 0);
        while e > 0 {
            q <<= 1;
            e -= 1;
        }
        while e < 0 {
            half = q & 1;
            q >>= 1;
            e += 1;
        }
        let rounded = q + half;
        if v < 0.0 { -rounded } else { rounded }
    }

    /// Finite numbers of all exponents that a sum accepts.
    fn term() -> impl Strategy<Value = f32> {
        (0_u32..(127 + 39) << 23, any::<bool>()).prop_map(|(b, s)| f32::from_bits(b | (u32::from(s) << 31)))
    }

    proptest! {
        #[test]
        fn sums_equal_integer_arithmetic(terms in prop::collection::vec(term(), 0..60)) {
            let sum: ExactSum = terms.iter().copied().collect();
            let exact: i128 = terms.iter().map(|&v| quanta(v.into())).sum();
            prop_assert_eq!(sum.to_bits(), exact);
            let mut double = ExactSum::ZERO;
            terms.iter().for_each(|&v| double.add_f64(v.into()));
            prop_assert_eq!(double, sum);
        }

        #[test]
        fn order_and_grouping_do_not_matter(
            (terms, shuffled) in prop::collection::vec(term(), 1..60)
                .prop_flat_map(|t| (Just(t.clone()), Just(t).prop_shuffle())),
            cut in 0_usize..60,
        ) {
            let sum: ExactSum = terms.iter().copied().collect();
            let (a, b) = shuffled.split_at(cut.min(shuffled.len()));
            let mut merged: ExactSum = b.iter().copied().collect();
            merged.merge(a.iter().copied().collect());
            prop_assert_eq!(merged, sum);
        }

        #[test]
        fn scales_are_powers_of_two(v in term(), exponent in -30_i32..30) {
            let mut sum = ExactSum::ZERO;
            sum.add_scaled(v, exponent);
            let mut direct = ExactSum::ZERO;
            direct.add_f64(f64::from(v) * f64::from(exponent).exp2());
            prop_assert_eq!(sum, direct);
        }
    }

    #[test]
    fn numbers_of_24_bits_come_back() {
        for v in [0.0, 1.0, -1.0, 0.1, 1e-9, -3.7e11, f32::MIN_POSITIVE] {
            let sum: ExactSum = [v].into_iter().collect();
            let expected = if v.abs() < 1e-19 { 0.0 } else { f64::from(v) };
            assert_eq!(sum.to_f64(), expected);
        }
        let mut sum = ExactSum::ZERO;
        sum.add_scaled(3.5, -20);
        assert_eq!(sum.to_f64_scaled(-20), 3.5);
    }

    #[test]
    fn what_does_not_fit_saturates_for_good() {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 5.5e11, f32::MAX, f32::MIN] {
            let sum: ExactSum = [1.0, bad, -1.0].into_iter().collect();
            assert!(sum.is_saturated() && sum.to_f64().is_nan(), "{bad}");
            let mut other: ExactSum = [2.0].into_iter().collect();
            other.merge(sum);
            assert!(other.is_saturated());
        }
        let mut sum = ExactSum::from_bits(i128::MAX - 1);
        sum.add_f32(1.0);
        assert!(sum.is_saturated());
        let largest = f32::from_bits((549_755_813_888.0_f32).to_bits() - 1);
        assert!(![largest; 3].into_iter().collect::<ExactSum>().is_saturated());
    }
}
