use std::f64::consts::{FRAC_2_PI, TAU};

/// Adding 1.5 * 2^52 rounds an `f64` of modest size to an integer, kept in the low bits of the sum.
const ROUND: f64 = 6_755_399_441_055_744.0;
/// `pi / 2` in three parts; the first two have 26 bits each, so products with a quadrant number below 2^26 are exact.
const HALF_PI: [f64; 3] = [1.570_796_310_901_641_8, 1.589_325_471_229_585_7e-8, 6.123_233_995_736_766e-17];
/// Quadrant numbers stay below 2^26 up to here; beyond, the argument needs more bits of pi.
const REDUCIBLE: f32 = 67_108_864.0;

/// `sin r` and `cos r` for `|r| <= pi / 4`, to about 40 bits.
#[inline(always)]
fn kernel(r: f64) -> (f64, f64) {
    let z = r * r;
    let s = -0.166_666_666_407_760_87
        + z * (0.008_333_329_302_392_6
            + z * (-0.000_198_393_114_780_460_77 + z * 2.718_114_055_221_864_6e-6));
    let c = 0.041_666_666_619_453_72
        + z * (-0.001_388_888_349_685_842
            + z * (2.479_945_930_969_512_6e-5 + z * -2.720_568_459_469_659_6e-7));
    (r + r * z * s, 1.0 - 0.5 * z + z * z * c)
}

/// Rotates `(sin r, cos r)` by `quadrant * pi / 2`.
#[inline(always)]
fn rotate(quadrant: u64, (s, c): (f64, f64)) -> (f64, f64) {
    let swap = quadrant & 1 != 0;
    let (a, b) = if swap { (c, s) } else { (s, c) };
    let sin = if quadrant & 2 != 0 { -a } else { a };
    let cos = if (quadrant + 1) & 2 != 0 { -b } else { b };
    (sin, cos)
}

/// The quadrant of `x` and the rest within `pi / 4` (Cody & Waite 1980).
#[inline(always)]
fn reduce(x: f32) -> (u64, f64) {
    let x = f64::from(x);
    let t = x * FRAC_2_PI + ROUND;
    let k = t - ROUND;
    (t.to_bits(), ((x - k * HALF_PI[0]) - k * HALF_PI[1]) - k * HALF_PI[2])
}

/// `(sin x, cos x)` of an angle in radians, within 0.51 ulp up to `|x| = 2^26` and 1 ulp beyond.
#[inline(always)]
pub fn sin_cos(x: f32) -> (f32, f32) {
    if x.abs() > REDUCIBLE {
        return sin_cos_huge(x);
    }
    let (quadrant, r) = reduce(x);
    let (s, c) = rotate(quadrant, kernel(r));
    (s as f32, c as f32)
}

#[cold]
#[inline(never)]
fn sin_cos_huge(x: f32) -> (f32, f32) {
    libm::sincosf(x)
}

/// `(sin 2 pi u, cos 2 pi u)`: exact reduction, so quarter turns give exact zeros and ones.
#[inline(always)]
pub fn sin_cos_turns(u: f32) -> (f32, f32) {
    let u = f64::from(u);
    let t = 4.0 * u + ROUND;
    let (s, c) = rotate(t.to_bits(), kernel((u - 0.25 * (t - ROUND)) * TAU));
    (s as f32, c as f32)
}

/// Sine of an angle in radians.
#[inline(always)]
pub fn sin(x: f32) -> f32 {
    sin_cos(x).0
}

/// Cosine of an angle in radians.
#[inline(always)]
pub fn cos(x: f32) -> f32 {
    sin_cos(x).1
}

/// Tangent of an angle in radians, within 0.51 ulp up to `|x| = 2^26`.
#[inline(always)]
pub fn tan(x: f32) -> f32 {
    if x.abs() > REDUCIBLE {
        return tan_huge(x);
    }
    let (quadrant, r) = reduce(x);
    let (s, c) = rotate(quadrant, kernel(r));
    (s / c) as f32
}

#[cold]
#[inline(never)]
fn tan_huge(x: f32) -> f32 {
    libm::tanf(x)
}
