//! Mirrors, smooth boundaries and plates; what dispersion does to the lanes.

use super::tests::{ETA, densities, directions, rough};
use super::*;
use crate::sphere_tests::integrate;
use tyndall_base::vec::vec3;
use tyndall_testkit::{Rng, Welford};

fn glass() -> Bsdf<'static, 4> {
    Bsdf::Dielectric(Dielectric::new(ETA, TrowbridgeReitz::SMOOTH))
}

fn weight(s: &BsdfSample<4>) -> Spectrum<4> {
    s.f * s.wi.z.abs()
}

/// The two events of a smooth boundary: `uc` just at its ends.
fn events(bsdf: &Bsdf<'_, 4>, wo: Vec3) -> Vec<BsdfSample<4>> {
    let ends = [0.0, 1.0_f32.next_down()].map(|uc| bsdf.sample(wo, uc, [0.5; 2]).unwrap());
    if ends[0].wi == ends[1].wi { vec![ends[0]] } else { ends.to_vec() }
}

#[test]
fn a_smooth_boundary_keeps_all_light() {
    let plate = Bsdf::ThinDielectric(ThinDielectric { eta: ETA });
    for bsdf in [glass(), plate] {
        for wo in directions() {
            let mut sum = Spectrum::<4>::ZERO;
            for s in events(&bsdf, wo) {
                let gain = s.eta * s.eta;
                assert!((weight(&s)[0] * gain - s.pdf[0]).abs() < 1e-6);
                sum += weight(&s) * gain;
            }
            let lanes = if bsdf.flags().contains(BsdfFlags::DELTA) && bsdf == plate { 4 } else { 1 };
            for k in 0..lanes {
                assert!((sum[k] - 1.0).abs() < 1e-6, "{bsdf:?} lane {k}: {}", sum[k]);
            }
            assert!(bsdf.is_delta() && bsdf.eval(wo, wo).is_zero() && bsdf.pdf(wo, wo).is_zero());
        }
    }
}

#[test]
fn only_lanes_of_the_heros_index_refract_with_it() {
    let eta = Spectrum([1.5, 1.6, 1.5, 1.4]);
    let bsdf = Bsdf::Dielectric(Dielectric::new(eta, TrowbridgeReitz::SMOOTH));
    let wo = directions()[1];
    let [reflected, refracted] = events(&bsdf, wo)[..] else { panic!("two events") };
    assert!(reflected.flags.is_reflection() && reflected.pdf.min_lane() > 0.0 && reflected.eta == 1.0);
    assert!(refracted.flags.is_transmission() && refracted.eta == 1.5);
    assert_eq!(refracted.f[0], refracted.f[2]);
    assert_eq!([refracted.f[1], refracted.f[3], refracted.pdf[1], refracted.pdf[3]], [0.0; 4]);
    for k in 0..4 {
        assert!((weight(&reflected)[k] - fresnel::fresnel_dielectric(wo.z, eta[k])).abs() < 1e-7);
    }
}

#[test]
fn importance_is_not_squeezed() {
    for s in events(&glass().with_mode(TransportMode::Importance), directions()[1]) {
        assert!((weight(&s)[0] - s.pdf[0]).abs() < 1e-6);
    }
}

#[test]
fn a_mirror_reflects_with_each_lanes_fresnel() {
    let (eta, k) = (Spectrum([0.14, 0.4, 1.2, 1.5]), Spectrum([4.0, 2.4, 1.8, 7.0]));
    let mirror = Bsdf::Conductor(Conductor { eta, k, distribution: TrowbridgeReitz::SMOOTH });
    let wo = directions()[3];
    let s = mirror.sample(wo, 0.5, [0.2, 0.9]).unwrap();
    assert_eq!((s.wi, s.pdf), (vec3(-wo.x, -wo.y, wo.z), Spectrum::ONE));
    for j in 0..4 {
        assert!((weight(&s)[j] - fresnel::fresnel_conductor(wo.z, eta[j], k[j])).abs() < 1e-6);
    }
}

/// Stokes: a plate reflects `2 R / (1 + R)`, as the sum over its internal reflections does.
#[test]
fn a_plate_sums_its_internal_reflections() {
    let (wo, r) = (directions()[1], fresnel::fresnel_dielectric(directions()[1].z, 1.5));
    let series: f32 =
        (0..20).fold((0.0, (1.0 - r) * (1.0 - r) * r), |(sum, term), _| (sum + term, term * r * r)).0;
    let plate = ThinDielectric { eta: Spectrum([1.5]) };
    assert!((plate.reflectance(wo)[0] - (r + series)).abs() < 1e-6);
}

#[test]
fn an_index_matched_boundary_is_invisible_however_rough() {
    let bsdf = Bsdf::Dielectric(Dielectric::new(Spectrum::<4>::ONE, rough(0.5, 0.5))).regularized();
    let wo = directions()[1];
    let s = bsdf.sample(wo, 0.3, [0.4, 0.4]).unwrap();
    assert!((s.wi + wo).length() < 1e-6 && (weight(&s)[3] / s.pdf[0] - 1.0).abs() < 1e-6);
}

#[test]
fn regularized_widens_mirrors_only_on_request() {
    assert!(!glass().regularized().is_delta() && glass().is_delta());
    assert_eq!(rough(0.2, 0.5).regularized(), rough(0.3, 0.5));
}

/// What lane `k` brings in from a sky that differs in direction and lane.
fn sky(wi: Vec3, k: usize) -> f64 {
    f64::from(1.5 + wi.x + 0.5 * wi.y * wi.z) * (1.0 + k as f64)
}

/// `f |cos| L / mean_k pdf_k` per lane: the balance heuristic over the heroes that could have sampled `wi`.
fn spectral_mis(s: &BsdfSample<4>) -> [f64; 4] {
    let mean = f64::from(s.pdf.mean());
    std::array::from_fn(|k| f64::from(weight(s)[k]) * sky(s.wi, k) / mean)
}

/// `bsdf` with lane `hero` in front.
fn led_by<'m>(bsdf: &Bsdf<'m, 4>, hero: usize) -> Bsdf<'m, 4> {
    let Bsdf::Dielectric(mut b) = *bsdf else { panic!("a dielectric") };
    b.eta.0.swap(0, hero);
    Bsdf::Dielectric(b)
}

fn unswap(mut s: BsdfSample<4>, hero: usize) -> BsdfSample<4> {
    s.f.0.swap(0, hero);
    s.pdf.0.swap(0, hero);
    s
}

/// Over all heroes and both events of a dispersive boundary, each lane gets what it would get alone.
#[test]
fn dispersion_with_spectral_mis_equals_one_wavelength_at_a_time() {
    let bsdf = glass();
    for wo in directions() {
        let mut mean = [0.0; 4];
        for hero in 0..4 {
            for s in events(&led_by(&bsdf, hero), wo) {
                let probability = f64::from(s.pdf[0]);
                let estimate = spectral_mis(&unswap(s, hero));
                (0..4).for_each(|k| mean[k] += 0.25 * probability * estimate[k]);
            }
        }
        for (k, got) in mean.into_iter().enumerate() {
            let alone =
                Bsdf::<'_, 1>::Dielectric(Dielectric::new(Spectrum([ETA[k]]), TrowbridgeReitz::SMOOTH));
            let want: f64 = [0.0, 1.0_f32.next_down()]
                .map(|uc| alone.sample(wo, uc, [0.5; 2]).unwrap())
                .iter()
                .zip(if wo.z < 0.0 && fresnel::fresnel_dielectric(wo.z, ETA[k]) == 1.0 { 0..1 } else { 0..2 })
                .map(|(s, _)| f64::from(s.f[0] * s.wi.z.abs()) * sky(s.wi, k))
                .sum();
            assert!((got - want).abs() < 1e-5 * want, "lane {k}, wo {wo:?}: {got} instead of {want}");
        }
    }
}

/// The same through a rough boundary, where every lane has a density of its own: heroes at random against quadrature.
#[test]
fn rough_dispersion_with_spectral_mis_equals_quadrature() {
    let bsdf = Bsdf::Dielectric(Dielectric::new(ETA, rough(0.3, 0.15)));
    for wo in directions() {
        let mut rng = Rng::new(21);
        let mut means = [Welford::default(), Welford::default(), Welford::default(), Welford::default()];
        for _ in 0..100_000 {
            let hero = rng.below(4) as usize;
            let s = led_by(&bsdf, hero).sample(wo, rng.f32(), rng.f32x2());
            let estimate = s.map_or([0.0; 4], |s| spectral_mis(&unswap(s, hero)));
            means.iter_mut().zip(estimate).for_each(|(m, e)| m.add(e));
        }
        for (k, mean) in means.iter().enumerate() {
            let want = integrate(|wi| f64::from(bsdf.eval(wo, wi)[k] * wi.z.abs()) * sky(wi, k));
            mean.z_test(want).assert_ok(&format!("lane {k}, wo {wo:?}"), 16);
        }
    }
}

#[test]
fn flags_name_the_events() {
    for (name, bsdf) in densities([0, 1, 2, 3]) {
        assert!(!bsdf.is_delta(), "{name}");
        let transmits = name.contains("glass") || name.contains("transmission") || name.contains("denser");
        assert_eq!(bsdf.flags().contains(BsdfFlags::TRANSMISSION), transmits, "{name}");
        assert!(bsdf.flags().intersects(BsdfFlags::DIFFUSE | BsdfFlags::GLOSSY), "{name}");
    }
}
