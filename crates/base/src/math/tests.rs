//! Errors in units of the last place against the platform's `f64` functions, special values, and golden bits.

use super::*;
use crate::hash::mix64;
use std::f32::consts::{FRAC_PI_2, LN_2, PI};
use tyndall_testkit::Rng;

/// `|y - exact|` in units of the last place of the `f32` nearest to `exact`.
fn ulps(y: f32, exact: Double) -> Double {
    let near = exact as f32;
    if near.is_infinite() || near.is_nan() {
        return if y.to_bits() == near.to_bits() || (y.is_nan() && near.is_nan()) { 0.0 } else { 1e9 };
    }
    let ulp = (near.abs().max(f32::MIN_POSITIVE).to_bits() & 0x7f80_0000).max(24 << 23) - (23 << 23);
    (Double::from(y) - exact).abs() / Double::from(f32::from_bits(ulp))
}

/// The worst error in ulp over 300,000 points of `[a, b]`, half of them spread over the exponents.
fn worst(a: f32, b: f32, f: impl Fn(f32) -> f32, exact: impl Fn(Double) -> Double) -> (Double, f32) {
    let mut rng = Rng::new(11);
    let mut worst = (0.0, 0.0);
    for i in 0..300_000 {
        let linear = a + (b - a) * rng.f32();
        let x = if i % 2 == 0 {
            linear
        } else {
            (linear.abs() * (2.0_f32).powi(-(rng.below(40) as i32))).copysign(linear)
        };
        let x = x.clamp(a, b);
        let e = ulps(f(x), exact(Double::from(x)));
        if e > worst.0 {
            worst = (e, x);
        }
    }
    worst
}

#[track_caller]
fn assert_ulps(name: &str, (e, x): (Double, f32), bound: Double) {
    assert!(e <= bound, "{name}({x:e}) is {e:.3} ulp off, stated bound {bound}");
}

type Double = ::std::primitive::f64;
type Function = fn(Double) -> Double;

#[test]
fn errors_stay_within_the_stated_bounds() {
    assert_ulps("exp", worst(-87.3, 88.7, exp, Double::exp), 1.5);
    assert_ulps("exp", worst(-1.0, 1.0, exp, Double::exp), 1.5);
    assert_ulps("ln", worst(0.0, 1.0, ln, Double::ln), 1.0);
    assert_ulps("ln", worst(0.5, 2.0, ln, Double::ln), 1.0);
    assert_ulps("ln", worst(0.0, f32::MAX, ln, Double::ln), 1.0);
    assert_ulps("sin", worst(-10.0, 10.0, sin, Double::sin), 0.51);
    assert_ulps("cos", worst(-10.0, 10.0, cos, Double::cos), 0.51);
    assert_ulps("sin", worst(-6e7, 6e7, sin, Double::sin), 0.51);
    assert_ulps("cos", worst(-6e7, 6e7, cos, Double::cos), 0.51);
    assert_ulps("sin", worst(-1e30, 1e30, sin, Double::sin), 1.0);
    assert_ulps("tan", worst(-1.6, 1.6, tan, Double::tan), 0.51);
    assert_ulps("tan", worst(-1e6, 1e6, tan, Double::tan), 0.51);
    assert_ulps("atan", worst(-20.0, 20.0, atan, Double::atan), 0.52);
    assert_ulps("asin", worst(-1.0, 1.0, asin, Double::asin), 0.52);
    assert_ulps("acos", worst(-1.0, 1.0, acos, Double::acos), 0.52);
    assert_ulps("atan2", worst(-5.0, 5.0, |x| atan2(x, -1.5), |x| x.atan2(-1.5)), 0.52);
    assert_ulps("atan2", worst(-5.0, 5.0, |x| atan2(0.7, x), |x| (0.7_f32 as Double).atan2(x)), 0.52);
    assert_ulps("pow", worst(0.0, 1e4, |x| pow(x, 2.4), |x| x.powf(Double::from(2.4_f32))), 0.6);
    assert_ulps("pow", worst(-30.0, 30.0, |y| pow(0.31, y), |y| Double::from(0.31_f32).powf(y)), 0.6);
    let turns = |u: Double| (u * ::std::f64::consts::TAU).sin();
    assert_ulps("sin_cos_turns", worst(0.0, 0.24, |u| sin_cos_turns(u).0, turns), 0.51);
}

#[test]
fn special_values() {
    let inf = f32::INFINITY;
    assert_eq!([exp(0.0), exp(-88.0), exp(-inf), exp(89.0), exp(inf)], [1.0, 0.0, 0.0, inf, inf]);
    assert!(exp(f32::NAN).is_nan() && exp(-87.336) > 0.0 && exp(88.722).is_finite());
    assert_eq!([ln(1.0), ln(0.0), ln(-0.0), ln(inf)], [0.0, -inf, -inf, inf]);
    assert!(ln(-1.0).is_nan() && ln(f32::NAN).is_nan() && ln(-inf).is_nan());
    assert_eq!(ln(f32::from_bits(1)), -149.0 * LN_2);
    assert_eq!(sin_cos(0.0), (0.0, 1.0));
    assert!(sin(inf).is_nan() && cos(f32::NAN).is_nan() && tan(-inf).is_nan());
    assert_eq!(
        [atan2(0.0, 1.0), atan2(0.0, -1.0), atan2(-0.0, -1.0), atan2(1.0, 0.0)],
        [0.0, PI, -PI, FRAC_PI_2]
    );
    assert_eq!([atan2(inf, inf), atan2(inf, 1.0), atan2(0.0, 0.0)], [PI / 4.0, FRAC_PI_2, 0.0]);
    assert!(atan2(f32::NAN, 1.0).is_nan() && atan2(1.0, f32::NAN).is_nan());
    assert_eq!(
        [acos(1.0), acos(-1.0), acos(0.0), asin(1.0), asin(-1.0)],
        [0.0, PI, FRAC_PI_2, FRAC_PI_2, -FRAC_PI_2]
    );
    assert!(acos(1.000_001).is_nan() && asin(-1.1).is_nan());
    assert_eq!([pow(0.0, 2.0), pow(2.0, -1.0), pow(-2.0, 3.0), pow(inf, 0.5)], [0.0, 0.5, -8.0, inf]);
    assert_eq!([pow(2.0, 200.0), pow(2.0, -200.0), pow(1.0, 1e30), pow(0.0, 0.0)], [inf, 0.0, 1.0, 1.0]);
}

#[test]
fn quarter_turns_are_exact() {
    let quarters = [0.0, 0.25, 0.5, 0.75, 1.0].map(sin_cos_turns);
    assert_eq!(quarters, [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0), (0.0, 1.0)]);
}

#[test]
fn lanes_equal_scalars() {
    let mut rng = Rng::new(3);
    for _ in 0..1000 {
        let x: [f32; 8] = std::array::from_fn(|_| rng.range(-90.0, 90.0) as f32);
        assert_eq!(exp_n(x), x.map(exp));
        let x = x.map(|v| v.abs());
        assert_eq!(ln_n(x), x.map(ln));
    }
}

/// A hash of `f`'s bits over a million inputs spread over all signs and exponents.
fn golden(f: impl Fn(f32) -> f32) -> u64 {
    (0..1_000_000_u32).fold(0, |h, i| {
        let y = f(f32::from_bits(i.wrapping_mul(4295)));
        // the payload of a NaN is not part of the promise
        mix64(h ^ u64::from(if y.is_nan() { 0x7fc0_0000 } else { y.to_bits() }))
    })
}

#[test]
fn bits_are_the_same_on_every_machine() {
    let hashes = [
        golden(exp),
        golden(ln),
        golden(sin),
        golden(cos),
        golden(tan),
        golden(atan),
        golden(asin),
        golden(acos),
        golden(|x| atan2(x, 0.37)),
        golden(|x| atan2(-1.5, x)),
        golden(|x| pow(x, 0.37)),
        golden(|x| pow(x, -3.1)),
        golden(|x| sin_cos_turns(x).1),
    ];
    assert_eq!(hashes, GOLDEN, "{hashes:#018x?}");
}

const GOLDEN: [u64; 13] = [
    0x06b4_7f73_a7d3_33e6,
    0x755d_1911_7799_fa9c,
    0x2711_e3cc_b117_a95b,
    0xfb0f_d2cd_f5e0_13e0,
    0x7035_ebc0_3fbe_08cd,
    0xe982_a0b5_541e_b602,
    0xa883_4ac6_b3a3_e15d,
    0x441e_6c2d_7d60_c9d6,
    0xd66c_b980_d6f2_6073,
    0xb305_aa90_ad07_0650,
    0xf841_bf4c_9287_b651,
    0x45b6_a1ff_00c7_93d9,
    0x7bce_ca4d_a296_0d70,
];

/// A hash of an `f64` function's bits over a hundred thousand inputs of moderate size.
fn golden_double(f: impl Fn(Double) -> Double) -> u64 {
    (0..100_000_u32).fold(0, |h, i| {
        let x = Double::from(f32::from_bits(0x3080_0000 + i * 1500)) * if i % 2 == 0 { 1.0 } else { -1.0 };
        let y = f(x);
        mix64(h ^ if y.is_nan() { 0 } else { y.to_bits() })
    })
}

#[test]
fn double_precision_bits_are_the_same_on_every_machine() {
    use super::f64 as double;
    let functions: [Function; 18] = [
        double::exp,
        double::exp_m1,
        double::ln,
        double::ln_1p,
        double::sin,
        double::cos,
        double::tan,
        double::asin,
        double::acos,
        double::atan,
        double::sinh,
        double::cosh,
        double::tanh,
        double::atanh,
        double::cbrt,
        double::erf,
        |x| double::pow(x.abs(), 0.37),
        |x| double::atan2(x, 0.7),
    ];
    let hashes = functions.map(golden_double);
    assert_eq!(hashes, GOLDEN_DOUBLE, "{hashes:#018x?}");
}

#[test]
fn double_precision_is_near_the_platform() {
    use super::f64 as double;
    let pairs: [[Function; 2]; 7] = [
        [double::exp, Double::exp],
        [double::ln, Double::ln],
        [double::sin, Double::sin],
        [double::tan, Double::tan],
        [double::acos, Double::acos],
        [double::cbrt, Double::cbrt],
        [double::tanh, Double::tanh],
    ];
    let mut rng = Rng::new(5);
    for _ in 0..10_000 {
        let x = rng.range(0.0, 1.0);
        for (i, [ours, platform]) in pairs.iter().enumerate() {
            let (a, b) = (ours(x), platform(x));
            assert!((a - b).abs() <= 4.0 * Double::EPSILON * b.abs(), "function {i} at {x}: {a} against {b}");
        }
    }
}

const GOLDEN_DOUBLE: [u64; 18] = [
    0x3f4a_dbef_c622_bceb,
    0x23bb_ace2_2e1b_76ba,
    0xd2f4_1f88_55f3_0052,
    0x0d10_2edd_1252_7d1c,
    0xd65b_8150_434c_0555,
    0xd7ee_e47f_0158_e6f7,
    0xdee8_2ea3_0ccb_1fb6,
    0xff71_097f_5306_e8fd,
    0x03d8_b76a_2554_4cac,
    0x1706_6202_d530_228c,
    0x5e44_5810_62ec_06ca,
    0xbf10_0073_1eff_04d9,
    0x20fa_8f6d_e00d_a65a,
    0x379e_5aa0_afdc_f03e,
    0x5195_d472_b977_6eca,
    0x6c6f_e2e6_85a5_992e,
    0x6b08_e5be_902f_67d8,
    0xf310_b868_7060_bee4,
];
