//! Dimensions three and four from the direction numbers of Joe & Kuo ("Constructing Sobol sequences with better
//! two-dimensional projections", SIAM J. Sci. Comput. 30, 2008; table `new-joe-kuo-6`, rows d = 3 and d = 4).

/// Degree of the primitive polynomial, its inner coefficients, and the first `m_k`.
struct Polynomial {
    degree: usize,
    inner: u32,
    m: [u32; 3],
}

const THIRD: Polynomial = Polynomial { degree: 2, inner: 0b1, m: [1, 3, 0] };
const FOURTH: Polynomial = Polynomial { degree: 3, inner: 0b01, m: [1, 3, 1] };

impl Polynomial {
    /// The 32 direction numbers `m_k / 2^k` as 32-bit fractions in reversed bit order:
    /// `m_k = 2 a_1 m_(k-1) ^ 4 a_2 m_(k-2) ^ ... ^ 2^s m_(k-s) ^ m_(k-s)`.
    const fn reversed_directions(&self) -> [u32; 32] {
        let s = self.degree;
        let mut v = [0_u32; 32];
        let mut k = 0;
        while k < 32 {
            // on fractions v_k = m_k / 2^k the powers of two become shifts to the right
            v[k] = if k < s { self.m[k] << (31 - k) } else { v[k - s] ^ (v[k - s] >> s) };
            let mut i = 1;
            while k >= s && i < s {
                if (self.inner >> (s - 1 - i)) & 1 == 1 {
                    v[k] ^= v[k - i];
                }
                i += 1;
            }
            k += 1;
        }
        k = 0;
        while k < 32 {
            v[k] = v[k].reverse_bits();
            k += 1;
        }
        v
    }
}

/// For each of the eight hexadecimal digits of the index and each value: both dimensions' sums of direction numbers,
/// the third in the lower half. One kilobyte.
const TABLE: [[u64; 16]; 8] = {
    let (z, w) = (THIRD.reversed_directions(), FOURTH.reversed_directions());
    let mut table = [[0; 16]; 8];
    let mut entry = 0;
    while entry < 128 {
        let (digit, value) = (entry / 16, entry % 16);
        let mut bit = 0;
        while bit < 4 {
            if (value >> bit) & 1 == 1 {
                let k = 4 * digit + bit;
                table[digit][value] ^= ((w[k] as u64) << 32) | z[k] as u64;
            }
            bit += 1;
        }
        entry += 1;
    }
    table
};

/// The third and fourth Sobol dimension of a point, in reversed bit order.
#[inline(always)]
pub(super) fn higher_dimensions(index: u32) -> [u32; 2] {
    let mut sum = 0;
    for (digit, row) in TABLE.iter().enumerate() {
        sum ^= row[((index >> (4 * digit)) & 15) as usize];
    }
    [sum as u32, (sum >> 32) as u32]
}
