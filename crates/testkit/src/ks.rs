use crate::family::{ALPHA, sidak};

/// The outcome of a Kolmogorov-Smirnov test.
#[derive(Clone, Copy, Debug)]
#[must_use]
pub struct KsTest {
    /// Greatest distance between the empirical and the expected distribution function.
    pub d: f64,
    /// The chance of a distance at least as large.
    pub p: f64,
}

impl KsTest {
    /// Panics when the null hypothesis falls at [`ALPHA`], shared over a family of `tests`.
    #[track_caller]
    pub fn assert_ok(self, name: &str, tests: usize) {
        let level = sidak(ALPHA, tests);
        assert!(self.p > level, "{name}: D = {:.5}, p = {:.3e} <= {level:.1e}", self.d, self.p);
    }
}

/// Tests samples against a continuous distribution function (Kolmogorov's limit law with the correction of Stephens 1970;
/// at least 8 samples).
pub fn ks_test(samples: impl IntoIterator<Item = f64>, cdf: impl Fn(f64) -> f64) -> KsTest {
    let mut samples: Vec<f64> = samples.into_iter().collect();
    assert!(samples.len() >= 8, "expected at least 8 samples, got {}", samples.len());
    samples.sort_by(f64::total_cmp);
    let n = samples.len() as f64;
    let distance = |(i, &x): (usize, &f64)| {
        let expected = cdf(x);
        (expected - i as f64 / n).max((i as f64 + 1.0) / n - expected)
    };
    let d = samples.iter().enumerate().map(distance).fold(0.0, f64::max);
    KsTest { d, p: kolmogorov((n.sqrt() + 0.12 + 0.11 / n.sqrt()) * d) }
}

/// `P(K >= x) = 2 sum_k (-1)^(k-1) e^(-2 k^2 x^2)`.
fn kolmogorov(x: f64) -> f64 {
    if x < 0.2 {
        return 1.0; // to 12 digits, where the series converges slowly
    }
    let term = |k: i32| if k % 2 == 1 { 2.0 } else { -2.0 } * (-2.0 * f64::from(k * k) * x * x).exp();
    (1..=30).map(term).sum::<f64>().clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Rng;

    #[test]
    fn tabulated_quantiles() {
        // 5 % and 1 % points of the limit law
        assert!((kolmogorov(1.3581) - 0.05).abs() < 1e-5);
        assert!((kolmogorov(1.6276) - 0.01).abs() < 1e-5);
        assert_eq!(kolmogorov(0.0), 1.0);
    }

    #[test]
    fn uniform_numbers_pass_and_their_squares_do_not() {
        let mut rng = Rng::new(1);
        let numbers: Vec<f64> = (0..5000).map(|_| rng.f64()).collect();
        ks_test(numbers.iter().copied(), |x| x).assert_ok("uniform", 1);
        assert!(ks_test(numbers.iter().map(|x| x * x), |x| x).p < 1e-12);
    }

    #[test]
    fn p_values_are_uniform_under_the_null() {
        let mut rng = Rng::new(2);
        let p: Vec<f64> = (0..2000).map(|_| ks_test((0..50).map(|_| rng.f64()), |x| x).p).collect();
        ks_test(p, |x| x).assert_ok("p-values of 50 samples", 1);
    }
}
