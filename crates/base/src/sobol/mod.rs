//! Owen-scrambled, shuffled Sobol points in one, two and four dimensions, for sample indices up to 2^32.
//!
//! A call with another `seed` gives an independent randomisation of the same net, so that high dimensions are padded
//! from blocks of 1, 2 and 4 (Burley 2020, "Practical Hash-based Owen Scrambling", JCGT 9(4)). Each point is
//! uniform; the first 2^m points (and each aligned block of 2^m) of a two-dimensional block are a (0, m, 2)-net in base 2.
//!
//! Scrambling is the Laine-Karras hash on the reversed bits with the constants of N. Vegdahl ("Building a Better LK
//! Hash", 2021). Everything before the last step stays in reversed bit order: the first two dimensions are then the index
//! itself and its product with Pascal's triangle modulo 2, five steps; dimensions 3 and 4 take eight table look-ups.

mod directions;
#[cfg(test)]
mod tests;

use crate::hash::{hash2_u64, to_unit_f32};
use directions::higher_dimensions;

/// A sample's index in every Sobol block it draws from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SobolIndex {
    /// The index with its bits reversed, once for all blocks.
    reversed: u32,
    /// The same of the number among those who share a net.
    member: u32,
    sharers: Sharers,
}

/// How many share a net; see [`SobolIndex::shared`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sharers {
    /// Nobody else.
    One,
    /// 16.
    Sixteen,
    /// 64.
    SixtyFour,
}

impl SobolIndex {
    /// The sample number `index` of a pixel (or of whatever has a net of its own).
    #[inline(always)]
    pub const fn new(index: u32) -> Self {
        Self { reversed: index.reverse_bits(), member: 0, sharers: Sharers::One }
    }

    /// The sample number `index`, below 2^26, of pixel `k` of several that share a net: the points of each are a net, and
    /// those of all are a net as many times as dense.
    ///
    /// With n pixels point `index` of pixel `k` is number `n index + (k ^ M index)` of the sequence, `M` a matrix of bits.
    /// The points of one pixel are then a digital net whose matrices are those of Sobol with the rows of `M` put before; its
    /// columns were found one after the other such that the first 2^m points of a pixel are a (0, m, 2)-net for each m up
    /// to 24.
    #[inline(always)]
    pub const fn shared(index: u32, k: u32, sharers: Sharers) -> Self {
        Self { reversed: index.reverse_bits(), member: k.reverse_bits(), sharers }
    }

    /// A number in `[0, 1)`, a multiple of 2^-24.
    #[inline(always)]
    pub fn d1(self, seed: u32) -> f32 {
        let h = key(seed);
        let x = owen(self.shuffled(h), h as u32);
        to_unit_f32(x.reverse_bits())
    }

    /// A point of the unit square; components are multiples of 2^-24 below one.
    #[inline(always)]
    pub fn d2(self, seed: u32) -> [f32; 2] {
        let h = key(seed);
        let x = self.shuffled(h);
        finish(owen(x, h as u32), owen(pascal(x), derived(h, 1)))
    }

    /// A point of the unit hypercube; components are multiples of 2^-24 below one.
    #[inline(always)]
    pub fn d4(self, seed: u32) -> [f32; 4] {
        let h = key(seed);
        let x = self.shuffled(h);
        let [z, w] = higher_dimensions(x);
        let [a, b] = finish(owen(x, h as u32), owen(pascal(x), derived(h, 1)));
        let [c, d] = finish(owen(z, derived(h, 2)), owen(w, derived(h, 3)));
        [a, b, c, d]
    }

    /// The index under a random permutation that keeps aligned blocks of 2^m together.
    #[inline(always)]
    fn shuffled(self, h: u64) -> u32 {
        let index = owen(self.reversed, (h >> 32) as u32).reverse_bits();
        // pixels change places, too, in the same manner
        let k = || owen(self.member, derived(h, 3)).reverse_bits();
        match self.sharers {
            Sharers::One => index,
            Sharers::Sixteen => index << 4 | (k() ^ times(&OF_16, index)) & 15,
            Sharers::SixtyFour => index << 6 | (k() ^ times(&OF_64, index)) & 63,
        }
    }
}

/// [`SobolIndex::d1`] of one index.
#[inline(always)]
pub fn sobol_1d(index: u32, seed: u32) -> f32 {
    SobolIndex::new(index).d1(seed)
}

/// [`SobolIndex::d2`] of one index.
#[inline(always)]
pub fn sobol_2d(index: u32, seed: u32) -> [f32; 2] {
    SobolIndex::new(index).d2(seed)
}

/// [`SobolIndex::d4`] of one index.
#[inline(always)]
pub fn sobol_4d(index: u32, seed: u32) -> [f32; 4] {
    SobolIndex::new(index).d4(seed)
}

/// Products of the matrices `M` of [`SobolIndex::shared`] with the lowest three bytes of an index.
type Places = [[u8; 256]; 3];
static OF_16: Places = places([3, 1, 12, 4, 2, 3, 8, 12, 1, 2, 4, 8, 3, 1, 12, 4, 2, 3, 8, 12, 1, 2, 4, 8]);
static OF_64: Places =
    places([3, 1, 5, 13, 48, 16, 19, 18, 8, 5, 53, 37, 1, 19, 27, 30, 16, 53, 52, 39, 5, 27, 11, 62]);

/// Of the matrix with these columns.
const fn places(columns: [u8; 24]) -> Places {
    let mut places = [[0; 256]; 3];
    let mut i = 0;
    while i < 3 * 256 * 8 {
        let (byte, value, bit) = (i / 2048, i / 8 % 256, i % 8);
        if value >> bit & 1 != 0 {
            places[byte][value] ^= columns[8 * byte + bit];
        }
        i += 1;
    }
    places
}

/// The product of a matrix of bits and `index`.
#[inline(always)]
fn times(places: &Places, index: u32) -> u32 {
    let of = |byte: usize| places[byte][(index >> (8 * byte) & 0xff) as usize];
    u32::from(of(0) ^ of(1) ^ of(2))
}

/// 64 random bits of a seed: the upper half shuffles the index, the lower scrambles the first dimension.
#[inline(always)]
const fn key(seed: u32) -> u64 {
    hash2_u64(seed, 0x50b0)
}

/// The scramble of a further dimension, by multiplicative hashing (Knuth 6.4) with odd constants far apart.
#[inline(always)]
const fn derived(h: u64, dimension: usize) -> u32 {
    const ODD: [u64; 4] = [1, 0x9e37_79b9_7f4a_7c15, 0xd6e8_feb8_6659_fd93, 0xa076_1d64_78bd_642f];
    (h.wrapping_mul(ODD[dimension]) >> 32) as u32
}

/// Nested uniform scramble of a number in reversed bit order: each bit is flipped by a hash of the more significant
/// digits, which lie below it here.
#[inline(always)]
const fn owen(mut x: u32, seed: u32) -> u32 {
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^ x.wrapping_mul(0x53a2_2864)
}

/// The second Sobol dimension in reversed bit order. Its digit j is the sum modulo 2 of `binomial(k, j)` times bit k of
/// the index, and `binomial(k, j)` is odd just when the bits of j are among those of k (Lucas 1878): a sum over
/// supersets, one halving step for each bit of k.
#[inline(always)]
const fn pascal(mut x: u32) -> u32 {
    x ^= x >> 16;
    x ^= (x >> 8) & 0x00ff_00ff;
    x ^= (x >> 4) & 0x0f0f_0f0f;
    x ^= (x >> 2) & 0x3333_3333;
    x ^ ((x >> 1) & 0x5555_5555)
}

/// Both numbers back in normal bit order, by one reversal of 64 bits, as numbers in `[0, 1)`.
#[inline(always)]
fn finish(x: u32, y: u32) -> [f32; 2] {
    let both = ((u64::from(x) << 32) | u64::from(y)).reverse_bits();
    [to_unit_f32(both as u32), to_unit_f32((both >> 32) as u32)]
}
