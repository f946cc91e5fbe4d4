//! Samplers of lights and of their directions against their densities.
#![allow(clippy::unwrap_used)] // a failure here is a failed test

use tyndall_base::{Vec3, vec::vec3};
use tyndall_geometry::{Accel, BuildOptions, Shape, ShapeGroup, Sphere, Transform};
use tyndall_spectral::{Curve, Emission, Wavelengths, curve::SigmoidPolynomial};
use tyndall_testkit::{chi2_2d, chi2_discrete};
use tyndall_transport::light::{
    EnvironmentImage, ImageInfiniteLight, LiSample, Light, LightRules, LightSet, PointLight, RgbEmission,
    Selection, Skies, UniformInfiniteLight, sphere_to_square, square_to_sphere,
};

const DRAWS: usize = 200_000;
/// Texels a side: bins of the test do not straddle texels.
const SIZE: usize = 8;
/// The map's own x, y and z in the scene.
const AXES: [Vec3; 3] = [vec3(0.0, 0.6, 0.8), vec3(1.0, 0.0, 0.0), vec3(0.0, 0.8, -0.6)];

fn flat(value: f32) -> Emission {
    Emission::new(Curve::Constant(value), &[]).unwrap()
}

/// An uneven map, one texel of which is black, turned about an axis.
fn map() -> ImageInfiniteLight {
    map_of(|i| if i == 5 { 0.0 } else { 0.1 + (i * 7 % 13) as f32 })
}

fn map_of(scale: impl Fn(usize) -> f32) -> ImageInfiniteLight {
    let texel = |i: usize| RgbEmission { sigmoid: SigmoidPolynomial::constant(0.5), scale: scale(i) };
    let texels: Vec<RgbEmission> = (0..SIZE * SIZE).map(texel).collect();
    let weights = texels.iter().map(|t| t.scale).collect();
    let image =
        EnvironmentImage { size: SIZE, texels, white: Curve::Constant(1.0), weights, mean: flat(3.0) };
    ImageInfiniteLight::new(image, AXES).unwrap()
}

/// Into the light's own frame: the axes are orthonormal.
fn local(d: Vec3) -> Vec3 {
    vec3(d.dot(AXES[0]), d.dot(AXES[1]), d.dot(AXES[2]))
}

/// The direction in the scene of a point of the map.
fn world(uv: [f32; 2]) -> Vec3 {
    let d = square_to_sphere(uv);
    AXES[0] * d.x + AXES[1] * d.y + AXES[2] * d.z
}

/// In the square of the equal-area map, where the density is constant over texels.
fn follow(sample: impl Fn([f32; 2]) -> Option<LiSample<4>>, density: impl Fn(Vec3) -> f32, what: &str) {
    let sample = |rng: &mut tyndall_testkit::Rng| {
        let s = sample([rng.f32(), rng.f32()])?;
        assert!((s.pdf / density(s.wi) - 1.0).abs() < 1e-3 || on_an_edge(s.wi), "{:?}", s.wi);
        Some(sphere_to_square(local(s.wi)).map(f64::from))
    };
    let pdf = |uv: [f64; 2]| 4.0 * std::f64::consts::PI * f64::from(density(world(uv.map(|v| v as f32))));
    chi2_2d(sample, pdf, [[0.0, 1.0]; 2], DRAWS, 1).assert_ok(what, 1);
}

#[test]
fn directions_of_an_environment_map() {
    let light = map();
    let w = Wavelengths::continuum([450.0, 550.0, 650.0, 750.0], [1.0; 4]);
    follow(|u| light.sample_li(u, &w), |d| light.pdf(d), "environment map");
    let beside = |u| light.sample_li_beside_chance(Vec3::ZERO, u, &w);
    follow(beside, |d| light.pdf_beside_chance(Vec3::ZERO, d), "what is above its mean");
    // the mean lies between the sixth and the seventh of the thirteen steps
    let dim = (0..64).filter(|i| i * 7 % 13 <= 5);
    for texel in dim {
        let uv = [(texel % SIZE) as f32 + 0.5, (texel / SIZE) as f32 + 0.5].map(|v| v / SIZE as f32);
        let d = world(uv);
        assert!(light.pdf(d) > 0.0 || texel == 5, "the whole map has a density");
        assert_eq!(light.pdf_beside_chance(Vec3::ZERO, d), 0.0, "texel {texel} is left to chance");
    }
}

#[test]
fn a_map_of_one_radiance_is_sampled_like_a_sky_without_an_image() {
    let light = map_of(|_| 0.7);
    let w = Wavelengths::continuum([450.0, 550.0, 650.0, 750.0], [1.0; 4]);
    let up = vec3(0.6, 0.0, 0.8);
    for half in [Vec3::ZERO, up] {
        let beside = |u| light.sample_li_beside_chance(half, u, &w);
        follow(beside, |d| light.pdf_beside_chance(half, d), "an even map");
    }
    assert_eq!(light.pdf_beside_chance(up, up), std::f32::consts::FRAC_1_PI);
}

/// A sky of one radiance lights points of media by chance alone, and surfaces by samples: beside a few lights from the first
/// surface, where each is sampled, and else from all.
#[test]
fn even_skies_are_left_to_chance() {
    let (n, id) = (vec3(0.0, 0.0, 1.0), tyndall_transport::LightId);
    let weigh = |e: &Emission| f64::from(e.continuum().eval(550.0));
    let sphere = Sphere::new(Transform::translate(0.0, 0.0, 0.0), 1.0, -1.0, 1.0, 360.0).unwrap();
    let group = ShapeGroup::from(Shape::Sphere(sphere));
    let accel = Accel::build(vec![group], &[], Vec::new(), &BuildOptions::default()).unwrap();
    let sky = || Light::Infinite(UniformInfiniteLight { emission: flat(0.2) });
    let even = || Light::Image(map_of(|_| 0.4));
    let lamp = || Light::Point(PointLight { p: Vec3::ZERO, intensity: flat(1.0) });
    let rules = |selection, skies| LightRules { selection, skies, ..LightRules::default() };
    let p = vec3(0.3, 0.2, 2.0);
    for selection in [Selection::Tree, Selection::Power, Selection::Uniform] {
        for sky in [sky(), even()] {
            let set = |lights, skies| {
                LightSet::new(lights, 2.0, &weigh).choosing(rules(selection, skies), &accel, 2.0, &weigh)
            };
            let both = set(vec![lamp(), sky.clone()], Skies::Auto);
            assert_eq!(both.pmf_at(p, Vec3::ZERO, id(1)), 0.0);
            assert!((both.pmf_at(p, Vec3::ZERO, id(0)) - 1.0).abs() < 1e-6, "the lamp is all that is left");
            assert_eq!(both.select_at(p, Vec3::ZERO, 0.99).unwrap().id, id(0));
            assert_eq!(both.pmf_at(p, n, id(1)), 0.0, "surfaces that are not the first sample the lamp");
            assert_eq!(
                both.few().map(|(ids, times)| (ids.len(), times)),
                Some((2, 1)),
                "the first samples both"
            );
            let not_each = LightRules { each: false, ..rules(selection, Skies::Auto) };
            let drawn = LightSet::new(vec![lamp(), sky.clone()], 2.0, &weigh);
            let drawn = drawn.choosing(not_each, &accel, 2.0, &weigh);
            let many = set([vec![lamp(); 6], vec![sky.clone()]].concat(), Skies::Auto);
            for (set, sky) in [(&drawn, id(1)), (&many, id(6))] {
                assert!(set.pmf_at(p, n, sky) > 0.0, "all surfaces choose among all");
                assert_eq!(set.pmf_at(p, Vec3::ZERO, sky), 0.0);
            }
            let all = set(vec![lamp(), sky.clone()], Skies::Always);
            assert!(all.pmf_at(p, Vec3::ZERO, id(1)) > 0.0, "unless they are asked for");
            let alone = set(vec![sky], Skies::Auto);
            assert!(alone.select_at(p, Vec3::ZERO, 0.5).is_none() && alone.select_at(p, n, 0.5).is_some());
        }
        // an image with a sun stays
        let set = LightSet::new(vec![Light::Image(map())], 2.0, &weigh);
        let set = set.choosing(rules(selection, Skies::Auto), &accel, 2.0, &weigh);
        assert_eq!(set.pmf_at(p, Vec3::ZERO, id(0)), 1.0);
    }
}

/// Within rounding of the border of two texels.
fn on_an_edge(d: Vec3) -> bool {
    let near = |t: f32| {
        let cells = t * SIZE as f32;
        (cells - cells.round()).abs() < 1e-3
    };
    sphere_to_square(local(d)).into_iter().any(near)
}

#[test]
fn choice_of_a_light() {
    let point = |power: f32| Light::Point(PointLight { p: Vec3::ZERO, intensity: flat(power) });
    let sky = Light::Infinite(UniformInfiniteLight { emission: flat(0.2) });
    let lights = vec![point(1.0), sky, point(5.0), point(0.0), point(0.3)];
    let set = LightSet::new(lights, 2.0, &|e: &Emission| f64::from(e.continuum().eval(550.0)));
    let ids = || (0..5u32).map(tyndall_transport::LightId);
    let all: Vec<f64> = ids().map(|id| f64::from(set.pmf(id))).collect();
    let local: Vec<f64> = ids().map(|id| f64::from(set.pmf_local(id))).collect();
    assert!((all.iter().sum::<f64>() - 1.0).abs() < 1e-6 && (local.iter().sum::<f64>() - 1.0).abs() < 1e-6);
    assert!(local[1] == 0.0 && all[3] == 0.0, "the sky is nowhere, and darkness is never chosen");
    let draw = |rng: &mut tyndall_testkit::Rng| set.select(rng.f32()).map(|s| s.id.index());
    chi2_discrete(draw, &all, DRAWS, 2).assert_ok("all lights", 2);
    let draw = |rng: &mut tyndall_testkit::Rng| set.select_local(rng.f32()).map(|s| s.id.index());
    chi2_discrete(draw, &local, DRAWS, 3).assert_ok("lights somewhere", 2);
}
