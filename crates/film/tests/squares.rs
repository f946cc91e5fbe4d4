//! Pixels of a square that share their random numbers: errors of means over films and regions.
#![allow(clippy::unwrap_used)] // a failure here is a failed test

use std::sync::Arc;

use tyndall_film::{Developed, ErrorMode, Film, FilmSpec, Patch, PixelBounds, Squares, WorkUnit};
use tyndall_testkit::{Rng, Welford};

const SIDE: u32 = 4;
const SAMPLES: u32 = 32;
const SEEDS: u64 = 600;
/// The squares at the right and at the lower edge are cut.
const WINDOW: PixelBounds = PixelBounds::new(3, 5, 3 + 14, 5 + 10);
/// Four whole squares.
const WHOLE: PixelBounds = PixelBounds::new(7, 5, 15, 13);
/// Parts of four squares.
const CUT: PixelBounds = PixelBounds::new(9, 6, 13, 11);

/// Films of a pass whose pixels have mean 1 each: `share` of the variance of a sample is common to its square.
fn film(seed: u64, mode: ErrorMode, square: u32, share: f64) -> Film {
    let spec = FilmSpec { bounds: WINDOW, square, ..FilmSpec::xyz([40, 30], mode) };
    let spec = Arc::new(spec);
    let unit = WorkUnit { window: WINDOW, samples: 0..SAMPLES, round: 0 };
    let mut patch = Patch::new(&spec, unit);
    let mut rng = Rng::new(seed);
    let (common, own) = ((12.0 * share).sqrt(), (12.0 * (1.0 - share)).sqrt());
    for tile in WINDOW.tiles(SIDE) {
        for sample in 0..SAMPLES {
            let shared = common * (rng.f64() - 0.5);
            for (x, y) in tile.pixels() {
                let value = (10.0 + shared + own * (rng.f64() - 0.5)) as f32;
                patch.add_sample(x, y, sample, 1.0, &[value, 2.0 * value, -value]);
            }
        }
    }
    let mut film = Film::new(&spec).unwrap();
    film.merge(&patch).unwrap();
    film
}

/// Mean squares of the scores of a mean whose truth is 10, and of what they should be by their degrees of freedom.
fn mean_square(score: impl Fn(u64) -> (f64, f64)) -> f64 {
    let scores: Vec<(f64, f64)> = (1..=SEEDS).map(score).collect();
    let squares: Welford = scores.iter().map(|(z, _)| z * z).collect();
    let expected: Welford = scores.iter().map(|(_, nu)| nu / (nu - 2.0)).collect();
    squares.mean() / expected.mean()
}

fn whole_film(square: u32) -> impl Fn(u64) -> (f64, f64) {
    move |seed| {
        let p = film(seed, ErrorMode::REPLICATED, square, 0.5).pooled();
        ((p.mean[0] - 10.0) / p.se(0), f64::from(p.dof))
    }
}

fn region(mode: ErrorMode, square: u32, share: f64, area: PixelBounds) -> impl Fn(u64) -> (f64, f64) {
    move |seed| {
        let (mean, error) = film(seed, mode, square, share).develop().mean_over(0, area);
        ((mean - 10.0) / error.variance.sqrt(), error.dof())
    }
}

/// Of 600 scores with the tails of 28 degrees of freedom the mean square is known to 6.2 %: four of these.
const TOLERANCE: f64 = 0.25;

#[test]
fn scores_of_the_whole_film_have_variance_one() {
    let right = mean_square(whole_film(SIDE));
    assert!((right - 1.0).abs() < TOLERANCE, "{right}");
    // 16 pixels of correlation 1/2: the variance is 1 + 15/2 times what independent ones have
    let naive = mean_square(whole_film(1));
    assert!(naive > 5.0, "pixels taken as independent give {naive}");
}

#[test]
fn scores_of_whole_squares_have_variance_one() {
    let of = |square| mean_square(region(ErrorMode::REPLICATED, square, 0.5, WHOLE));
    let (right, naive) = (of(SIDE), of(1));
    assert!((right - 1.0).abs() < TOLERANCE, "{right}");
    assert!(naive > 5.0, "pixels taken as independent give {naive}");
}

#[test]
fn independent_pixels_cost_only_degrees_of_freedom() {
    let right = mean_square(region(ErrorMode::REPLICATED, SIDE, 0.0, WHOLE));
    assert!((right - 1.0).abs() < TOLERANCE, "{right}");
}

#[test]
fn parts_of_squares_and_conservative_errors_are_bounded() {
    for (mode, area) in
        [(ErrorMode::REPLICATED, CUT), (ErrorMode::Conservative, CUT), (ErrorMode::Conservative, WHOLE)]
    {
        let bound = mean_square(region(mode, SIDE, 0.5, area));
        assert!(bound > 0.3 && bound < 1.0, "{mode:?} {area:?}: {bound}");
        // reached where the pixels err as one; estimates of them then differ by rounding alone
        let reached = mean_square(region(mode, SIDE, 1.0, area));
        assert!((reached - 1.0).abs() < TOLERANCE, "{mode:?} {area:?}: {reached}");
        let naive = mean_square(region(mode, 1, 0.5, area));
        assert!(naive > 1.5, "pixels taken as independent give {naive}");
    }
}

/// All of the window, from both sides: covariances over squares and planes of standard errors.
#[test]
fn planes_of_squares_say_what_the_film_says() {
    let film = film(3, ErrorMode::REPLICATED, SIDE, 0.4);
    let (d, p) = (film.develop(), film.pooled());
    for c in 0..3 {
        let (mean, error) = d.mean_over(c, WINDOW);
        assert!((mean / p.mean[c] - 1.0).abs() < 1e-6);
        assert!((error.variance.sqrt() / p.se(c) - 1.0).abs() < 1e-5);
        assert!((error.dof() - f64::from(p.dof)).abs() < 0.6 * f64::from(p.dof));
    }
    // 4 x 3 squares, each of eight replicates
    assert_eq!(p.dof, 12 * 7);
    assert!((p.covariance(0, 1) / (2.0 * p.covariance(0, 0)) - 1.0).abs() < 1e-5);
    assert!((p.covariance(0, 2) / -p.covariance(0, 0) - 1.0).abs() < 1e-5);
}

#[test]
fn single_pixels_keep_their_errors() {
    let of = |square| film(5, ErrorMode::REPLICATED, square, 0.5).develop();
    let (a, b): (Developed, Developed) = (of(1), of(SIDE));
    assert_eq!((&a.error, &a.y_error, &a.dof), (&b.error, &b.y_error, &b.dof));
    let one = PixelBounds::new(9, 8, 10, 9);
    assert_eq!(a.mean_over(1, one), b.mean_over(1, one));
    assert_eq!((a.square_error.len(), b.square_error.len()), (0, 3));
}

#[test]
fn sums_by_hand() {
    let (window, pixel) = (PixelBounds::new(0, 0, 6, 4), [1.0; 24]);
    let square: Vec<f32> = (0..24).map(|p| if p % 6 < 4 { 0.5 } else { f32::INFINITY }).collect();
    let s = Squares { window, side: 4, pixel: &pixel, square: Some(&square) };
    let v = |area, counts: fn(usize) -> bool| s.sum(area, counts, |_| 7.0).variance;
    // the first square is known, the second, of eight pixels, is not
    assert_eq!(v(window, |_| true), 64.0 + 64.0);
    assert_eq!(v(PixelBounds::new(0, 0, 4, 4), |_| true), 64.0);
    assert_eq!(v(PixelBounds::new(2, 0, 5, 1), |_| true), 4.0 + 1.0);
    // a pixel is missing
    assert_eq!(v(PixelBounds::new(0, 0, 4, 4), |p| p > 0), 225.0);
    let alone = Squares { side: 1, square: None, ..s };
    assert_eq!(alone.sum(window, |_| true, |_| 7.0).variance, 24.0);
    assert!((alone.sum(window, |_| true, |_| 7.0).dof() - 24.0 * 7.0).abs() < 1e-9);
}

#[test]
fn films_say_whether_pixels_share_paths() {
    let [one, four] =
        [1, 4].map(|square| FilmSpec { square, ..FilmSpec::xyz([4, 4], ErrorMode::REPLICATED) });
    assert!(one.difference(&four).unwrap().contains("squares of 1 x 1 and squares of 4 x 4"));
    for square in [0, 3, 32] {
        assert!(FilmSpec { square, ..one.clone() }.validate().is_err());
    }
}
