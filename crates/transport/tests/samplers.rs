//! Samplers of lights and of their directions against their densities.
#![allow(clippy::unwrap_used)] // a failure here is a failed test

use tyndall_base::{Vec3, vec::vec3};
use tyndall_spectral::{Curve, Emission, Wavelengths, curve::SigmoidPolynomial};
use tyndall_testkit::{chi2_2d, chi2_discrete};
use tyndall_transport::light::{
    EnvironmentImage, ImageInfiniteLight, Light, LightSet, PointLight, RgbEmission, UniformInfiniteLight,
    sphere_to_square, square_to_sphere,
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
    let texel = |i: usize| RgbEmission {
        sigmoid: SigmoidPolynomial::constant(0.5),
        scale: if i == 5 { 0.0 } else { 0.1 + (i * 7 % 13) as f32 },
    };
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

/// In the square of the equal-area map, where the density is constant over texels.
#[test]
fn directions_of_an_environment_map() {
    let light = map();
    let w = Wavelengths::continuum([450.0, 550.0, 650.0, 750.0], [1.0; 4]);
    let sample = |rng: &mut tyndall_testkit::Rng| {
        let s = light.sample_li([rng.f32(), rng.f32()], &w)?;
        assert!((s.pdf / light.pdf(s.wi) - 1.0).abs() < 1e-3 || on_an_edge(s.wi), "{:?}", s.wi);
        Some(sphere_to_square(local(s.wi)).map(f64::from))
    };
    let pdf = |uv: [f64; 2]| {
        let d = square_to_sphere(uv.map(|v| v as f32));
        let d = AXES[0] * d.x + AXES[1] * d.y + AXES[2] * d.z;
        4.0 * std::f64::consts::PI * f64::from(light.pdf(d))
    };
    chi2_2d(sample, pdf, [[0.0, 1.0]; 2], DRAWS, 1).assert_ok("environment map", 1);
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
