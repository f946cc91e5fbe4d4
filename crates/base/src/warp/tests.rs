//! Chi-square of every warp against its density, inverses, and edges of the unit square.

use super::*;
use crate::vec::vec3;
use tyndall_testkit::{ChiSquare, Rng, chi2_1d, chi2_2d, chi2_sphere};

const N: usize = 400_000;
/// Warps tested in this file: the family that shares the level.
const FAMILY: usize = 24;
/// The greatest number a generator of 24-bit numbers returns.
const TOP: f32 = 1.0 - f32::EPSILON / 2.0;

fn square([x, y]: [f32; 2]) -> [f64; 2] {
    [f64::from(x), f64::from(y)]
}

fn line(sample: impl Fn(f32) -> f32, pdf: impl Fn(f32) -> f32, range: [f64; 2]) -> ChiSquare {
    chi2_1d(|rng: &mut Rng| Some(f64::from(sample(rng.f32()))), |x| f64::from(pdf(x as f32)), range, N, 1)
}

#[test]
fn directions_follow_their_density() {
    let sphere =
        chi2_sphere(|r| Some(sample_uniform_sphere(r.f32x2()).into()), |_| pdf_uniform_sphere().into(), N, 1);
    sphere.assert_ok("sphere", FAMILY);
    let upper = |w: [f32; 3], p: f32| if w[2] > 0.0 { f64::from(p) } else { 0.0 };
    let uniform = |w| upper(w, pdf_uniform_hemisphere());
    chi2_sphere(|r| Some(sample_uniform_hemisphere(r.f32x2()).into()), uniform, N, 2)
        .assert_ok("hemisphere", FAMILY);
    let cosine = |w: [f32; 3]| upper(w, pdf_cosine_hemisphere(w[2]));
    chi2_sphere(|r| Some(sample_cosine_hemisphere(r.f32x2()).into()), cosine, N, 3)
        .assert_ok("cosine", FAMILY);
}

#[test]
fn cones_follow_their_density() {
    for (i, height) in [1e-6_f32, 0.01, 0.3, 1.0, 2.0].into_iter().enumerate() {
        // in the cone's own coordinates: share of the height and azimuth
        let draw = |r: &mut Rng| {
            let w = sample_uniform_cone(r.f32x2(), height);
            let rest = f64::from(w.x * w.x + w.y * w.y) / (1.0 + f64::from(w.z));
            Some([rest / f64::from(height), f64::from(w.y).atan2(f64::from(w.x))])
        };
        let pi = std::f64::consts::PI;
        let density = f64::from(pdf_uniform_cone(height)) * f64::from(height);
        // the southern tip of the whole sphere loses digits of the height
        let top = if height == 2.0 { 0.99 } else { 1.0 + 1e-6 };
        let pdf = |p: [f64; 2]| if p[0] <= 1.0 { density } else { 0.0 };
        chi2_2d(draw, pdf, [[0.0, top], [-pi, pi]], N, i as u64).assert_ok("cone", FAMILY);
    }
}

#[test]
fn directions_by_chord_follow_their_density() {
    // the density has a pole on the axis: in coordinates (u, turn) it is even
    let draw = |r: &mut Rng| {
        let w = sample_chord(r.f32x2());
        let chord = f64::from((w - vec3(0.0, 0.0, 1.0)).length());
        Some([0.5 * chord, f64::from(w.y).atan2(f64::from(w.x))])
    };
    let pi = std::f64::consts::PI;
    // solid angle per (u, phi): sin theta d theta = 4 u du
    let pdf = |p: [f64; 2]| 4.0 * p[0] * f64::from(pdf_chord(2.0 * p[0] as f32));
    chi2_2d(draw, pdf, [[1e-3, 1.0 + 1e-6], [-pi, pi]], N, 17).assert_ok("chord", FAMILY);
}

#[test]
fn disks_follow_their_density() {
    let pdf =
        |p: [f64; 2]| if p[0] * p[0] + p[1] * p[1] <= 1.0 { f64::from(pdf_uniform_disk()) } else { 0.0 };
    let warps: [fn([f32; 2]) -> crate::Vec2; 2] = [sample_concentric_disk, sample_polar_disk];
    for sample in warps {
        let draw = |r: &mut Rng| Some(sample(r.f32x2())).map(|p| square([p.x, p.y]));
        chi2_2d(draw, pdf, [[-1.0, 1.0], [-1.0, 1.0]], N, 4).assert_ok("disk", FAMILY);
    }
}

#[test]
fn triangle_is_uniform_in_barycentric_coordinates() {
    let pdf = |p: [f64; 2]| if p[0] + p[1] <= 1.0 { 2.0 } else { 0.0 };
    let draw = |r: &mut Rng| Some(sample_uniform_triangle(r.f32x2())).map(|b| square([b[0], b[1]]));
    chi2_2d(draw, pdf, [[0.0, 1.0], [0.0, 1.0]], N, 5).assert_ok("triangle", FAMILY);
}

#[test]
fn linear_and_bilinear_follow_their_density() {
    for (a, b) in [(1.0, 3.0), (2.0, 0.0), (0.0, 0.5), (1.0, 1.0)] {
        line(|u| sample_linear(u, a, b), |x| pdf_linear(x, a, b), [0.0, 1.0]).assert_ok("linear", FAMILY);
    }
    for w in [[1.0, 2.0, 0.5, 3.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 1.0]] {
        let draw = |r: &mut Rng| Some(square(sample_bilinear(r.f32x2(), w)));
        let pdf = |p: [f64; 2]| f64::from(pdf_bilinear(p.map(|x| x as f32), w));
        chi2_2d(draw, pdf, [[0.0, 1.0], [0.0, 1.0]], N, 6).assert_ok("bilinear", FAMILY);
    }
}

#[test]
fn distances_follow_their_density() {
    line(|u| sample_exponential(u, 0.7), |t| pdf_exponential(t, 0.7), [0.0, 12.0])
        .assert_ok("exponential", FAMILY);
    for (sigma, t_max) in [(0.7, 4.0), (1e-3, 2.0), (1e-6, 3.0), (0.0, 3.0), (20.0, 5.0)] {
        let sample = |u| sample_truncated_exponential(u, sigma, t_max);
        let pdf = |t| pdf_truncated_exponential(t, sigma, t_max);
        line(sample, pdf, [0.0, f64::from(t_max)]).assert_ok("truncated exponential", FAMILY);
    }
    for (delta, d, a, b) in
        [(2.0, 0.5, 0.0, 5.0), (-3.0, 1.0, 0.1, 2.0), (9.0, 4.0, 1.0, 3.0), (1.0, 0.01, 0.0, 3.0)]
    {
        let e = Equiangular::new(delta, d, a, b);
        line(|u| e.sample(u), |t| e.pdf(t), [f64::from(a), f64::from(b)]).assert_ok("equiangular", FAMILY);
    }
}

#[test]
fn equiangular_reaches_to_infinity() {
    for (delta, d) in [(2.0, 0.5), (-3.0, 1.0), (0.7, 0.0)] {
        let e = Equiangular::new(delta, d, 0.0, f32::INFINITY);
        assert!((0..1000).all(|i| e.pdf(e.sample(i as f32 / 1000.0)).is_finite()));
        let last = e.sample(TOP);
        assert!(last > 1e3 * d.max(1e-4) && last.is_finite(), "{last}");
    }
    let e = Equiangular::new(2.0, 0.5, 0.0, f32::INFINITY);
    line(|u| e.sample(u), |t| e.pdf(t), [0.0, 30.0]).assert_ok("equiangular to infinity", FAMILY);
}

#[test]
fn inverses_lead_back() {
    let mut rng = Rng::new(9);
    for _ in 0..10_000 {
        let u = rng.f32x2();
        let near = |v: [f32; 2]| (v[0] - u[0]).abs() < 2e-5 && (v[1] - u[1]).abs() < 2e-5;
        assert!(near(invert_concentric_disk(sample_concentric_disk(u))), "disk {u:?}");
        let w = [1.0, 2.0, 0.5, 3.0];
        assert!(near(invert_bilinear(sample_bilinear(u, w), w)), "bilinear {u:?}");
    }
}

#[test]
fn corners_of_the_square_stay_in_range() {
    for u in [[0.0, 0.0], [0.0, TOP], [TOP, 0.0], [TOP, TOP], [0.5, 0.5]] {
        for w in [sample_uniform_sphere(u), sample_cosine_hemisphere(u), sample_uniform_cone(u, 1e-9)] {
            assert!((w.length() - 1.0).abs() < 1e-6, "{u:?} -> {w:?}");
        }
        let b = sample_uniform_triangle(u);
        assert!(b.iter().all(|&x| (0.0..=1.0).contains(&x)), "{u:?} -> {b:?}");
        assert!(sample_exponential(u[0], 0.5) < 34.0);
        let e = Equiangular::new(1.0, 0.0, 0.0, 2.0);
        assert!((0.0..=2.0).contains(&e.sample(u[0])) && e.pdf(e.sample(u[0])).is_finite());
    }
    assert_eq!(sample_exponential(0.5, 0.0), f32::INFINITY);
    assert_eq!(sample_uniform_cone([0.3, 0.3], 0.0), vec3(0.0, 0.0, 1.0));
}

#[test]
fn golden_bits() {
    use crate::hash::{hash2, mix64, to_unit_f32};
    let triangle =
        SphericalTriangle::new([vec3(1.0, 2.0, 3.0), vec3(-2.0, 1.5, 0.5), vec3(0.3, -1.0, 2.0)]).unwrap();
    let rectangle =
        SphericalRectangle::new(vec3(-1.0, -1.0, 1.0), vec3(2.0, 0.0, 0.0), vec3(0.0, 2.0, 0.0)).unwrap();
    let equiangular = Equiangular::new(2.0, 0.5, 0.0, 5.0);
    let hash = (0..20_000_u32).fold(0, |h, i| {
        let u = [to_unit_f32(hash2(i, 0)), to_unit_f32(hash2(i, 1))];
        let disk = [sample_concentric_disk(u), sample_polar_disk(u)].map(|p| vec3(p.x, p.y, 0.0));
        let t = equiangular.sample(u[0]);
        let lengths = [sample_exponential(u[0], 0.7), sample_truncated_exponential(u[0], 0.7, 3.0), t];
        let density =
            vec3(equiangular.pdf(t), pdf_exponential(t, 0.7), pdf_truncated_exponential(t, 0.1, 9.0));
        let vectors = [
            disk[0],
            disk[1],
            sample_cosine_hemisphere(u),
            sample_uniform_sphere(u),
            sample_uniform_cone(u, 0.01),
            sample_uniform_triangle(u).into(),
            triangle.sample(u),
            rectangle.sample(u),
            lengths.into(),
            density,
        ];
        let [a, b] = sample_bilinear(u, [1.0, 2.0, 0.5, 3.0]);
        vectors
            .iter()
            .flat_map(|v| v.to_array())
            .chain([a, b])
            .fold(h, |h, x| mix64(h ^ u64::from(x.to_bits())))
    });
    assert_eq!(hash, 0x5d64_0fac_b8ca_8307, "{hash:#018x}");
}
