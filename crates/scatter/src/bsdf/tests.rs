//! What every BSDF must obey, with lanes that differ.

use super::*;
use crate::sphere_tests::{chi2, integrate, integrate_finely, integrate_square};
use tyndall_base::vec::vec3;
use tyndall_testkit::{Rng, Welford};

/// Glass strongly enough dispersive to tell the lanes apart.
pub(super) const ETA: Spectrum<4> = Spectrum([1.45, 1.5, 1.6, 1.8]);

pub(super) fn rough(alpha_x: f32, alpha_y: f32) -> TrowbridgeReitz {
    TrowbridgeReitz::new(alpha_x, alpha_y)
}

/// Models with a density; `order` permutes the lanes, so that each can be the hero.
pub(super) fn densities(order: [usize; 4]) -> Vec<(&'static str, Bsdf<'static, 4>)> {
    let p = |s: [f32; 4]| Spectrum(order.map(|k| s[k]));
    let (reflectance, transmittance) = (p([0.2, 0.5, 0.9, 0.0]), p([0.7, 0.1, 0.0, 0.4]));
    let (eta, k) = (p([0.14, 0.4, 1.2, 1.5]), p([4.0, 2.4, 1.8, 7.0]));
    let conductor = |distribution| Bsdf::Conductor(Conductor { eta, k, distribution });
    let glass = |distribution| Bsdf::Dielectric(Dielectric::new(p(ETA.0), distribution));
    vec![
        ("diffuse", Bsdf::Diffuse(Diffuse { reflectance })),
        (
            "diffuse transmission",
            Bsdf::DiffuseTransmission(DiffuseTransmission { reflectance, transmittance }),
        ),
        ("conductor 0.2", conductor(rough(0.2, 0.2))),
        ("conductor 0.1 x 0.5", conductor(rough(0.1, 0.5))),
        ("conductor 1", conductor(rough(1.0, 1.0))),
        ("glass 0.2", glass(rough(0.2, 0.2))),
        ("glass 0.6 x 0.25", glass(rough(0.6, 0.25))),
        ("glass 1", glass(rough(1.0, 1.0))),
        ("denser above", {
            let eta = p(ETA.0).map(|e| 1.0 / e);
            Bsdf::Dielectric(Dielectric::new(eta, rough(0.4, 0.3)))
        }),
    ]
}

/// Steep, slanted, grazing, from above and below.
pub(super) fn directions() -> [Vec3; 4] {
    [vec3(0.1, 0.05, 1.0), vec3(0.6, -0.5, 0.7), vec3(-0.9, 0.3, 0.12), vec3(0.4, 0.5, -0.6)]
        .map(Vec3::normalize)
}

const ORDER: [usize; 4] = [0, 1, 2, 3];

/// `ORDER` with lane `hero` in front.
fn led_by(hero: usize) -> [usize; 4] {
    let mut order = ORDER;
    order.swap(0, hero);
    order
}

fn swapped(s: Spectrum<4>, hero: usize) -> Spectrum<4> {
    Spectrum(led_by(hero).map(|k| s[k]))
}

#[test]
fn samples_follow_the_density_whoever_is_hero() {
    let tests = densities(ORDER).len() * 4;
    for hero in [0, 3] {
        for (name, bsdf) in densities(led_by(hero)) {
            let wo = directions();
            for wo in [wo[(hero + name.len()) % 4], wo[(hero + name.len() + 1) % 4]] {
                let draw = |rng: &mut Rng| bsdf.sample(wo, rng.f32(), rng.f32x2()).map(|s| s.wi);
                let pdf = |wi: Vec3| f64::from(bsdf.pdf(wo, wi)[0]);
                chi2(draw, pdf, 100_000, 11)
                    .assert_ok(&format!("{name}, lane {hero} leads, wo {wo:?}"), tests);
            }
        }
    }
}

#[test]
fn lanes_do_not_depend_on_their_place() {
    let mut rng = Rng::new(3);
    for hero in 1..4 {
        for ((name, a), (_, b)) in densities(ORDER).into_iter().zip(densities(led_by(hero))) {
            for _ in 0..200 {
                let (wo, wi) = (Vec3::from(rng.direction()), Vec3::from(rng.direction()));
                assert_eq!(swapped(a.eval(wo, wi), hero), b.eval(wo, wi), "{name}");
                assert_eq!(swapped(a.pdf(wo, wi), hero), b.pdf(wo, wi), "{name}");
            }
        }
    }
}

#[test]
fn a_sample_carries_eval_and_pdf() {
    let mut rng = Rng::new(4);
    for (name, bsdf) in densities(ORDER) {
        for _ in 0..2_000 {
            let wo = Vec3::from(rng.direction());
            let Some(s) = bsdf.sample(wo, rng.f32(), rng.f32x2()) else { continue };
            assert_eq!((s.f, s.pdf), (bsdf.eval(wo, s.wi), bsdf.pdf(wo, s.wi)), "{name}");
            assert_eq!((s.f, s.pdf), bsdf.eval_pdf(wo, s.wi), "{name}");
            assert_eq!(s.flags.is_reflection(), wo.z * s.wi.z > 0.0, "{name}");
            assert!((s.wi.length() - 1.0).abs() < 1e-5 && !s.flags.is_delta(), "{name}");
            assert!(s.f.is_finite() && s.pdf.is_finite() && s.f.min_lane() >= 0.0, "{name}: {s:?}");
        }
    }
}

/// The mean of `f |cos| / pdf` against the albedo by quadrature.
#[test]
fn weights_average_to_the_albedo() {
    let models = densities(ORDER);
    for (name, bsdf) in &models {
        for wo in directions() {
            let albedo = integrate(|wi| f64::from(bsdf.eval(wo, wi)[0] * wi.z.abs()));
            let mut rng = Rng::new(9);
            let mut weights = Welford::default();
            for _ in 0..60_000 {
                let s = bsdf.sample(wo, rng.f32(), rng.f32x2());
                weights.add(s.map_or(0.0, |s| f64::from(s.f[0] * s.wi.z.abs() / s.pdf[0])));
            }
            // constant weights have no variance, only rounding
            if (weights.mean() - albedo).abs() > 2e-5 {
                weights.z_test(albedo).assert_ok(&format!("{name}, wo {wo:?}"), 4 * models.len());
            }
        }
    }
}

#[test]
fn reflection_is_reciprocal_and_refraction_up_to_the_squared_index() {
    let mut rng = Rng::new(6);
    let mut refracted = 0;
    for (name, bsdf) in densities(ORDER) {
        for _ in 0..500 {
            let (wo, wi) = (Vec3::from(rng.direction()), Vec3::from(rng.direction()));
            let (there, back) = (bsdf.eval(wo, wi), bsdf.eval(wi, wo));
            let adjoint = bsdf.with_mode(TransportMode::Importance).eval(wo, wi);
            for k in 0..4 {
                let mut factor = 1.0;
                if let (Bsdf::Dielectric(b), true) = (&bsdf, wo.z * wi.z < 0.0) {
                    factor = if wo.z > 0.0 { b.eta[k] } else { 1.0 / b.eta[k] };
                    refracted += usize::from(there[k] > 0.0);
                }
                let close = |a: f32, b: f32| (a - b).abs() <= 1e-4 * b.abs() + 1e-7;
                assert!(close(there[k] * factor * factor, back[k]), "{name}: {there:?} {back:?}");
                assert!(close(adjoint[k], back[k]), "{name}: {adjoint:?} {back:?}");
            }
        }
    }
    assert!(refracted > 500, "{refracted}");
}

/// Energy that leaves in one bounce, facet by facet: each visible normal reflects `F` and refracts `1 - F` along a ray,
/// seen by the share `G / G1` of it. No half vector, no Jacobian.
fn energy_by_facets(d: &TrowbridgeReitz, wo: Vec3, eta: f32) -> f64 {
    let seen = |wi: Vec3| f64::from(d.g_over_cos_cos(wo, wi) * wi.z.abs() / d.g1_over_cos(wo));
    let facet = |u: f64, v: f64| {
        let m = d.sample_visible(wo, [u as f32, v as f32]);
        let f = f64::from(fresnel::fresnel_dielectric(wo.dot(m), eta));
        let up = fresnel::reflect(wo, m);
        let down = fresnel::refract(wo, m, eta).map(|(w, _)| w).filter(|w| w.z * wo.z < 0.0);
        let reflected = if up.z * wo.z > 0.0 { f * seen(up) } else { 0.0 };
        reflected + down.map_or(0.0, |w| (1.0 - f) * seen(w))
    };
    integrate_square(facet)
}

/// In a furnace (radiance 1 above, `n^2` below) all that is missing from 1 are the rays that need a second bounce.
#[test]
fn rough_glass_loses_only_multiple_bounces() {
    for alpha in [0.2, 0.4, 1.0] {
        let d = rough(alpha, 0.5 * alpha);
        for wo in directions() {
            for eta in [ETA[0], ETA[3]] {
                let bsdf = Bsdf::<'_, 1>::Dielectric(Dielectric::new(Spectrum([eta]), d));
                let etap = if wo.z > 0.0 { eta } else { 1.0 / eta };
                let total = integrate_finely(|wi| {
                    let squeeze = if wo.z * wi.z < 0.0 { etap * etap } else { 1.0 };
                    f64::from(bsdf.eval(wo, wi)[0] * wi.z.abs() * squeeze)
                });
                let want = energy_by_facets(&d, wo, eta);
                assert!((total - want).abs() < 1e-3, "alpha {alpha}, eta {eta}, {wo:?}: {total} for {want}");
                assert!(want < 1.0 && (wo.z < 0.3 || want > 1.0 - 0.3 * f64::from(alpha)));
            }
        }
    }
}

#[test]
fn diffuse_surfaces_return_their_reflectance() {
    for (name, bsdf) in densities(ORDER).into_iter().take(2) {
        let total = |k: usize| integrate(|wi| f64::from(bsdf.eval(directions()[1], wi)[k] * wi.z.abs()));
        let want = if name == "diffuse" { [0.2, 0.5, 0.9, 0.0] } else { [0.9, 0.6, 0.9, 0.4] };
        for k in 0..4 {
            assert!((total(k) - want[k]).abs() < 1e-5, "{name}: {} instead of {}", total(k), want[k]);
        }
    }
}

#[test]
fn nothing_is_seen_edge_on() {
    for (name, bsdf) in densities(ORDER) {
        assert!(bsdf.sample(vec3(1.0, 0.0, 0.0), 0.5, [0.5, 0.5]).is_none(), "{name}");
        assert!(bsdf.eval(vec3(1.0, 0.0, 0.0), vec3(0.0, 0.0, 1.0)).is_finite(), "{name}");
    }
}
