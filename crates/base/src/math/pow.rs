/// Adding 1.5 * 2^52 rounds an `f64` of modest size to an integer, kept in the low bits of the sum.
const ROUND: f64 = 6_755_399_441_055_744.0;
/// High word of `sqrt(1/2)`.
const SQRT_HALF: u64 = 0x3fe6_a09e_0000_0000;

/// `log2 x` for a positive, normal `x`, to about 50 bits.
#[inline(always)]
fn log2(x: f64) -> f64 {
    let offset = x.to_bits().wrapping_sub(SQRT_HALF);
    let e = ((offset as i64) >> 52) as i32;
    let m = f64::from_bits((offset & 0x000f_ffff_ffff_ffff) + SQRT_HALF);
    let s = (m - 1.0) / (m + 1.0);
    let z = s * s;
    let p = 0.961_796_693_924_323_6
        + z * (0.577_078_017_250_745
            + z * (0.412_198_401_399_080_6
                + z * (0.320_616_431_242_786_1
                    + z * (0.261_442_930_367_233_3 + z * 0.242_931_214_033_153_86))));
    f64::from(e) + s * (2.885_390_081_777_927_3 + z * p)
}

/// `2^t` for `|t| <= 1000`, to about 40 bits.
#[inline(always)]
fn exp2(t: f64) -> f64 {
    let n = t + ROUND;
    let r = t - (n - ROUND);
    let p = 0.055_504_109_394_307
        + r * (0.009_618_128_542_301_32
            + r * (0.001_333_345_197_604_634_5
                + r * (0.000_154_038_519_440_741_02
                    + r * (1.530_976_055_001_956e-5 + r * 1.317_585_309_939_078e-6))));
    let e_r = 0.999_999_999_999_762 + r * (0.693_147_180_546_492_2 + r * (0.240_226_506_988_843_4 + r * p));
    f64::from_bits(e_r.to_bits().wrapping_add(n.to_bits() << 52))
}

/// `x^y`, within 0.6 ulp; special values as in C99.
#[inline]
pub fn pow(x: f32, y: f32) -> f32 {
    if !(x > 0.0 && x < f32::INFINITY && y.abs() < f32::INFINITY) {
        return pow_special(x, y);
    }
    let t = f64::from(y) * log2(f64::from(x));
    exp2(t.clamp(-1000.0, 1000.0)) as f32
}

/// Zero, negative, infinite and NaN operands.
#[cold]
#[inline(never)]
fn pow_special(x: f32, y: f32) -> f32 {
    libm::powf(x, y)
}
