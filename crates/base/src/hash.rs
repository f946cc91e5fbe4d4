//! Counter-based random numbers: a pure function of pixel, sample and dimension, so that work may be split anyhow.
//!
//! The mixer is the finaliser of SplitMix64 (Steele, Lea & Flood 2014) with the constants of D. Stafford's variant 13.

/// A bijection of 64-bit words in which each input bit flips each output bit with probability near 1/2.
#[inline(always)]
pub const fn mix64(mut x: u64) -> u64 {
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// The golden ratio in 64-bit fixed point: keeps zero from being a fixed point of the hashes below.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

#[inline(always)]
const fn pair(a: u32, b: u32) -> u64 {
    ((a as u64) << 32) | b as u64
}

/// 64 random bits of two words.
#[inline(always)]
pub const fn hash2_u64(a: u32, b: u32) -> u64 {
    mix64(pair(a, b).wrapping_add(GOLDEN))
}

/// 64 random bits of three words.
#[inline(always)]
pub const fn hash3_u64(a: u32, b: u32, c: u32) -> u64 {
    hash4_u64(a, b, c, 0)
}

/// 64 random bits of four words.
#[inline(always)]
pub const fn hash4_u64(a: u32, b: u32, c: u32, d: u32) -> u64 {
    mix64(hash2_u64(a, b).wrapping_add(mix64(pair(c, d) ^ GOLDEN)))
}

/// 32 random bits of two words.
#[inline(always)]
pub const fn hash2(a: u32, b: u32) -> u32 {
    (hash2_u64(a, b) >> 32) as u32
}

/// 32 random bits of three words.
#[inline(always)]
pub const fn hash3(a: u32, b: u32, c: u32) -> u32 {
    (hash3_u64(a, b, c) >> 32) as u32
}

/// 32 random bits of four words.
#[inline(always)]
pub const fn hash4(a: u32, b: u32, c: u32, d: u32) -> u32 {
    (hash4_u64(a, b, c, d) >> 32) as u32
}

/// The upper 24 bits as a number in `[0, 1)`, a multiple of 2^-24; never 1.
#[inline(always)]
pub const fn to_unit_f32(bits: u32) -> f32 {
    (bits >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// The upper 53 bits as a number in `[0, 1)`, a multiple of 2^-53; never 1.
#[inline(always)]
pub const fn to_unit_f64(bits: u64) -> f64 {
    (bits >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_testkit::{Rng, chi2_discrete, z_max};

    #[test]
    fn every_input_bit_flips_every_output_bit_half_the_time() {
        const TRIALS: u32 = 4000;
        let mut rng = Rng::new(1);
        let mut flips = [[0_u32; 64]; 128];
        for _ in 0..TRIALS {
            let words: [u32; 4] = std::array::from_fn(|_| rng.u32());
            let hash = |[a, b, c, d]: [u32; 4]| hash4_u64(a, b, c, d);
            let before = hash(words);
            for (bit, row) in flips.iter_mut().enumerate() {
                let mut other = words;
                other[bit / 32] ^= 1 << (bit % 32);
                let changed = before ^ hash(other);
                row.iter_mut().enumerate().for_each(|(i, count)| *count += (changed >> i) as u32 & 1);
            }
        }
        let sigma = (f64::from(TRIALS) / 4.0).sqrt();
        let worst = flips.iter().flatten().map(|&c| (f64::from(c) - f64::from(TRIALS) / 2.0).abs() / sigma);
        let worst = worst.fold(0.0, f64::max);
        assert!(worst < z_max(64 * 128), "{worst} standard deviations");
    }

    #[test]
    fn neighbouring_counters_give_uniform_numbers() {
        // pixel, sample and dimension as a renderer counts them
        let mut counter = 0_u32;
        let draw = |_: &mut Rng| {
            counter += 1;
            Some((to_unit_f32(hash4(counter % 64, counter / 64 % 64, counter / 4096, 3)) * 1000.0) as usize)
        };
        chi2_discrete(draw, &[1e-3; 1000], 1_000_000, 2).assert_ok("hash4", 3);
        let mut counter = 0_u32;
        let draw = |_: &mut Rng| {
            counter += 1;
            Some(hash2(counter, 0) as usize % 1000)
        };
        chi2_discrete(draw, &[1e-3; 1000], 1_000_000, 3).assert_ok("hash2", 3);
        let mut counter = 0_u32;
        let draw = |_: &mut Rng| {
            counter += 1;
            // pairs of numbers from neighbouring counters
            Some((hash3(1, 2, counter) >> 27) as usize * 32 + (hash3(1, 2, counter + 1) >> 27) as usize)
        };
        chi2_discrete(draw, &[1.0 / 1024.0; 1024], 1_000_000, 4).assert_ok("pairs of hash3", 3);
    }

    #[test]
    fn unit_numbers_never_reach_one() {
        assert_eq!(to_unit_f32(u32::MAX), 1.0 - f32::EPSILON / 2.0);
        assert_eq!(to_unit_f64(u64::MAX), 1.0 - f64::EPSILON / 2.0);
        assert_eq!((to_unit_f32(255), to_unit_f32(256)), (0.0, f32::EPSILON / 2.0));
    }

    #[test]
    fn golden_bits() {
        // SplitMix64 started at 0 (Vigna's reference): its first outputs
        assert_eq!(mix64(GOLDEN), 0xe220_a839_7b1d_cdaf);
        assert_eq!(mix64(GOLDEN.wrapping_mul(2)), 0x6e78_9e6a_a1b9_65f4);
        let all = (0..1000_u32)
            .fold(0, |h, i| mix64(h ^ hash2_u64(i, h as u32) ^ hash4_u64(i, i + 1, 7, h as u32)));
        assert_eq!(all, 0xe09d_3899_429e_81ae, "{all:#018x}");
    }
}
