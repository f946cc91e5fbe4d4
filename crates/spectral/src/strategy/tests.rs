//! Samplers follow their densities, slots are exchangeable, fixed sets are quadrature rules.

use tyndall_testkit::{Rng, chi2_discrete};

use super::*;
use crate::cie::{matching_functions, xyz};
use crate::curve::Curve;
use crate::emission::{Emission, Line};
use crate::illuminant::illuminant;
use crate::range::Outside;

const DRAWS: usize = 200_000;

fn mercury() -> Vec<Line> {
    [(404.66, 0.3), (435.83, 1.0), (546.07, 1.2), (578.0, 0.8)]
        .map(|(lambda, power)| Line { lambda, power })
        .to_vec()
}

/// A lamp with lines on a weak continuum.
fn lamp() -> Emission {
    Emission::new(Curve::Constant(0.01), &mercury()).unwrap()
}

fn densities() -> Vec<(&'static str, Density)> {
    let odd = LambdaRange { min: 381.3, max: 702.9 };
    let f11 = Emission::from(illuminant("F11", Outside::Zero).unwrap());
    let responses = matching_functions();
    vec![
        ("uniform", Density::uniform(LambdaRange::VISIBLE)),
        ("uniform, odd range", Density::uniform(odd)),
        ("visible", Density::visible(LambdaRange::VISIBLE).unwrap()),
        ("F11", Density::light(LambdaRange::VISIBLE, responses, &[(1.0, &f11)]).unwrap()),
        ("mercury", Density::light(odd, responses, &[(2.0, &lamp())]).unwrap()),
        ("uniform and lines", Density::uniform_with_lines(odd, &mercury(), 0.3).unwrap()),
    ]
}

/// Probabilities of 60 groups of cells and of each line.
fn probabilities(density: &Density) -> Vec<f64> {
    let range = density.range();
    let group = |g: usize| range.min + range.width() * (g as f32 / 60.0);
    let mass = |g: usize| {
        let (a, b) = (f64::from(group(g)), f64::from(group(g + 1)));
        (0..4000)
            .map(|i| density.pdf((a + (b - a) * (f64::from(i) + 0.5) / 4000.0) as f32))
            .map(f64::from)
            .sum::<f64>()
            * (b - a)
            / 4000.0
    };
    (0..60).map(mass).chain(density.lines().map(|l| f64::from(l.1))).collect()
}

/// The group or line of slot `k`.
fn bin<const N: usize>(w: &Wavelengths<N>, k: usize, range: LambdaRange) -> usize {
    let place = (w.lambda[k] - range.min) / range.width() * 60.0;
    if w.on_line(k) { 60 + usize::from(w.line[k]) } else { (place as usize).min(59) }
}

#[test]
fn probabilities_are_complete() {
    for (name, density) in densities() {
        let sum: f64 = probabilities(&density).iter().sum();
        assert!((sum - 1.0).abs() < 2e-4, "{name}: {sum}");
    }
}

#[test]
fn every_slot_follows_the_density() {
    let tests = densities().len() * 8;
    for (name, density) in densities() {
        let (expected, range) = (probabilities(&density), density.range());
        let sampler = WavelengthSampler::from(density);
        for k in 0..8 {
            let draw = |rng: &mut Rng| Some(bin(&sampler.sample::<8>(rng.f32()), k, range));
            chi2_discrete(draw, &expected, DRAWS, 7 + k as u64)
                .assert_ok(&format!("{name}, slot {k}"), tests);
        }
        let draw = |rng: &mut Rng| Some(bin(&sampler.sample::<1>(rng.f32()), 0, range));
        chi2_discrete(draw, &expected, DRAWS, 5).assert_ok(&format!("{name}, one wavelength"), tests);
    }
}

#[test]
fn the_hero_is_uniform_within_its_set() {
    let sampler = WavelengthSampler::from(Density::visible(LambdaRange::VISIBLE).unwrap());
    let rank = |rng: &mut Rng| {
        let w = sampler.sample::<8>(rng.f32());
        Some(w.lambda.iter().filter(|&&l| l < w.hero()).count())
    };
    chi2_discrete(rank, &[0.125; 8], DRAWS, 11).assert_ok("rank of the hero", 1);
}

#[test]
fn a_set_is_the_same_whichever_of_it_is_hero() {
    let sampler = WavelengthSampler::from(
        Density::light(LambdaRange::VISIBLE, matching_functions(), &[(1.0, &lamp())]).unwrap(),
    );
    let mut rng = Rng::new(3);
    for _ in 0..2000 {
        let u = (rng.u32() >> 11) as f32 / 16_777_216.0;
        let w = sampler.sample::<8>(u);
        let other = sampler.sample::<8>(rotate::<8>(u, 3));
        for k in 0..8 {
            assert_eq!(w.lambda[(k + 3) % 8], other.lambda[k]);
            assert_eq!(w.pdf[(k + 3) % 8], other.pdf[k]);
            assert_eq!(w.line[(k + 3) % 8], other.line[k]);
        }
    }
}

#[test]
fn rotation_is_exact_on_the_grid_of_random_numbers() {
    let mut rng = Rng::new(4);
    for _ in 0..100_000 {
        let u = rng.f32();
        for k in 0..8 {
            let exact = (f64::from(u) + k as f64 / 8.0).fract();
            assert_eq!(f64::from(rotate::<8>(u, k)), exact);
        }
        assert!(rotate::<5>(u, 4) < 1.0 || u >= 0.2);
    }
}

#[test]
fn numbers_at_and_beyond_the_ends_stay_inside() {
    for (name, density) in densities() {
        for u in [0.0, 1e-30, 1.0 - 6e-8, 1.0, f32::NAN] {
            let (lambda, pdf, _) = density.sample(u);
            assert!(density.range().contains(lambda) && pdf > 0.0, "{name} at {u}");
        }
    }
}

#[test]
fn reported_densities_are_those_of_the_cells_drawn() {
    for (name, density) in densities() {
        let sampler = WavelengthSampler::from(density.clone());
        let mut rng = Rng::new(6);
        for _ in 0..20_000 {
            let w = sampler.sample::<4>(rng.f32());
            for k in 0..4 {
                assert!(density.range().contains(w.lambda[k]) && w.pdf[k] > 0.0, "{name}");
                let beside = [w.lambda[k] - 2e-3, w.lambda[k], w.lambda[k] + 2e-3].map(|l| density.pdf(l));
                assert!(w.on_line(k) || beside.contains(&w.pdf[k]), "{name} at {}", w.lambda[k]);
            }
        }
    }
}

/// Mean over all `u` on a regular grid of the slots' mean of `value / pdf`.
fn estimate<const N: usize>(
    sampler: &WavelengthSampler,
    value: impl Fn(&Wavelengths<N>, usize) -> f64,
) -> f64 {
    const POINTS: u32 = 1 << 16;
    let one = |i: u32| {
        let w = sampler.sample::<N>((i as f32 + 0.5) / POINTS as f32);
        (0..N).map(|k| value(&w, k) / f64::from(w.pdf[k])).sum::<f64>() / N as f64
    };
    (0..POINTS).map(one).sum::<f64>() / f64::from(POINTS)
}

#[test]
fn every_strategy_estimates_the_same_xyz_of_a_lamp_with_lines() {
    let light = lamp();
    let [y_lines, y_continuum] = [
        light
            .lines()
            .iter()
            .map(|l| f64::from(l.power * matching_functions()[1].eval(l.lambda)))
            .sum::<f64>(),
        xyz(light.continuum())[1],
    ];
    let full = LambdaRange::VISIBLE;
    let responses = matching_functions();
    let strategies = [
        Density::light(full, responses, &[(1.0, &light)]).unwrap(),
        Density::uniform_with_lines(full, &mercury(), 0.5).unwrap(),
        Density::light(full, &responses[2..], &[(1.0, &light)]).unwrap(),
    ];
    for (i, density) in strategies.into_iter().enumerate() {
        let sampler = WavelengthSampler::from(density);
        let y = estimate::<4>(&sampler, |w, k| {
            f64::from(light.sample(w)[k] * matching_functions()[1].eval(w.lambda[k]))
        });
        assert!(
            (y / (y_lines + y_continuum) - 1.0).abs() < 1e-3,
            "strategy {i}: {y} {}",
            y_lines + y_continuum
        );
    }
}

#[test]
fn fixed_sets_give_the_quadrature_sum() {
    let range = LambdaRange { min: 380.0, max: 780.0 };
    for (count, rule) in
        [(1, Rule::Midpoint), (5, Rule::Midpoint), (80, Rule::Endpoints), (13, Rule::Endpoints)]
    {
        let set = FixedSet::new(range, count, rule).unwrap();
        let sum: f64 = set.lambda().iter().map(|&l| f64::from(set.weight() * l * l)).sum();
        let sampler = WavelengthSampler::from(set.clone());
        let got = estimate::<8>(&sampler, |w, k| f64::from(w.lambda[k] * w.lambda[k]));
        assert!((got / sum - 1.0).abs() < 2e-4, "{count}: {got} against {sum}");
        let draw = |rng: &mut Rng| {
            let l = sampler.sample::<4>(rng.f32()).lambda[2];
            set.lambda().iter().position(|&m| m == l)
        };
        let pmf = vec![1.0 / count as f64; count];
        if count > 1 {
            chi2_discrete(draw, &pmf, DRAWS, 21).assert_ok(&format!("set of {count}"), 3);
        }
    }
    let ends = FixedSet::new(range, 5, Rule::Endpoints).unwrap();
    assert_eq!(ends.lambda(), [380.0, 480.0, 580.0, 680.0, 780.0]);
    assert_eq!(FixedSet::new(range, 4, Rule::Midpoint).unwrap().lambda(), [430.0, 530.0, 630.0, 730.0]);
    assert!(
        FixedSet::new(range, 0, Rule::Midpoint).is_err() && FixedSet::new(range, 1, Rule::Endpoints).is_err()
    );
}

#[test]
fn groups_hold_the_whole_set_once() {
    let set = FixedSet::new(LambdaRange { min: 380.0, max: 780.0 }, 21, Rule::Midpoint).unwrap();
    assert_eq!((set.groups::<8>(), set.groups::<16>()), (3, 2));
    let squares =
        |w: Wavelengths<8>| (0..8).map(|k| f64::from(w.lambda[k] * w.lambda[k] / w.pdf[k])).sum::<f64>();
    let got = (0..3).map(|g| squares(set.group(g))).sum::<f64>() / 21.0;
    let sum: f64 = set.lambda().iter().map(|&l| f64::from(set.weight() * l * l)).sum();
    assert!((got / sum - 1.0).abs() < 1e-6, "{got} {sum}");
}

#[test]
fn light_that_the_film_cannot_see_is_refused() {
    assert!(
        Density::light(LambdaRange { min: 1000.0, max: 1200.0 }, matching_functions(), &[(1.0, &lamp())])
            .is_err()
    );
    assert!(Density::uniform_with_lines(LambdaRange::VISIBLE, &mercury(), 1.0).is_err());
    let narrow = Emission::from(Curve::linear(&[400.0, 700.0], &[1.0, 1.0], Outside::Error).unwrap());
    assert!(Density::light(LambdaRange::VISIBLE, matching_functions(), &[(1.0, &narrow)]).is_err());
    let outside = [Line { lambda: 1064.0, power: 1.0 }];
    let without = Density::uniform_with_lines(LambdaRange::VISIBLE, &outside, 0.5).unwrap();
    assert_eq!(without.lines().count(), 0);
}
