use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// `tan(pi / 8)`.
const TAN_PI_8: f64 = 0.414_213_562_373_095_03;

/// `atan t` for `0 <= t <= 1`, to about 30 bits.
#[inline(always)]
fn atan_unit(t: f64) -> f64 {
    // beyond pi / 8: atan t = pi / 4 + atan((t - 1) / (t + 1))
    let steep = t > TAN_PI_8;
    let r = if steep { (t - 1.0) / (t + 1.0) } else { t };
    let base = if steep { FRAC_PI_4 } else { 0.0 };
    let z = r * r;
    let p = -0.333_333_151_719_128_65
        + z * (0.199_984_704_052_075_08
            + z * (-0.142_435_109_754_119_53
                + z * (0.105_936_391_013_324_54 + z * -0.060_777_574_164_558_45)));
    base + (r + r * z * p)
}

/// Arc tangent in radians, within 0.52 ulp.
#[inline(always)]
pub fn atan(x: f32) -> f32 {
    let t = f64::from(x.abs());
    let inverted = t > 1.0;
    let a = atan_unit(if inverted { 1.0 / t } else { t });
    ((if inverted { FRAC_PI_2 - a } else { a }) as f32).copysign(x)
}

/// The angle of the point `(x, y)` in `[-pi, pi]` radians; signed zeros and infinities as in C99.
#[inline(always)]
pub fn atan2(y: f32, x: f32) -> f32 {
    let (ay, ax) = (f64::from(y.abs()), f64::from(x.abs()));
    let (small, large) = if ay > ax { (ax, ay) } else { (ay, ax) };
    let equal = if ay.is_nan() || ax.is_nan() { f64::NAN } else { small };
    // 0/0 and inf/inf have limits along the axes and the diagonal
    let t = if small == large { f64::from(u8::from(small != 0.0)) } else { equal / large };
    let a = atan_unit(t);
    let a = if ay > ax { FRAC_PI_2 - a } else { a };
    let a = if x.is_sign_negative() { PI - a } else { a };
    (a as f32).copysign(y)
}

/// `asin t` for `|t| <= 1/2`, to about 31 bits.
#[inline(always)]
fn asin_half(t: f64) -> f64 {
    let z = t * t;
    let p = 0.166_666_599_912_454_27
        + z * (0.075_005_041_938_254_46
            + z * (0.044_516_953_099_322_48
                + z * (0.031_807_735_603_740_37
                    + z * (0.014_438_543_413_659_55 + z * 0.037_516_530_822_194_01))));
    t + t * z * p
}

/// Arc sine in radians, within 0.52 ulp; NaN outside `[-1, 1]`.
#[inline(always)]
pub fn asin(x: f32) -> f32 {
    let a = f64::from(x.abs());
    let y = if a > 0.5 { FRAC_PI_2 - 2.0 * asin_half((0.5 * (1.0 - a)).sqrt()) } else { asin_half(a) };
    (y as f32).copysign(x)
}

/// Arc cosine in `[0, pi]` radians, within 0.52 ulp; NaN outside `[-1, 1]`.
#[inline(always)]
pub fn acos(x: f32) -> f32 {
    let x = f64::from(x);
    let a = x.abs();
    let outer = a > 0.5;
    let s = asin_half(if outer { (0.5 * (1.0 - a)).sqrt() } else { x });
    // acos x = 2 asin sqrt((1 - x) / 2) near 1, its mirror image near -1
    let edge = if x < 0.0 { PI - 2.0 * s } else { 2.0 * s };
    (if outer { edge } else { FRAC_PI_2 - s }) as f32
}
