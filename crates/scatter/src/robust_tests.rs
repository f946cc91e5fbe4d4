//! No NaN, no infinity, no negative value, whatever the directions and parameters.

use crate::bsdf::{Bsdf, Conductor, Dielectric, ThinDielectric, TrowbridgeReitz};
use crate::phase::{Draine, HenyeyGreenstein, PhaseFunction, Rayleigh, Schlick};
use proptest::prelude::*;
use tyndall_base::vec::{Vec3, vec3};
use tyndall_spectral::wavelengths::CONTINUUM;
use tyndall_spectral::{Curve, Spectrum, Wavelengths};

/// Unit vectors, many of them near the horizon and the poles.
fn direction() -> impl Strategy<Value = Vec3> {
    let z = prop_oneof![-1.0_f32..1.0, -1e-4_f32..1e-4, Just(1.0_f32), Just(-1.0_f32), 0.999_9_f32..1.0];
    (z, 0.0_f32..std::f32::consts::TAU).prop_map(|(z, phi)| {
        let r = (1.0 - z * z).max(0.0).sqrt();
        vec3(r * phi.cos(), r * phi.sin(), z)
    })
}

/// Uniform numbers with their ends.
fn unit() -> impl Strategy<Value = f32> {
    prop_oneof![0.0_f32..1.0, Just(0.0_f32), Just(1.0_f32.next_down())]
}

fn surface() -> impl Strategy<Value = Bsdf<'static, 2>> {
    let alpha = || prop_oneof![0.0_f32..1.0, 1e-3_f32..1e-2];
    (0..3, alpha(), alpha(), 0.3_f32..3.0, 0.3_f32..3.0, 0.0_f32..8.0).prop_map(
        |(kind, ax, ay, n0, n1, k)| {
            let (eta, distribution) = (Spectrum([n0, n1]), TrowbridgeReitz::new(ax, ay));
            match kind {
                0 => Bsdf::Dielectric(Dielectric::new(eta, distribution)),
                1 => Bsdf::Conductor(Conductor { eta, k: Spectrum([k, 1.0]), distribution }),
                _ => Bsdf::ThinDielectric(ThinDielectric { eta }),
            }
        },
    )
}

fn lobe() -> impl Strategy<Value = PhaseFunction> {
    let g = || prop_oneof![-0.999_9_f32..0.999_9, -1e-4_f32..1e-4, Just(0.0_f32)];
    (0..4, g(), 0.0_f32..500.0, 0.0_f32..0.857).prop_map(|(kind, g, alpha, rho)| {
        let (g, alpha, rho) = (Curve::Constant(g), Curve::Constant(alpha), Curve::Constant(rho));
        match kind {
            0 => PhaseFunction::HenyeyGreenstein(HenyeyGreenstein::new(g).unwrap()),
            1 => PhaseFunction::Draine(Draine::new(g, alpha).unwrap()),
            2 => PhaseFunction::Schlick(Schlick::new(g).unwrap()),
            _ => PhaseFunction::Rayleigh(Rayleigh::new(rho).unwrap()),
        }
    })
}

fn sane<const N: usize>(s: Spectrum<N>) -> bool {
    s.is_finite() && s.min_lane() >= 0.0
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 10_000, failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn surfaces_stay_finite(bsdf in surface(), wo in direction(), wi in direction(), uc in unit(), u in [unit(), unit()]) {
        let (f, pdf) = bsdf.eval_pdf(wo, wi);
        prop_assert!(sane(f) && sane(pdf), "{f:?} {pdf:?}");
        if let Some(s) = bsdf.sample(wo, uc, u) {
            prop_assert!(sane(s.f) && sane(s.pdf) && s.pdf[0] > 0.0, "{s:?}");
            prop_assert!((s.wi.length() - 1.0).abs() < 1e-4, "{s:?}");
            // a path gains at most what refraction squeezes: no fireflies from the sampler
            let weight = s.f[0] * s.wi.z.abs() / s.pdf[0] * s.eta * s.eta;
            prop_assert!(weight < 1.001, "{weight} {s:?}");
        }
    }

    #[test]
    fn phase_functions_stay_finite(phase in lobe(), wo in direction(), wi in direction(), u in [unit(), unit()]) {
        let lambda = Wavelengths { lambda: [450.0, 650.0], pdf: [1.0; 2], line: [CONTINUUM; 2] };
        prop_assert!(sane(phase.eval(wo, wi, &lambda)));
        let s = phase.sample(wo, u, &lambda);
        prop_assert!(sane(s.p) && s.p[0] > 0.0 && (s.wi.length() - 1.0).abs() < 1e-5, "{s:?}");
    }
}
