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
