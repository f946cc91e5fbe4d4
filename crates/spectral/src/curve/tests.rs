//! Curves keep their values, their rules outside tables, and their bounds.

use super::*;
use crate::wavelengths::CONTINUUM;

fn at<const N: usize>(lambda: [f32; N]) -> Wavelengths<N> {
    Wavelengths { lambda, pdf: [1.0; N], line: [CONTINUUM; N] }
}

fn every_form() -> Vec<Curve> {
    let lambda = [380.0, 400.5, 555.25, 700.0];
    let values = [0.1, 0.9, 0.3, 0.7];
    let linear = Curve::linear(&lambda, &values, Outside::Hold).unwrap();
    let ramp: Vec<f32> = (0..471).map(|i| (i % 17) as f32).collect();
    let dense = Curve::dense(360, &ramp, Outside::Zero).unwrap();
    let sigmoid = SigmoidPolynomial { c: [12.0, -11.0, 2.0] };
    vec![
        Curve::Constant(0.7),
        linear.clone(),
        Curve::step(&lambda, &values[..3], Outside::Zero).unwrap(),
        dense.clone(),
        Curve::blackbody(5000.0).unwrap(),
        Curve::Sigmoid(sigmoid),
        Curve::ScaledSigmoid(3.0, sigmoid),
        linear.scaled(2.5),
        linear.times(&dense),
    ]
}

#[test]
fn sample_is_eval_per_lane() {
    for curve in every_form() {
        for start in [355.0f32, 400.25, 555.25, 690.0, 829.9] {
            let w = at::<8>(std::array::from_fn(|k| start + 1.7 * k as f32));
            let values = curve.sample(&w);
            for k in 0..8 {
                let expected = curve.eval(w.lambda[k]);
                assert!(
                    (values[k] - expected).abs() <= 1e-6 * expected.abs(),
                    "{curve:?} at {}",
                    w.lambda[k]
                );
            }
        }
    }
}

#[test]
fn bounds_contain_all_values() {
    for curve in every_form() {
        for range in [LambdaRange { min: 350.0, max: 840.0 }, LambdaRange { min: 401.3, max: 555.9 }] {
            let [low, high] = curve.bounds(range);
            for i in 0..=5000 {
                let v = curve.eval(range.min + range.width() * (i as f32 / 5000.0));
                assert!(v >= low - 1e-5 && v <= high + 1e-5, "{curve:?}: {v} not in [{low}, {high}]");
            }
        }
    }
}

#[test]
fn linear_tables_go_through_their_points_and_follow_the_rule_outside() {
    let lambda = [400.0, 410.0, 700.0];
    let values = [1.0, 2.0, 5.0];
    for (outside, below, above) in [(Outside::Hold, 1.0, 5.0), (Outside::Zero, 0.0, 0.0)] {
        let curve = Curve::linear(&lambda, &values, outside).unwrap();
        assert_eq!(curve.sample(&at([399.9, 400.0, 410.0, 700.1])).0, [below, 1.0, 2.0, above]);
        assert_eq!(curve.eval(405.0), 1.5);
        assert!((curve.eval(700.0) - 5.0).abs() < 1e-6);
    }
    let strict = Curve::linear(&lambda, &values, Outside::Error).unwrap();
    assert!(strict.eval(399.0).is_nan() && strict.eval(701.0).is_nan() && !strict.eval(400.0).is_nan());
}

#[test]
fn dense_and_linear_tables_agree() {
    let values: Vec<f32> = (0..101).map(|i| ((i * i) % 23) as f32).collect();
    let lambda: Vec<f32> = (0..101).map(|i| 500.0 + i as f32).collect();
    for outside in [Outside::Hold, Outside::Zero] {
        let dense = Curve::dense(500, &values, outside).unwrap();
        let linear = Curve::linear(&lambda, &values, outside).unwrap();
        for i in 0..4000 {
            let l = 480.0 + 0.035 * i as f32;
            assert!((dense.eval(l) - linear.eval(l)).abs() < 1e-3 * 23.0 / 100.0, "at {l}");
        }
        assert_eq!(dense.eval(600.0), values[100]);
    }
}

#[test]
fn even_points_become_a_dense_table_with_the_same_values() {
    for (first, step, n) in
        [(300.0f32, 5.0f32, 107usize), (0.0, 0.5, 2000), (401.25, 10.0, 2), (1000.0, 250.0, 40)]
    {
        let lambda: Vec<f32> = (0..n).map(|i| first + i as f32 * step).collect();
        let values: Vec<f32> = (0..n).map(|i| ((i * i * 7) % 31) as f32 / 31.0).collect();
        for outside in [Outside::Hold, Outside::Zero, Outside::Error] {
            let curve = Curve::linear(&lambda, &values, outside).unwrap();
            assert!(matches!(curve, Curve::Dense(_)));
            let plain = PiecewiseLinear::new(&lambda, &values, outside).unwrap();
            for i in 0..=n * 37 {
                let l = first + step * (i as f32 / 37.0 - 0.2);
                let (a, b) = (curve.eval(l), plain.eval(l));
                assert!((a - b).abs() < 2e-4 || (a.is_nan() && b.is_nan()), "{l}: {a} {b}");
            }
            for (l, v) in lambda.iter().zip(&values) {
                assert!((curve.eval(*l) - v).abs() < 1e-4, "{l}");
            }
            let beyond = [first.next_down(), lambda[n - 1].next_up()].map(|l| curve.eval(l));
            match outside {
                Outside::Hold => assert!(first == 0.0 || beyond == [values[0], values[n - 1]]),
                Outside::Zero => assert_eq!(beyond, [0.0; 2]),
                Outside::Error => assert!(beyond.iter().all(|v| v.is_nan())),
            }
        }
    }
}

#[test]
fn step_bands_are_closed_on_the_left() {
    let curve = Curve::step(&[400.0, 500.0, 600.0], &[1.0, 2.0], Outside::Zero).unwrap();
    assert_eq!(
        curve.sample(&at([399.9, 400.0, 499.9, 500.0, 600.0, 600.1])).0,
        [0.0, 1.0, 1.0, 2.0, 2.0, 0.0]
    );
}

#[test]
fn gaps_name_the_table_and_the_range_asked() {
    let film = LambdaRange::VISIBLE;
    let strict = Curve::linear(&[400.0, 700.0], &[1.0, 1.0], Outside::Error).unwrap();
    let zero = Curve::linear(&[300.0, 820.0], &[1.0, 1.0], Outside::Zero).unwrap();
    let gap = zero.check_range(film).unwrap().unwrap();
    assert_eq!((gap.asked, gap.table.max, gap.outside), (film, 820.0, Outside::Zero));
    assert!(zero.check_range(LambdaRange { min: 400.0, max: 700.0 }).unwrap().is_none());
    let error = zero.times(&strict).scaled(2.0).check_range(film).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the table covers 400 to 700 nm, but 360 to 830 nm is asked; outside it the value is not defined"
    );
    assert_eq!(zero.times(&strict).range(), Some(LambdaRange { min: 400.0, max: 700.0 }));
    assert!(Curve::blackbody(3000.0).unwrap().check_range(film).unwrap().is_none());
}

#[test]
fn baking_is_exact_or_says_how_far_off() {
    let range = LambdaRange { min: 380.0, max: 780.0 };
    let whole = Curve::linear(&[380.0, 400.0, 780.0], &[0.0, 2.0, 1.0], Outside::Zero).unwrap().scaled(3.0);
    let table = whole.bake(range).unwrap();
    assert!(matches!(table, Curve::Dense(_)));
    for i in 0..=4000 {
        let l = 380.0 + 0.1 * i as f32;
        assert!((table.eval(l) - whole.eval(l)).abs() < 1e-5);
    }
    let halves = Curve::linear(&[380.0, 400.5, 780.0], &[0.0, 2.0, 1.0], Outside::Zero).unwrap();
    assert!(halves.bake(range).is_none());
    let baked = halves.bake_approximate(range).unwrap();
    assert!(baked.max_error > 0.01 && baked.max_error < 0.06, "{}", baked.max_error);
    assert!(Curve::linear(&[400.0, 500.0], &[1.0, 1.0], Outside::Hold).unwrap().bake(range).is_none());
}

#[test]
fn nonsense_is_refused() {
    assert!(matches!(
        Curve::linear(&[400.0, 500.0], &[1.0], Outside::Hold),
        Err(SpectralError::Length { expected: 2, got: 1 })
    ));
    assert!(matches!(
        Curve::linear(&[400.0, 500.0], &[1.0, f32::INFINITY], Outside::Hold),
        Err(SpectralError::Value { .. })
    ));
    assert!(Curve::interleaved(&[400.0, 1.0, 500.0], Outside::Hold).is_err());
    assert!(Curve::dense(400, &[1.0], Outside::Hold).is_err());
    assert!(Curve::step(&[400.0, 500.0], &[1.0, 2.0], Outside::Hold).is_err());
}

proptest::proptest! {
    #[test]
    fn any_table_is_straight_between_its_points(
        gaps in proptest::collection::vec((0.01f32..40.0, -5.0f32..5.0), 2..60),
        at in 0.0f32..1.0,
    ) {
        let mut l = 200.0;
        let lambda: Vec<f32> = gaps.iter().map(|g| { l += g.0; l }).collect();
        let values: Vec<f32> = gaps.iter().map(|g| g.1).collect();
        let curve = Curve::linear(&lambda, &values, Outside::Hold).unwrap();
        let l = 190.0 + at * (lambda[lambda.len() - 1] - 180.0);
        let i = lambda.partition_point(|&k| k <= l);
        let expected = match i {
            0 => values[0],
            i if i == lambda.len() => values[i - 1],
            i => {
                let t = f64::from(l - lambda[i - 1]) / f64::from(lambda[i] - lambda[i - 1]);
                (f64::from(values[i - 1]) * (1.0 - t) + f64::from(values[i]) * t) as f32
            }
        };
        // values up to 5, some roundings of 3e-7
        proptest::prop_assert!((curve.eval(l) - expected).abs() < 5e-6, "{} {}", curve.eval(l), expected);
    }
}
