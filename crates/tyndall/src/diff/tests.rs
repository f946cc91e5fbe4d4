//! Verdicts on images whose truth is known.

use super::*;
use tyndall_base::rng::Pcg32;
use tyndall_files::image::{MetaValue, Pixels};

const SIDE: usize = 32;

fn normal(rng: &mut Pcg32) -> f64 {
    (0..12).map(|_| f64::from(rng.next_f32())).sum::<f64>() - 6.0
}

/// Mean and its standard error.
fn mean_and_error(x: &[f64]) -> (f32, f32) {
    let n = x.len() as f64;
    let mean = x.iter().sum::<f64>() / n;
    let variance = x.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0) / n;
    (mean as f32, variance.sqrt() as f32)
}

/// Means of `n` normal samples a pixel around `truth`, with their standard errors as estimated.
fn noisy(seed: u64, n: usize, truth: impl Fn(usize) -> f64) -> Image {
    let mut rng = Pcg32::new(seed, 1);
    let pixel = |p| mean_and_error(&(0..n).map(|_| truth(p) + 0.5 * normal(&mut rng)).collect::<Vec<_>>());
    let (values, errors) = (0..SIDE * SIDE).map(pixel).unzip();
    image(values, Some((errors, n as i32 - 1)))
}

/// What an image tells of pixels that share paths.
#[derive(Clone, Copy, PartialEq)]
enum Told {
    Nothing,
    Squares,
    /// And the errors of their means.
    Errors,
}

/// Means of 8 normal samples a pixel around 1; half of the variance is common to the pixels of a square of 4 x 4.
fn shared(seed: u64, told: Told) -> Image {
    const SQUARE: usize = 4;
    let mut rng = Pcg32::new(seed, 1);
    let squares: Vec<f64> = (0..8 * SIDE * SIDE / SQUARE / SQUARE).map(|_| normal(&mut rng)).collect();
    let square = |p: usize| p / SIDE / SQUARE * (SIDE / SQUARE) + p % SIDE / SQUARE;
    let mut sums = vec![0.0; squares.len()];
    let mut pixel = |p: usize| {
        let common = 8 * square(p);
        let x: Vec<f64> =
            (common..common + 8).map(|k| 1.0 + 0.35 * (squares[k] + normal(&mut rng))).collect();
        x.iter().zip(&mut sums[common..]).for_each(|(x, sum)| *sum += x / (SQUARE * SQUARE) as f64);
        mean_and_error(&x)
    };
    let (values, errors) = (0..SIDE * SIDE).map(&mut pixel).unzip();
    let mut image = image(values, Some((errors, 7)));
    let planes = image.errors.as_mut().expect("errors are there");
    if told != Told::Nothing {
        planes.set(crate::image::attribute::SQUARE, SQUARE as i32);
    }
    if told == Told::Errors {
        let of = |p: usize| mean_and_error(&sums[8 * square(p)..][..8]).1;
        planes
            .push(statistics::square_name("Y"), (0..SIDE * SIDE).map(of).collect())
            .expect("the right size");
    }
    image
}

fn image(values: Vec<f32>, errors: Option<(Vec<f32>, i32)>) -> Image {
    let frame = |plane: Vec<f32>| {
        let mut pixels = Pixels::new(SIDE, SIDE);
        pixels.push("Y", plane).expect("the right size");
        pixels
    };
    let mut values = frame(values);
    if let Some((_, dof)) = &errors {
        values.set(crate::image::attribute::FREEDOM, MetaValue::Int(*dof));
    }
    Image { values, errors: errors.map(|(e, _)| frame(e)) }
}

#[test]
fn equal_truths_agree_at_the_stated_rate() {
    let options = DiffOptions { alpha: 0.05, ..DiffOptions::default() };
    let runs = 200;
    let differ = (0..runs)
        .filter(|&seed| {
            let d = diff(&noisy(2 * seed, 8, |_| 1.0), &noisy(2 * seed + 1, 8, |_| 1.0), &options)
                .expect("comparable");
            d.verdict == Verdict::Differ
        })
        .count();
    // Holm holds the rate at or below 5 %: more than 20 of 200 has a probability of 0.1 % under a rate of 5 %
    assert!(differ <= 20, "{differ} of {runs}");
}

/// Pixels that share paths: taken as independent they cry wolf; with the errors of squares, blocks and the whole image have
/// the scores that they should; without, errors are upper bounds.
#[test]
fn squares_that_share_paths_count_as_one() {
    let options = DiffOptions { alpha: 0.05, ..DiffOptions::default() };
    let runs = 100;
    let found = |told: Told| {
        let (mut differ, mut t, mut rms) = (0, 0.0, 0.0);
        for seed in 0..runs {
            let d = diff(&shared(2 * seed, told), &shared(2 * seed + 1, told), &options).expect("comparable");
            let tests = d.channels[0].tests.as_ref().expect("errors are known");
            differ += u32::from(d.verdict == Verdict::Differ);
            t += tests.t * tests.t / runs as f64;
            rms += tests.rms_t * tests.rms_t / runs as f64;
        }
        (differ, t, rms)
    };
    // of 100 squared scores of the whole image the mean is known to 14 %; of 1600 of blocks, with 14 to 56 degrees of
    // freedom in place of 56, to 4 %
    let (differ, t, rms) = found(Told::Errors);
    assert!(differ <= 13 && (t - 1.0).abs() < 0.6 && (rms - 1.0).abs() < 0.2, "{differ} {t} {rms}");
    let (differ, t, rms) = found(Told::Squares);
    assert!(differ <= 2 && t < 0.9 && (0.3..0.8).contains(&rms), "{differ} {t} {rms}");
    let (differ, t, rms) = found(Told::Nothing);
    assert!(differ > 50 && t > 4.0 && rms > 4.0, "{differ} {t} {rms}");
}

#[test]
fn a_small_bias_and_a_wrong_block_are_found() {
    let reference = noisy(1, 16, |_| 1.0);
    let biased = diff(&noisy(2, 16, |_| 1.03), &reference, &DiffOptions::default()).expect("comparable");
    assert_eq!(biased.verdict, Verdict::Differ);
    assert!((biased.channels[0].bias.expect("not black") - 0.03).abs() < 0.02);
    let block = |p: usize| if p % SIDE < 8 && p / SIDE < 8 { 1.2 } else { 1.0 };
    let local = diff(&noisy(3, 16, block), &reference, &DiffOptions::default()).expect("comparable");
    let tests = local.channels[0].tests.as_ref().expect("errors are known");
    assert_eq!((local.verdict, tests.worst_at), (Verdict::Differ, [0, 0]));
}

#[test]
fn measures_by_hand() {
    let a = image(vec![1.5; SIDE * SIDE], None);
    let b = image(vec![1.0; SIDE * SIDE], None);
    let d = diff(&a, &b, &DiffOptions::default()).expect("comparable");
    let c = &d.channels[0];
    assert_eq!((c.mse, c.rmse, c.rel_mse, c.bias), (0.25, 0.5, 0.25, Some(0.5)));
    assert_eq!(d.verdict, Verdict::Unknown);
    assert_eq!(diff(&a, &a, &DiffOptions::default()).expect("comparable").verdict, Verdict::Identical);
    let scaled =
        diff(&a, &b, &DiffOptions { scale: 2.0 / 3.0, ..DiffOptions::default() }).expect("comparable");
    assert!(scaled.channels[0].mse < 1e-12);
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let a = image(vec![1.0; SIDE * SIDE], None);
    let mut small = Pixels::new(2, 1);
    small.push("Y", vec![0.0; 2]).expect("the right size");
    let small = Image { values: small, errors: None };
    let text = diff(&a, &small, &DiffOptions::default()).expect_err("sizes").to_string();
    assert!(text.contains("32 x 32") && text.contains("2 x 1"), "{text}");
    let mut other = Pixels::new(SIDE, SIDE);
    other.push("Z", vec![0.0; SIDE * SIDE]).expect("the right size");
    let other = Image { values: other, errors: None };
    assert!(
        diff(&a, &other, &DiffOptions::default()).expect_err("channels").to_string().contains("no channel")
    );
}
