//! A picture whose truth and noise are known.

use super::*;
use tyndall_testkit::Rng;

const SIZE: usize = 96;
/// Samples a pixel.
const SAMPLES: u32 = 16;
/// Brightness of the three channels, as far apart as those of coloured light.
const TINT: [f32; 3] = [0.2, 1.0, 7.0];
/// Column of an upright edge, from 1 to 3, in the lower half.
const EDGE: usize = 40;

/// A gradient above; below an edge, and to its right stripes eight pixels wide.
fn truth(x: usize, y: usize) -> f32 {
    match (x, y) {
        (_, 0..48) => 0.5 + 2.0 * x as f32 / SIZE as f32,
        (0..EDGE, _) => 1.0,
        (EDGE..64, _) => 3.0,
        _ => 3.0 - 2.0 * (x / 8 % 2) as f32,
    }
}

/// Means of exponential samples, with the errors that these samples tell: noise as large as the light, with a tail.
fn noisy() -> Noisy {
    let mut rng = Rng::new(11);
    let mut planes = vec![(Vec::new(), Vec::new()); 3];
    for p in 0..SIZE * SIZE {
        for (c, (mean, se)) in planes.iter_mut().enumerate() {
            let level = f64::from(TINT[c] * truth(p % SIZE, p / SIZE));
            let n = f64::from(SAMPLES);
            let draws: Vec<f64> = (0..SAMPLES).map(|_| -level * (1.0 - rng.f64()).ln()).collect();
            let m = draws.iter().sum::<f64>() / n;
            let squares: f64 = draws.iter().map(|d| (d - m) * (d - m)).sum();
            mean.push(m as f32);
            se.push((squares / (n * (n - 1.0))).sqrt() as f32);
        }
    }
    let slices: Vec<(&[f32], &[f32])> = planes.iter().map(|(m, e)| (&m[..], &e[..])).collect();
    Noisy::new(SIZE, SIZE, &slices).expect("errors are known")
}

fn rms(plane: &[f32], tint: f32) -> f64 {
    let square = |(p, v): (usize, &f32)| f64::from(v - tint * truth(p % SIZE, p / SIZE)).powi(2);
    (plane.iter().enumerate().map(square).sum::<f64>() / plane.len() as f64).sqrt()
}

/// Two halvings of pixels that have half of their noise in common: `(1 + 15 / 2) / 16` of the variance is left.
#[test]
fn noise_that_squares_have_in_common_stays() {
    let plane = (&[1.0f32; 64][..], &[2.0f32; 64][..]);
    let noisy = Noisy::new(8, 8, &[plane]).expect("errors are known");
    let alone = noisy.clone().halved().halved();
    assert!(alone.channels[0].variance.iter().all(|v| *v == 4.0 / 16.0));
    let quarter = noisy.alike(4, 0.5).halved().halved();
    let expected = 4.0 * (1.0 + 15.0 * 0.5) / 16.0;
    assert!(quarter.channels[0].variance.iter().all(|v| (v / expected - 1.0).abs() < 1e-6));
    assert_eq!((quarter.square, quarter.correlation), (1, 0.0));
}

#[test]
fn the_error_falls_and_edges_stay() {
    let noisy = noisy();
    let clean = denoise(&noisy, 2).expect("threads");
    for c in 0..3 {
        let (before, after) = (rms(&noisy.channels[c].mean, TINT[c]), rms(&clean[c], TINT[c]));
        println!("channel {c}: {before} to {after}, {:.2} times less", before / after);
        assert!(before > 3.0 * after, "channel {c}: {before} to {after}");
        // the two columns at the edge, 40 rows of them: before, noise alone moves their difference by 0.13
        let column = |x: usize| (52..92).map(|y| clean[c][y * SIZE + x]).sum::<f32>() / 40.0 / TINT[c];
        let contrast = column(EDGE) - column(EDGE - 1);
        assert!((contrast - 2.0).abs() < 0.2, "channel {c}: contrast {contrast} of 2");
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let noisy = noisy();
    let one = denoise(&noisy, 1).expect("threads");
    for threads in [2, 3] {
        assert!(denoise(&noisy, threads).expect("threads") == one, "{threads} threads");
    }
}

#[test]
fn what_has_no_error_stays_to_the_bit() {
    let mut exact = noisy();
    exact.channels.iter_mut().for_each(|c| c.variance.fill(0.0));
    let clean = denoise(&exact, 2).expect("threads");
    assert!(clean.iter().zip(&exact.channels).all(|(plane, c)| *plane == c.mean));
    // sizes below the reach of the filter, and odd ones
    for (width, height) in [(1, 1), (3, 2), (17, 40), (35, 33)] {
        let plane: Vec<f32> = (0..width * height).map(|p| (p % 7) as f32).collect();
        let zero = vec![0.0; plane.len()];
        let small = Noisy::new(width, height, &[(&plane, &zero)]).expect("errors are known");
        assert!(denoise(&small, 1).expect("threads")[0] == plane, "{width} x {height}");
    }
}

/// A picture of 1 everywhere with errors of 0.1, but for one pixel.
fn with_pixel(mean: f32, se: f32) -> f32 {
    let at = 20 * 41 + 20;
    let (mut means, mut errors) = (vec![1.0; 41 * 41], vec![0.1; 41 * 41]);
    (means[at], errors[at]) = (mean, se);
    let noisy = Noisy::new(41, 41, &[(&means, &errors)]).expect("errors are known");
    denoise(&noisy, 1).expect("threads")[0][at]
}

#[test]
fn fireflies_go_and_small_lamps_stay() {
    let firefly = with_pixel(50.0, 49.0);
    assert!((firefly - 1.0).abs() < 0.01, "{firefly}");
    let lamp = with_pixel(50.0, 1.0);
    assert!((lamp - 50.0).abs() < 1.0, "{lamp}");
    assert!(with_pixel(f32::NAN, 0.1).is_nan() && with_pixel(f32::INFINITY, 0.1).is_infinite());
}

#[test]
fn pixels_without_errors_take_those_around_and_pictures_without_are_refused() {
    let unknown = with_pixel(1.3, f32::INFINITY);
    assert!((unknown - 1.0).abs() < 0.05, "{unknown}");
    let (plane, errors) = ([1.0; 4], [f32::INFINITY, f32::INFINITY, f32::NAN, 0.1]);
    let refused = Noisy::new(2, 2, &[(&plane, &errors)]).expect_err("three of four are unknown");
    assert!(refused.to_string().contains("3 of 4 pixels are unknown"), "{refused}");
    assert!(Noisy::new(2, 3, &[(&plane, &errors)]).is_err(), "of another size");
}
