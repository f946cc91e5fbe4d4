//! What every phase function must obey, at several wavelengths at once.

use super::*;
use crate::sphere_tests::chi2;
use std::f64::consts::PI;
use tyndall_base::vec::vec3;
use tyndall_spectral::Outside;
use tyndall_spectral::wavelengths::CONTINUUM;
use tyndall_testkit::{Rng, chi2_1d, integrate_1d};

/// Wavelengths of the tests \[nm\].
const LAMBDA: [f32; 4] = [450.0, 530.0, 610.0, 700.0];

pub(super) fn wavelengths<const N: usize>(lambda: [f32; N]) -> Wavelengths<N> {
    Wavelengths { lambda, pdf: [1.0 / 470.0; N], line: [CONTINUUM; N] }
}

/// From `a` at 400 nm to `b` at 800 nm.
fn ramp(a: f32, b: f32) -> Curve {
    Curve::linear(&[400.0, 800.0], &[a, b], Outside::Hold).unwrap()
}

/// A fog-like table: a narrow peak whose width follows the wavelength, normalised to 4 pi.
fn fog_table() -> Tabulated {
    let theta: Vec<f64> =
        (0..=400).map(|i| f64::from(i) / 400.0).map(|x| 180.0 * (x * x * x * 0.99 + x * 0.01)).collect();
    let lambda = [400.0, 550.0, 800.0];
    let peak = |l: f32, t: &f64| {
        let g = 0.97 - 0.04 * (f64::from(l) - 400.0) / 400.0;
        let hg = |g: f64| (1.0 - g * g) / (1.0 + g * g - 2.0 * g * t.to_radians().cos()).powf(1.5);
        0.6 * hg(g) + 0.4 * hg(-0.2)
    };
    let p: Vec<f64> = lambda.iter().flat_map(|&l| theta.iter().map(move |t| peak(l, t))).collect();
    Tabulated::from_degrees(&lambda, &theta, &p, Outside::Hold).unwrap()
}

fn models() -> Vec<(&'static str, PhaseFunction)> {
    use PhaseFunction as P;
    let hg = |a, b| P::HenyeyGreenstein(HenyeyGreenstein::new(ramp(a, b)).unwrap());
    vec![
        ("isotropic", P::Isotropic),
        ("hg forward", hg(0.95, 0.6)),
        ("hg through zero", hg(-0.5, 0.5)),
        ("rayleigh", P::Rayleigh(Rayleigh::IDEAL)),
        ("rayleigh depolarised", P::Rayleigh(Rayleigh::new(ramp(0.03, 0.8)).unwrap())),
        ("draine", P::Draine(Draine::new(ramp(0.8, 0.2), ramp(0.5, 30.0)).unwrap())),
        ("draine g = 0", P::Draine(Draine::new(Curve::ZERO, ramp(0.5, 2.0)).unwrap())),
        ("cornette-shanks", P::Draine(Draine::cornette_shanks(ramp(0.9, -0.3)).unwrap())),
        ("schlick", P::Schlick(Schlick::new(ramp(0.95, -0.2)).unwrap())),
        ("two lobes", P::TwoLobe(TwoLobe::new([ramp(0.9, 0.7), ramp(-0.2, -0.6)], ramp(0.95, 0.5)).unwrap())),
        ("fournier-forand", P::FournierForand(FournierForand::new(1.1, 3.5835).unwrap())),
        ("fournier-forand steep", P::FournierForand(FournierForand::new(1.02, 4.6).unwrap())),
        ("table", P::Tabulated(fog_table())),
    ]
}

/// The unit vector at `versine` to the forward direction of `wo = -z`.
fn at(versine: f64) -> Vec3 {
    let sine = (versine * (2.0 - versine)).max(0.0).sqrt();
    vec3(sine as f32, 0.0, (1.0 - versine) as f32)
}

/// `2 pi int p g(v) dv`, decade by decade so that no peak is missed. The directions that carry `v` into the model have
/// the precision of `f32` components, so the model is asked by its angle.
fn moment(phase: &PhaseFunction, lane: usize, g: impl Fn(f64) -> f64) -> f64 {
    let w = wavelengths(LAMBDA);
    let f = |v: f64| 2.0 * PI * g(v) * f64::from(by_versine(phase, v as f32, &w)[lane]);
    let edges = [0.0, 5e-7, 1e-6, 1e-5, 1e-4, 1e-3, 0.01, 0.1, 0.5, 1.0, 2.0];
    edges.windows(2).map(|e| integrate_1d(&f, e[0], e[1], 1e-6)).sum()
}

fn by_versine(phase: &PhaseFunction, v: f32, w: &Wavelengths<4>) -> Spectrum<4> {
    match phase {
        PhaseFunction::Isotropic => Spectrum::splat(0.25 * FRAC_1_PI),
        PhaseFunction::HenyeyGreenstein(p) => p.eval(v, w),
        PhaseFunction::Rayleigh(p) => p.eval(v, w),
        PhaseFunction::Draine(p) => p.eval(v, w),
        PhaseFunction::Schlick(p) => p.eval(v, w),
        PhaseFunction::TwoLobe(p) => p.eval(v, w),
        PhaseFunction::FournierForand(p) => Spectrum::splat(p.eval(v)),
        PhaseFunction::Tabulated(p) => p.eval(v, w),
    }
}

#[test]
fn norm_is_one_in_every_lane() {
    for (name, phase) in models() {
        for k in 0..4 {
            let norm = moment(&phase, k, |_| 1.0);
            assert!((norm - 1.0).abs() < 2e-5, "{name} at {} nm: {norm}", LAMBDA[k]);
        }
    }
}

#[test]
fn mean_cosine_is_what_the_model_says() {
    for (name, phase) in models() {
        for (k, &lambda) in LAMBDA.iter().enumerate() {
            let (want, got) = (f64::from(phase.mean_cosine(lambda)), moment(&phase, k, |v| 1.0 - v));
            assert!((got - want).abs() < 2e-5, "{name} at {lambda} nm: {got} instead of {want}");
        }
    }
}

/// Angles in `x = v^(1/4)`, which spreads the forward peak over many bins.
#[test]
fn angles_follow_the_density_at_every_wavelength() {
    let models = models();
    let tests = models.len() * LAMBDA.len();
    for (name, phase) in &models {
        for k in 0..LAMBDA.len() {
            let mut lambda = LAMBDA;
            lambda.swap(0, k);
            let w = wavelengths(lambda);
            let wo = vec3(0.48, -0.6, 0.64);
            let draw = |rng: &mut Rng| {
                let s = phase.sample(wo, rng.f32x2(), &w);
                Some(f64::from(versine(wo, s.wi)).powf(0.25))
            };
            let pdf = |x: f64| 8.0 * PI * x.powi(3) * f64::from(by_versine(phase, x.powi(4) as f32, &w)[0]);
            chi2_1d(draw, pdf, [0.0, 2.0_f64.powf(0.25)], 100_000, 1 + k as u64)
                .assert_ok(&format!("{name} at {} nm", lambda[0]), tests);
        }
    }
}

#[test]
fn directions_follow_the_density_on_the_sphere() {
    // azimuth and orientation: the broad lobes tell
    let broad: Vec<_> = models().into_iter().filter(|(_, p)| p.mean_cosine(700.0).abs() < 0.5).collect();
    let tests = broad.len();
    assert!(tests >= 6);
    for (i, (name, phase)) in broad.iter().enumerate() {
        let w = wavelengths([700.0, 450.0]);
        let wo = [vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, -1.0), vec3(-0.36, 0.48, -0.8)][i % 3];
        let draw = |rng: &mut Rng| Some(phase.sample(wo, rng.f32x2(), &w).wi);
        let pdf = |wi: Vec3| f64::from(phase.eval(wo, wi, &w)[0]);
        chi2(draw, pdf, 100_000, 77).assert_ok(name, tests);
    }
}

#[test]
fn a_sample_carries_the_value_of_every_lane() {
    let mut rng = Rng::new(5);
    let w = wavelengths(LAMBDA);
    for (name, phase) in models() {
        for _ in 0..2_000 {
            let wo = Vec3::from(rng.direction());
            let s = phase.sample(wo, rng.f32x2(), &w);
            let again = phase.eval(wo, s.wi, &w);
            // the rounding of wi (1e-7 per component) moves steep flanks by about 1e-7 / theta
            let slack = 2e-5 + 3e-6 / versine(wo, s.wi).max(1e-9).sqrt();
            for k in 0..4 {
                assert!((s.p[k] - again[k]).abs() <= slack * again[k], "{name}: {:?} {again:?}", s.p);
            }
            assert!((s.wi.length() - 1.0).abs() < 1e-6 && s.p.min_lane() > 0.0, "{name}");
        }
    }
}

#[test]
fn forward_is_opposite_to_wo_and_roles_can_be_swapped() {
    let w = wavelengths(LAMBDA);
    let (wo, wi) = (vec3(0.48, -0.6, 0.64), vec3(-0.36, 0.48, 0.8));
    for (name, phase) in models() {
        assert_eq!(phase.eval(wo, wi, &w), phase.eval(wi, wo, &w), "{name}");
    }
    let hg = PhaseFunction::HenyeyGreenstein(HenyeyGreenstein::new(ramp(0.95, 0.6)).unwrap());
    assert!(hg.eval(wo, -wo, &w)[0] > 1000.0 * hg.eval(wo, wo, &w)[0]);
    assert_eq!(versine(vec3(0.0, 0.0, -1.0), at(0.5)), 0.5);
}

#[test]
fn special_cases_meet() {
    let w = wavelengths(LAMBDA);
    let g = ramp(0.9, -0.3);
    let hg = HenyeyGreenstein::new(g.clone()).unwrap();
    let plain = Draine::new(g, Curve::ZERO).unwrap();
    let rayleigh = Draine::new(Curve::ZERO, Curve::ONE).unwrap();
    for v in [0.0_f32, 1e-4, 0.3, 1.0, 1.7, 2.0] {
        for k in 0..4 {
            let close = |a: f32, b: f32| (a - b).abs() < 1e-6 * b;
            assert!(close(plain.eval(v, &w)[k], hg.eval(v, &w)[k]));
            assert!(close(rayleigh.eval(v, &w)[k], Rayleigh::IDEAL.eval(v, &w)[k]));
        }
    }
}

/// Mobley, Sundman & Boss 2002: n = 1.10, mu = 3.5835 has the backscatter fraction 0.0183 of Petzold's average.
#[test]
fn fournier_forand_has_petzolds_backscatter() {
    let sea = PhaseFunction::FournierForand(FournierForand::new(1.10, 3.5835).unwrap());
    let back = moment(&sea, 0, |v| if v > 1.0 { 1.0 } else { 0.0 });
    assert!((back - 0.0183).abs() < 1e-4, "{back}");
}

#[test]
fn unphysical_parameters_are_refused_with_expected_and_got() {
    let message = HenyeyGreenstein::new(ramp(0.5, 1.0)).unwrap_err().to_string();
    assert!(message.contains("expected -1 < g < 1, got 1"), "{message}");
    assert!(HenyeyGreenstein::new(Curve::Constant(f32::NAN)).is_err());
    assert!(Rayleigh::new(Curve::Constant(0.9)).is_err());
    assert!(Draine::new(Curve::ZERO, Curve::Constant(-0.1)).is_err());
    assert!(Schlick::new(Curve::Constant(-1.0)).is_err());
    assert!(TwoLobe::new([Curve::ZERO, Curve::ZERO], Curve::Constant(1.1)).is_err());
    assert!(FournierForand::new(1.0, 4.0).is_err() && FournierForand::new(1.1, 5.0).is_err());
}

#[test]
fn tables_outside_the_film_are_reported() {
    let asked = LambdaRange::VISIBLE;
    let g = |rule| Curve::linear(&[400.0, 700.0], &[0.5, 0.6], rule).unwrap();
    let model = |rule| PhaseFunction::HenyeyGreenstein(HenyeyGreenstein::new(g(rule)).unwrap());
    assert_eq!(model(Outside::Hold).check_range(asked).unwrap().unwrap().asked, asked);
    assert!(model(Outside::Error).check_range(asked).is_err());
    assert_eq!(PhaseFunction::Isotropic.check_range(asked), Ok(None));
    assert!(PhaseFunction::Tabulated(fog_table()).check_range(asked).unwrap().is_some());
}
