//! Nets are nets, points are uniform, seeds are independent, and the bits are fixed.

use super::*;
use crate::hash::{hash2, mix64};
use sobol_burley::parts::sobol_rev;
use tyndall_testkit::{Rng, Welford, chi2_1d, chi2_2d};

#[test]
fn unscrambled_points_are_those_of_sobol_burley() {
    let mut rng = Rng::new(1);
    for _ in 0..10_000 {
        // the oracle knows the lowest 16 bits of the index and the upper 16 of the result
        let index = rng.u32() & 0xffff;
        let ours = [index, pascal(index), higher_dimensions(index)[0], higher_dimensions(index)[1]];
        for (dimension, x) in ours.into_iter().enumerate() {
            let oracle = sobol_rev(index.reverse_bits(), dimension as u32);
            assert_eq!(x & 0xffff, oracle & 0xffff, "index {index}, dimension {dimension}");
        }
    }
}

#[test]
fn high_bits_of_the_index_count() {
    // Pascal's triangle and Joe & Kuo's recurrence by their definitions, for all 32 bits
    for k in 0..32_u32 {
        let column = (0..32_u32).filter(|j| j & k == *j).fold(0, |x, j| x | 1 << j);
        assert_eq!(pascal(1 << k), column, "bit {k}");
    }
    let mut rng = Rng::new(2);
    for _ in 0..1000 {
        let (a, b) = (rng.u32(), rng.u32());
        let sum = [0, 1].map(|d| higher_dimensions(a)[d] ^ higher_dimensions(b)[d]);
        assert_eq!(higher_dimensions(a ^ b), sum);
    }
    // every leading square block of a direction matrix is unit upper triangular: bit k ends in digit k
    for k in 0..32 {
        assert!(higher_dimensions(1 << k).iter().all(|v| 31 - v.leading_zeros() == k));
    }
}

/// Asserts that each of the `2^m` boxes of `2^-a` by `2^(a-m)` holds one point, for every `a`.
fn assert_net(points: &[[f32; 2]], what: &str) {
    let m = points.len().ilog2();
    for a in 0..=m {
        let mut seen = vec![false; points.len()];
        for p in points {
            let (i, j) = ((p[0] * (1_u32 << a) as f32) as usize, (p[1] * (1_u32 << (m - a)) as f32) as usize);
            let slot = &mut seen[(i << (m - a)) | j];
            assert!(!*slot, "{what}: two points in one box of 2^-{a} by 2^-{}", m - a);
            *slot = true;
        }
    }
}

#[test]
fn aligned_blocks_are_nets_in_two_dimensions() {
    for seed in 0..20_u32 {
        for m in 0..=10_u32 {
            // far into the sequence as well
            for start in [0, 1 << m, 7 << m, (hash2(seed, m) >> m) << m] {
                let points: Vec<_> = (0..1 << m).map(|i| sobol_2d(start + i, seed)).collect();
                assert_net(&points, &format!("seed {seed}, {m} bits from {start}"));
                let first: Vec<_> =
                    (0..1 << m).map(|i| sobol_4d(start + i, seed)).map(|p| [p[0], p[1]]).collect();
                assert_net(&first, "first pair of four");
            }
        }
    }
    assert_net(&(0..1 << 16).map(|i| sobol_2d(i, 5)).collect::<Vec<_>>(), "16 bits");
}

/// The points of each pixel are nets, those of all are a net as well, and so are blocks far into the sequence.
#[test]
fn points_of_pixels_that_share_are_nets_alone_and_together() {
    for (sharers, n) in [(Sharers::Sixteen, 16), (Sharers::SixtyFour, 64)] {
        for seed in 0..6_u32 {
            for m in 0..=8_u32 {
                for start in [0, 3 << m, (hash2(seed, m) >> (m + 8)) << m] {
                    let of =
                        |k: u32| (0..1 << m).map(move |i| SobolIndex::shared(start + i, k, sharers).d2(seed));
                    let what = format!("{sharers:?}, seed {seed}, {m} bits from {start}");
                    (0..n)
                        .for_each(|k| assert_net(&of(k).collect::<Vec<_>>(), &format!("{what}, pixel {k}")));
                    assert_net(&(0..n).flat_map(of).collect::<Vec<_>>(), &what);
                }
            }
        }
    }
}

/// Whether two pixels' numbers, or two pairs of dimensions of one pixel, are independent over seeds.
#[test]
fn shared_points_are_uniform_and_padded_at_random() {
    let sharers = [Sharers::Sixteen, Sharers::SixtyFour];
    for (i, sharers) in sharers.into_iter().enumerate() {
        let one = |r: &mut Rng| {
            let p = SobolIndex::shared(r.u32() & 15, 5, sharers).d2(r.u32());
            Some([p[0].into(), p[1].into()])
        };
        chi2_2d(one, |_| 1.0, [[0.0, 1.0], [0.0, 1.0]], 200_000, 10 + i as u64).assert_ok("a point", 4);
        let padded = |r: &mut Rng| {
            let (point, seed) = (SobolIndex::shared(r.u32() & 15, r.u32() & 15, sharers), r.u32());
            Some([point.d2(seed)[0].into(), point.d2(seed.wrapping_add(2))[0].into()])
        };
        chi2_2d(padded, |_| 1.0, [[0.0, 1.0], [0.0, 1.0]], 200_000, 20 + i as u64).assert_ok("padding", 4);
    }
}

#[test]
fn every_dimension_is_stratified() {
    for seed in [0, 1, 77, u32::MAX] {
        for d in 0..4 {
            let mut seen = [false; 4096];
            (0..4096).for_each(|i| seen[(sobol_4d(i, seed)[d] * 4096.0) as usize] = true);
            assert!(seen.iter().all(|&s| s), "seed {seed}, dimension {d}");
        }
        let mut seen = [false; 4096];
        (0..4096).for_each(|i| seen[(sobol_1d(i, seed) * 4096.0) as usize] = true);
        assert!(seen.iter().all(|&s| s));
    }
}

#[test]
fn one_point_is_uniform_over_seeds() {
    // each test draws the same index under random seeds: the scramble alone makes it uniform
    for index in [0, 1, 5, 1000, 0xdead_beef] {
        let one = chi2_1d(|r| Some(sobol_1d(index, r.u32()).into()), |_| 1.0, [0.0, 1.0], 200_000, 3);
        one.assert_ok("sobol_1d", 35);
        for (i, j) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
            let pair = |r: &mut Rng| {
                let p = sobol_4d(index, r.u32());
                Some([p[i].into(), p[j].into()])
            };
            let test = chi2_2d(pair, |_| 1.0, [[0.0, 1.0], [0.0, 1.0]], 100_000, 4);
            test.assert_ok(&format!("sobol_4d({index}), dimensions {i} and {j}"), 35);
        }
    }
}

#[test]
fn blocks_of_different_seeds_are_independent() {
    // the same index under two consecutive seeds, as padding pairs dimensions
    let draw = |r: &mut Rng| {
        let (index, seed) = (r.u32() & 1023, r.u32());
        Some([sobol_1d(index, seed).into(), sobol_1d(index, seed.wrapping_add(1)).into()])
    };
    chi2_2d(draw, |_| 1.0, [[0.0, 1.0], [0.0, 1.0]], 400_000, 5).assert_ok("padding", 1);
}

/// Mean over 64 points of a function with integral 1/4, and the same for 64 independent points.
#[test]
fn scrambled_means_are_unbiased_and_narrow() {
    let f = |p: [f32; 2]| f64::from(p[0] * p[0] * p[1]) * 1.5;
    let mut rng = Rng::new(6);
    let (mut net, mut plain) = (Welford::default(), Welford::default());
    for _ in 0..20_000 {
        let seed = rng.u32();
        net.add((0..64).map(|i| f(sobol_2d(i, seed))).sum::<f64>() / 64.0);
        plain.add((0..64).map(|_| f(rng.f32x2())).sum::<f64>() / 64.0);
    }
    // numbers are floors to multiples of 2^-24, far below the errors here
    net.z_test(0.25).assert_ok("scrambled net", 2);
    plain.z_test(0.25).assert_ok("independent points", 2);
    // Owen (1997): variance falls as n^-3 log n for smooth functions
    assert!(net.variance() < plain.variance() / 100.0, "{} against {}", net.variance(), plain.variance());
}

#[test]
fn golden_bits() {
    let hash = (0..100_000_u32).fold(0, |h, i| {
        let index = i.wrapping_mul(0x0100_0193);
        let (p, q) = (sobol_4d(index, i >> 4), sobol_2d(index, i >> 7));
        let bits = p.into_iter().chain(q).chain([sobol_1d(index, i)]);
        bits.fold(h, |h, x| mix64(h ^ u64::from(x.to_bits())))
    });
    assert_eq!(hash, 0xfdb0_ef05_d9e1_e1bc, "{hash:#018x}");
}
