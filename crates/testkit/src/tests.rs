//! The tests are tested: levels hold under the null hypothesis, faults are found, tables are matched.

use crate::distribution::{
    chi2_upper, normal_cdf, normal_quantile, normal_two_sided, student_cdf, student_quantile,
    student_two_sided,
};
use crate::*;

#[test]
fn tabulated_values() {
    let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-4, "{a} against {b}");
    near(normal_quantile(0.975), 1.959_964);
    near(normal_cdf(-3.0), 1.349_898e-3);
    near(normal_two_sided(8.0), 1.244_192e-15);
    near(student_quantile(0.975, 7.0), 2.364_624);
    near(student_quantile(0.995, 1.0), 63.656_74);
    near(student_cdf(-2.0, 5.0), 0.050_969_74);
    near(student_two_sided(10.0, 7.0), 2.139_420e-5);
    near(chi2_upper(18.307_04, 10.0), 0.05);
    near(chi2_upper(149.449_25, 100.0), 1e-3);
}

#[test]
fn sidak_and_holm() {
    assert!((sidak(0.05, 10) - 0.005_116_197).abs() < 1e-9);
    assert!((1.0 - (1.0 - sidak(ALPHA, 1000)).powi(1000) - ALPHA).abs() < 1e-12);
    assert_eq!(holm(0.05, &[0.01, 0.04, 0.03, 0.005]), [true, false, false, true]);
    assert_eq!(holm(0.05, &[]), [false; 0]);
}

#[test]
fn welford_agrees_with_two_passes_and_merges() {
    let x: Vec<f64> = (0..100).map(|i| 1e6 + f64::from(i * i % 37)).collect();
    let mean = x.iter().sum::<f64>() / 100.0;
    let variance = x.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / 99.0;
    let all: Welford = x.iter().copied().collect();
    let (mut a, b): (Welford, Welford) =
        (x[..30].iter().copied().collect(), x[30..].iter().copied().collect());
    a.merge(&b);
    a.merge(&Welford::default());
    for w in [all, a] {
        assert!(
            (w.mean() - mean).abs() < 1e-6 && (w.variance() / variance - 1.0).abs() < 1e-9 && w.n() == 100
        );
    }
    assert!(Welford::default().variance().is_nan());
}

#[test]
fn chi_square_of_known_counts() {
    // a die thrown 60 times
    let c = chi2_test(&[5.0, 8.0, 9.0, 8.0, 10.0, 20.0], &[10.0; 6], 5.0);
    assert!((c.statistic - 13.4).abs() < 1e-12 && c.dof == 5.0 && (c.p - 0.019_905).abs() < 1e-5);
    // cells below the minimum are pooled from the smallest up
    let c = chi2_test(&[1.0, 2.0, 3.0, 30.0], &[2.0, 2.0, 2.0, 30.0], 5.0);
    assert_eq!((c.statistic, c.dof), (0.0, 1.0));
    assert_eq!(chi2_test(&[10.0, 9.0, 1.0], &[10.0, 10.0, 0.0], 5.0).p, 0.0);
}

#[test]
fn p_values_are_uniform_under_the_null() {
    let p = |seed| chi2_1d(|r| Some(r.f64()), |_| 1.0, [0.0, 1.0], 4000, seed).p;
    ks_test((0..500).map(p), |x| x).assert_ok("chi-square", 1);
    let z = |seed| {
        let mut rng = Rng::new(seed);
        (0..400).map(|_| rng.f64()).collect::<Welford>().z_test(0.5).p
    };
    ks_test((1000..1500).map(z), |x| x).assert_ok("z", 1);
}

#[test]
fn small_faults_are_found() {
    // 2 % too much density toward the pole
    let cap = |w: [f32; 3]| (1.0 + 0.02 * f64::from(w[2])) / (4.0 * std::f64::consts::PI);
    assert!(chi2_sphere(|r| Some(r.direction()), cap, 2_000_000, 1).p < ALPHA);
    let uniform = |_: [f32; 3]| 0.25 / std::f64::consts::PI;
    chi2_sphere(|r| Some(r.direction()), uniform, 400_000, 2).assert_ok("uniform directions", 1);
    // rejections that the density knows of, and that it does not
    let half = |r: &mut Rng| (r.f32() < 0.5).then(|| r.direction());
    chi2_sphere(half, |w| 0.5 * uniform(w), 400_000, 3).assert_ok("half rejected", 1);
    assert!(chi2_sphere(half, uniform, 400_000, 4).p < 1e-12);
    assert!(
        z_test(1.0, 0.0, 1.0).p == 1.0
            && z_test(1.0, 0.0, 2.0).p == 0.0
            && z_test(f64::NAN, 1.0, 1.0).p == 0.0
    );
}

#[test]
#[should_panic(expected = "z = ")]
fn a_wrong_mean_is_refused() {
    let mut rng = Rng::new(5);
    assert_mean("uniform", (0..10_000).map(|_| rng.f64()), 0.52, z_max(1));
}

#[test]
fn cubature_follows_peaks_and_jumps() {
    let peak = |x: f64, y: f64| (-((x - 0.3).powi(2) + (y - 0.6).powi(2)) * 1e3).exp();
    let exact = std::f64::consts::PI * 1e-3;
    assert!((integrate_2d(&peak, [0.0, 1.0], [0.0, 1.0], 1e-12) / exact - 1.0).abs() < 1e-6);
    let disk = |x: f64, y: f64| f64::from(u8::from(x * x + y * y < 1.0));
    let quarter = integrate_2d(&disk, [0.0, 1.0], [0.0, 1.0], 1e-9);
    // an arc of pi / 2 through parts of side 2^-11, where a jump costs at most half the greatest weight, 0.14
    let bound = std::f64::consts::FRAC_PI_2 * 0.14 / 2048.0;
    assert!((quarter - std::f64::consts::FRAC_PI_4).abs() < bound, "{quarter}");
    let norm = integrate_sphere(&|w| f64::from(w[2].max(0.0)) / std::f64::consts::PI, 1e-8);
    assert!((norm - 1.0).abs() < 1e-6);
}
