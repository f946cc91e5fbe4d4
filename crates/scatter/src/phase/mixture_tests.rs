//! Mixtures of species whose weights part along the spectrum.

use super::tests::wavelengths;
use super::*;
use crate::sphere_tests::{chi2, integrate};
use tyndall_base::vec::vec3;
use tyndall_testkit::Rng;

fn lobe(g: f32) -> PhaseFunction {
    PhaseFunction::HenyeyGreenstein(HenyeyGreenstein::new(Curve::Constant(g)).unwrap())
}

/// Lane 0: both; lane 1: the first alone; lane 2: the second alone; lane 3: neither.
const SIGMA: [[f32; 4]; 2] = [[1.0, 2.0, 0.0, 0.0], [3.0, 0.0, 0.5, 0.0]];

#[test]
fn every_lane_is_its_own_density() {
    let phases = [lobe(0.7), lobe(-0.4)];
    let w = wavelengths([450.0, 550.0, 650.0, 750.0]);
    let wo = vec3(0.48, -0.6, 0.64);
    for hero in 0..3 {
        let mut mixture = Mixture::NONE;
        for (sigma, phase) in SIGMA.iter().zip(&phases) {
            let mut s = Spectrum(*sigma);
            s.0.swap(0, hero);
            mixture.push(s, phase);
        }
        let draw = |rng: &mut Rng| mixture.sample(wo, rng.f32(), rng.f32x2(), &w).map(|s| s.wi);
        let pdf = |wi: Vec3| f64::from(mixture.eval(wo, wi, &w)[0]);
        chi2(draw, pdf, 100_000, 3).assert_ok("mixture", 3);
    }
}

#[test]
fn lanes_that_do_not_scatter_are_zero_and_the_others_normalised() {
    let phases = [lobe(0.5), PhaseFunction::Isotropic];
    let w = wavelengths([450.0, 550.0, 650.0, 750.0]);
    let wo = vec3(0.0, 0.0, 1.0);
    let mut mixture = Mixture::NONE;
    SIGMA.iter().zip(&phases).for_each(|(s, p)| mixture.push(Spectrum(*s), p));
    assert_eq!(mixture.sigma_s().0, [4.0, 2.0, 0.5, 0.0]);
    for (k, want) in [1.0, 1.0, 1.0, 0.0].into_iter().enumerate() {
        let norm = integrate(|wi| f64::from(mixture.eval(wo, wi, &w)[k]));
        assert!((norm - want).abs() < 1e-5, "lane {k}: {norm}");
    }
    assert!((mixture.mean_cosine(&w, 0) - 0.125).abs() < 1e-7 && mixture.mean_cosine(&w, 3) == 0.0);
}

#[test]
fn a_hero_that_does_not_scatter_ends_the_path() {
    let phases = [lobe(0.5), PhaseFunction::Isotropic];
    let w = wavelengths([450.0, 550.0]);
    let wo = vec3(0.0, 0.0, 1.0);
    let dark = Spectrum([0.0, 1.0]);
    let mut two = Mixture::NONE;
    phases.iter().for_each(|p| two.push(dark, p));
    for mixture in [Mixture::NONE, Mixture::single(dark, &phases[0]), two] {
        assert!(mixture.sample(wo, 0.3, [0.1, 0.9], &w).is_none());
        assert!(mixture.eval(wo, wo, &w).is_finite());
    }
}

#[test]
fn one_species_is_the_species() {
    let phase = lobe(0.8);
    let w = wavelengths([450.0, 550.0]);
    let wo = vec3(0.48, -0.6, 0.64);
    let mixture = Mixture::single(Spectrum([2.0, 3.0]), &phase);
    let s = mixture.sample(wo, 0.5, [0.3, 0.6], &w).unwrap();
    assert_eq!(s, phase.sample(wo, [0.3, 0.6], &w));
    assert_eq!(mixture.eval(wo, s.wi, &w), phase.eval(wo, s.wi, &w));
}
