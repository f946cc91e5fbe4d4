//! Sums: the same bits in any order, nothing dropped in silence, sizes told before they are allocated.
#![allow(clippy::unwrap_used)] // a failure here is a failed test

use std::sync::Arc;

use tyndall_film::{
    ChannelGroup, ErrorMode, Film, FilmError, FilmSpec, Patch, PixelBounds, Statistics, Weights, WorkUnit,
};
use tyndall_testkit::Rng;

fn unit(spec: &FilmSpec) -> WorkUnit {
    WorkUnit { window: spec.bounds, samples: 0..u32::MAX, round: 0 }
}

fn film_of(spec: &Arc<FilmSpec>, samples: &[(u32, u32, u32, f32, Vec<f32>)]) -> Film {
    let mut patch = Patch::new(spec, unit(spec));
    samples.iter().for_each(|(x, y, i, w, v)| patch.add_sample(*x, *y, *i, *w, v));
    let mut film = Film::new(spec).unwrap();
    film.merge(&patch).unwrap();
    film
}

fn with_aov(mut spec: FilmSpec) -> FilmSpec {
    spec.seed = 77;
    spec.with_group(ChannelGroup {
        name: "depth".into(),
        unit: "m".into(),
        channels: vec!["z".into()],
        statistics: Statistics::Mean,
    })
}

fn specs() -> Vec<Arc<FilmSpec>> {
    let mut all = Vec::new();
    for mode in [ErrorMode::Conservative, ErrorMode::REPLICATED, ErrorMode::Replicated { replicates: 5 }] {
        for weights in [Weights::Unit, Weights::Signed] {
            let mut spec = with_aov(FilmSpec::xyz([7, 5], mode));
            spec.weights = weights;
            spec.clamp = Some(50.0);
            all.push(Arc::new(spec));
        }
    }
    all
}

fn samples(spec: &FilmSpec, n: u32) -> Vec<(u32, u32, u32, f32, Vec<f32>)> {
    let mut rng = Rng::new(9);
    let mut one = |x, y, i| {
        let heavy = 1.0 / (rng.f32() + 1e-3);
        let mut v: Vec<f32> = (0..4).map(|_| heavy * (rng.f32() - 0.1)).collect();
        if rng.below(500) == 0 {
            v[1] = [f32::NAN, f32::INFINITY, 1e20][rng.below(3) as usize];
        }
        let negative = spec.weights == Weights::Signed && rng.below(8) == 0;
        (x, y, i, if negative { -1.0 } else { 1.0 }, v)
    };
    spec.bounds
        .pixels()
        .flat_map(|(x, y)| (0..n).map(move |i| (x, y, i)))
        .map(|(x, y, i)| one(x, y, i))
        .collect()
}

#[test]
fn any_order_and_any_cut_give_the_same_bits() {
    for spec in specs() {
        let mut samples = samples(&spec, 40);
        let whole = film_of(&spec, &samples);
        assert!(!whole.diagnostics().is_clean() && whole.diagnostics().clamped > 0);
        let mut rng = Rng::new(1);
        for _ in 0..3 {
            for k in (1..samples.len()).rev() {
                samples.swap(k, rng.below(k as u32 + 1) as usize);
            }
            assert!(film_of(&spec, &samples).same_bits(&whole));
            let mut parts = Film::new(&spec).unwrap();
            for part in samples.chunks(97) {
                parts.merge_film(&film_of(&spec, part)).unwrap();
            }
            assert!(parts.same_bits(&whole));
        }
    }
}

#[test]
fn different_samples_give_different_bits() {
    for spec in specs() {
        let mut samples = samples(&spec, 8);
        let whole = film_of(&spec, &samples);
        samples[0].4[0] = samples[0].4[0] * 1.000001 + 1e-6;
        assert!(!film_of(&spec, &samples).same_bits(&whole));
    }
}

#[test]
fn bad_samples_are_dropped_counted_and_named() {
    let spec = Arc::new(with_aov(FilmSpec::xyz([2, 2], ErrorMode::Conservative)));
    let mut s = vec![(0, 0, 0, 1.0, vec![1.0; 4]), (0, 0, 9, 1.0, vec![1.0, f32::NAN, 1.0, 1.0])];
    s.extend((0..40).map(|i| (1, 1, 100 - i, 1.0, vec![1.0, 1.0, 1.0, f32::NEG_INFINITY])));
    s.push((1, 0, 3, 1.0, vec![1.0, 4e9, 1.0, 1.0]));
    let film = film_of(&spec, &s);
    let d = film.diagnostics();
    assert_eq!((d.non_finite, d.out_of_range, film.samples()), (41, 1, 1));
    let first = d.first_bad();
    assert_eq!(first.len(), 16);
    assert_eq!((first[0].x, first[0].y, first[0].sample, first[0].seed), (1, 0, 3, 77));
    assert_eq!((first[1].x, first[1].sample, first[2].sample), (0, 9, 61));
    assert_eq!(film.develop().mean[1][0], 1.0);
}

#[test]
fn the_clamp_says_what_it_took() {
    let mut spec = FilmSpec::xyz([1, 1], ErrorMode::Conservative);
    spec.clamp = Some(2.0);
    let spec = Arc::new(spec);
    let film = film_of(&spec, &[(0, 0, 0, 1.0, vec![4.0, 8.0, 16.0]), (0, 0, 1, 1.0, vec![1.0, 2.0, 4.0])]);
    assert_eq!((film.diagnostics().clamped, film.diagnostics().clamp_removed()), (1, 6.0));
    assert_eq!(film.develop().pixel(0, 0).iter().map(|e| e.value).collect::<Vec<_>>(), [1.0, 2.0, 4.0]);
}

#[test]
fn absurd_sizes_are_told_and_refused_before_allocation() {
    let spec = FilmSpec::xyz([2_000_000, 2_000_000], ErrorMode::REPLICATED);
    let error = spec.check_size(64 << 30).unwrap_err();
    assert!(matches!(error, FilmError::TooLarge { .. }));
    assert!(error.to_string().contains("2000000 x 2000000 pixels with 3 channels need"), "{error}");
    assert!(FilmSpec::xyz([512, 512], ErrorMode::Conservative).check_size(1 << 30).is_ok());
    let film = Film::new(&Arc::new(FilmSpec::xyz([64, 64], ErrorMode::Conservative))).unwrap();
    assert_eq!(film.spec().bytes(), 64 * 64 * u128::from(film.spec().bytes_per_pixel()));
}

#[test]
fn contradictory_descriptions_are_refused() {
    let good = FilmSpec::xyz([4, 4], ErrorMode::Conservative);
    type Edit = fn(&mut FilmSpec);
    let edits: [Edit; 7] = [
        |s| s.bounds = PixelBounds::new(0, 0, 5, 4),
        |s| s.bounds = PixelBounds::new(2, 2, 2, 4),
        |s| s.mode = ErrorMode::Replicated { replicates: 1 },
        |s| s.luminance = vec![0.0, f32::NAN],
        |s| s.luminance = vec![1.0; 4],
        |s| s.clamp = Some(-1.0),
        |s| s.groups[0].statistics = Statistics::Mean,
    ];
    assert!(good.validate().is_ok());
    for (i, edit) in edits.iter().enumerate() {
        let mut bad = good.clone();
        edit(&mut bad);
        assert!(Film::new(&Arc::new(bad)).is_err(), "edit {i}");
    }
    let mut late = with_aov(good.clone());
    late.groups.swap(0, 1);
    assert!(late.validate().is_err());
}

#[test]
fn films_of_another_kind_are_refused_by_name() {
    let a = Arc::new(FilmSpec::xyz([4, 4], ErrorMode::Conservative));
    let b = Arc::new(FilmSpec::xyz([4, 4], ErrorMode::REPLICATED));
    let text = Film::new(&a).unwrap().merge_film(&Film::new(&b).unwrap()).unwrap_err().to_string();
    assert!(text.contains("error mode: Conservative and Replicated"), "{text}");
    let outside = WorkUnit { window: PixelBounds::new(2, 2, 6, 6), samples: 0..1, round: 0 };
    assert!(matches!(Film::new(&a).unwrap().merge(&Patch::new(&a, outside)), Err(FilmError::Outside { .. })));
}

#[test]
#[should_panic(expected = "outside the unit")]
fn a_sample_outside_the_unit_is_a_broken_contract() {
    let spec = Arc::new(FilmSpec::xyz([4, 4], ErrorMode::Conservative));
    Patch::new(&spec, unit(&spec)).add_sample(4, 0, 0, 1.0, &[0.0; 3]);
}

#[test]
fn a_recycled_patch_is_empty() {
    let spec = specs().swap_remove(1);
    let mut patch = Patch::new(&spec, unit(&spec));
    samples(&spec, 9).iter().for_each(|(x, y, i, w, v)| patch.add_sample(*x, *y, *i, *w, v));
    patch.reset(unit(&spec));
    let mut film = Film::new(&spec).unwrap();
    film.merge(&patch).unwrap();
    assert!(film.same_bits(&Film::new(&spec).unwrap()));
    assert_eq!(patch.last(), None);
}
