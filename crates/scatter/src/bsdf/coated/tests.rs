use super::*;
use tyndall_base::vec::vec3;
use tyndall_base::warp::{pdf_cosine_hemisphere, sample_cosine_hemisphere};
use tyndall_testkit::{Rng, Welford};

fn coated(alpha: f32, base: Base<4>, albedo: f32, thickness: f32) -> Coated<4> {
    Coated {
        coat: Interface { eta: 1.5, distribution: TrowbridgeReitz::new(alpha, alpha) },
        dispersive: false,
        base,
        thickness,
        albedo: Spectrum([albedo, 0.5 * albedo, 0.9 * albedo, 0.2 * albedo]),
        g: 0.4,
        max_depth: 60,
        samples: 1,
        seed: 0,
    }
}

fn diffuse(r: [f32; 4]) -> Base<4> {
    Base::Diffuse(Diffuse { reflectance: Spectrum(r) })
}

fn metal(alpha: f32) -> Base<4> {
    let (eta, k) = (Spectrum([0.2, 0.4, 1.2, 1.5]), Spectrum([4.0, 2.4, 1.8, 5.0]));
    Base::Conductor(Conductor { eta, k, distribution: TrowbridgeReitz::new(alpha, alpha) })
}

const COLOURS: [f32; 4] = [0.2, 0.5, 0.9, 0.0];

fn models() -> Vec<(&'static str, Coated<4>)> {
    vec![
        ("smooth on diffuse", coated(0.0, diffuse(COLOURS), 0.0, 0.01)),
        ("rough on diffuse", coated(0.3, diffuse(COLOURS), 0.0, 0.01)),
        ("smooth on metal", coated(0.0, metal(0.3), 0.0, 0.05)),
        ("rough on metal", coated(0.3, metal(0.2), 0.0, 0.05)),
        ("rough on a mirror", coated(0.4, metal(0.0), 0.0, 0.05)),
        ("cloudy on diffuse", coated(0.2, diffuse(COLOURS), 0.9, 0.6)),
        ("cloudy and smooth on metal", coated(0.0, metal(0.0), 0.8, 0.4)),
    ]
}

/// Features of a direction, by which two distributions of light are compared.
fn features(wi: Vec3) -> [f64; 4] {
    let near = |x: f32, y: f32| f64::from(u8::from(wi.dot(vec3(x, y, 0.7).normalize()) > 0.85));
    [1.0, f64::from(wi.z), near(0.6, 0.2), near(-0.6, -0.2)]
}

/// Walks that leave by chance and walks that are led towards a direction carry the same light.
#[test]
fn samples_and_evaluations_agree() {
    let n = 25_000;
    let models = models();
    for (name, model) in &models {
        let wo = vec3(0.6, 0.2, 0.7).normalize();
        let mut sums = vec![Welford::default(); 16];
        let mut rng = Rng::new(3);
        for i in 0..n {
            let m = Coated { seed: i, ..*model };
            let by_chance = m.sample(wo, rng.f32(), rng.f32x2()).filter(|s| !s.flags.is_delta());
            let wi = sample_cosine_hemisphere(rng.f32x2());
            let led = m.eval(wo, wi) * (wi.z / pdf_cosine_hemisphere(wi.z));
            for (k, sum) in sums.iter_mut().enumerate() {
                let (lane, feature) = (k / 4, k % 4);
                let chance = by_chance.map_or(0.0, |s| {
                    f64::from(s.f[lane] * s.wi.z.abs() / s.pdf[lane]) * features(s.wi)[feature]
                });
                sum.add(chance - f64::from(led[lane]) * features(wi)[feature]);
            }
        }
        for (k, sum) in sums.iter().enumerate() {
            if sum.mean() != 0.0 {
                sum.z_test(0.0)
                    .assert_ok(&format!("{name}, lane {}, feature {}", k / 4, k % 4), 16 * models.len());
            }
        }
    }
}

/// A walk neither gains light nor, where nothing absorbs, loses any but what a rough boundary loses from inside at each
/// of about three meetings, some 10 % (see the dielectric's own tests).
#[test]
fn a_white_coat_keeps_all_light() {
    for (alpha, albedo, floor) in [(0.0, 0.0, 0.985), (0.0, 1.0, 0.999), (0.3, 1.0, 0.9f64.powi(4))] {
        let mut model = coated(alpha, diffuse([1.0; 4]), albedo, if albedo > 0.0 { 0.3 } else { 1e-3 });
        model.albedo = Spectrum::splat(albedo);
        model.max_depth = 400;
        for wo in [vec3(0.0, 0.0, 1.0), vec3(0.7, 0.1, 0.5).normalize(), vec3(0.3, 0.2, -0.9).normalize()] {
            let mut rng = Rng::new(8);
            let mut total = Welford::default();
            for i in 0..20_000 {
                let s = Coated { seed: i, ..model }.sample(wo, rng.f32(), rng.f32x2());
                total.add(s.map_or(0.0, |s| f64::from(s.f[0] * s.wi.z.abs() / s.pdf[0])));
            }
            let error = 4.0 * total.se();
            assert!(total.mean() < 1.0 + error, "alpha {alpha}, {wo:?}: {}", total.mean());
            assert!(total.mean() > floor - error, "alpha {alpha}, {wo:?}: {}", total.mean());
        }
    }
}

/// Without a step of the index, and hardly any medium, the base is all there is.
#[test]
fn a_coat_of_air_is_no_coat() {
    let mut model = coated(0.0, diffuse(COLOURS), 0.0, 1e-6);
    model.coat.eta = 1.0;
    let mut rng = Rng::new(2);
    for _ in 0..100 {
        let (mut wo, mut wi) = (Vec3::from(rng.direction()), Vec3::from(rng.direction()));
        (wo.z, wi.z) = (wo.z.abs() + 0.05, wi.z.abs() + 0.05);
        let f = model.eval(wo.normalize(), wi.normalize());
        for k in 0..4 {
            assert!((f[k] - COLOURS[k] / std::f32::consts::PI).abs() < 1e-4, "{f:?}");
        }
    }
}

/// Both sides alike, in the mean reciprocal, nothing through.
#[test]
fn reciprocal_and_two_sided() {
    let (a, b) = (vec3(0.6, 0.2, 0.7).normalize(), vec3(-0.2, 0.5, 0.5).normalize());
    let models = models();
    for (name, model) in &models {
        let mut difference = [Welford::default(); 4];
        for seed in 0..15_000 {
            let m = Coated { seed, ..*model };
            let (there, back) = (m.eval(a, b), m.eval(b, a));
            assert_eq!(m.eval(-a, -b), there, "{name}");
            assert!(m.eval(a, -b).is_zero() && m.pdf(-a, b).is_zero());
            (0..4).for_each(|k| difference[k].add(f64::from(there[k] - back[k])));
        }
        for (k, d) in difference.iter().enumerate().filter(|(_, d)| d.mean() != 0.0) {
            d.z_test(0.0).assert_ok(&format!("{name}, lane {k}"), 4 * models.len());
        }
    }
}

#[test]
fn a_mirror_under_smooth_glass_is_a_mirror() {
    let model = coated(0.0, metal(0.0), 0.0, 0.01);
    assert!(model.flags().is_delta());
    let wo = vec3(0.6, 0.2, 0.7).normalize();
    let s = model.sample(wo, 0.5, [0.3, 0.3]).expect("a reflection");
    assert!((s.wi - vec3(-wo.x, -wo.y, wo.z)).length() < 1e-5 && s.flags.is_delta());
}
