//! A small sequential generator for tests, builders and estimators that need an unbounded number of random words.

use crate::hash::{mix64, to_unit_f32, to_unit_f64};

/// PCG-XSH-RR 64/32 (O'Neill 2014): 64 bits of state, period 2^64, 2^63 streams.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pcg32 {
    state: u64,
    increment: u64,
}

impl Pcg32 {
    const MULTIPLIER: u64 = 6_364_136_223_846_793_005;

    /// The generator `stream`, started at `seed`.
    #[inline]
    pub const fn new(seed: u64, stream: u64) -> Self {
        let increment = (stream << 1) | 1;
        let state = increment.wrapping_add(seed).wrapping_mul(Self::MULTIPLIER).wrapping_add(increment);
        Self { state, increment }
    }

    /// A generator keyed by a hash: state and stream both depend on all bits of `key`.
    #[inline(always)]
    pub const fn from_key(key: u64) -> Self {
        Self { state: key, increment: mix64(key) | 1 }
    }

    /// 32 random bits.
    #[inline(always)]
    pub const fn next_u32(&mut self) -> u32 {
        let old = self.state;
        self.state = old.wrapping_mul(Self::MULTIPLIER).wrapping_add(self.increment);
        let xorshifted = (((old >> 18) ^ old) >> 27) as u32;
        xorshifted.rotate_right((old >> 59) as u32)
    }

    /// 64 random bits.
    #[inline(always)]
    pub const fn next_u64(&mut self) -> u64 {
        let high = self.next_u32() as u64;
        (high << 32) | self.next_u32() as u64
    }

    /// Uniform in `[0, 1)`, a multiple of 2^-24.
    #[inline(always)]
    pub const fn next_f32(&mut self) -> f32 {
        to_unit_f32(self.next_u32())
    }

    /// Uniform in `[0, 1)`, a multiple of 2^-53.
    #[inline(always)]
    pub const fn next_f64(&mut self) -> f64 {
        to_unit_f64(self.next_u64())
    }

    /// Two uniform numbers in `[0, 1)`.
    #[inline(always)]
    pub const fn next_2d(&mut self) -> [f32; 2] {
        let x = self.next_f32();
        [x, self.next_f32()]
    }

    /// Uniform in `0..n`, without bias (Lemire 2019). `n` must not be zero.
    #[inline]
    pub const fn below(&mut self, n: u32) -> u32 {
        assert!(n > 0, "below(0) has no possible value");
        loop {
            let product = self.next_u32() as u64 * n as u64;
            if product as u32 >= n.wrapping_neg() % n {
                return (product >> 32) as u32;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_testkit::chi2_discrete;

    #[test]
    fn first_outputs_are_those_of_the_reference() {
        // pcg32_srandom(42, 54) of the published C implementation
        let mut rng = Pcg32::new(42, 54);
        let expected = [0xa15c_02b7, 0x7b47_f409, 0xba1d_3330, 0x83d2_f293, 0xbfa4_784b, 0xcbed_606e];
        assert_eq!(std::array::from_fn(|_| rng.next_u32()), expected);
    }

    #[test]
    fn numbers_and_pairs_are_uniform() {
        let mut rng = Pcg32::new(1, 2);
        let pair = |_: &mut _| Some(rng.next_2d().map(|x| (x * 32.0) as usize)).map(|[x, y]| 32 * x + y);
        chi2_discrete(pair, &[1.0 / 1024.0; 1024], 1_000_000, 0).assert_ok("pairs", 3);
        let mut rng = Pcg32::from_key(7);
        let below = |_: &mut _| Some(rng.below(7) as usize);
        chi2_discrete(below, &[1.0 / 7.0; 7], 1_000_000, 0).assert_ok("below", 3);
        // the first number of neighbouring keys, as a tracking loop seeds it
        let mut key = 0_u64;
        let first = |_: &mut _| {
            key += 1;
            Some((Pcg32::from_key(mix64(key)).next_f32() * 1000.0) as usize)
        };
        chi2_discrete(first, &[1e-3; 1000], 1_000_000, 0).assert_ok("keyed", 3);
    }
}
