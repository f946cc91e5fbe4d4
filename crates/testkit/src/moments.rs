use crate::distribution::{normal_quantile, normal_two_sided};
use crate::family::{ALPHA, sidak};

/// Running mean and variance (Welford 1962), with the skewness and kurtosis left to the reader.
#[derive(Clone, Copy, Debug, Default)]
pub struct Welford {
    n: u64,
    mean: f64,
    m2: f64,
}

impl Welford {
    /// Takes one value in.
    pub fn add(&mut self, x: f64) {
        self.n += 1;
        let d = x - self.mean;
        self.mean += d / self.n as f64;
        self.m2 += d * (x - self.mean);
    }

    /// Takes the values of `other` in (Chan et al. 1979).
    pub fn merge(&mut self, other: &Self) {
        let (a, b) = (self.n as f64, other.n as f64);
        if b == 0.0 {
            return;
        }
        let d = other.mean - self.mean;
        self.n += other.n;
        self.mean += d * b / (a + b);
        self.m2 += other.m2 + d * d * a * b / (a + b);
    }

    /// Number of values.
    pub fn n(&self) -> u64 {
        self.n
    }

    /// Sample mean.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Unbiased variance; NaN below two values.
    pub fn variance(&self) -> f64 {
        if self.n < 2 { f64::NAN } else { self.m2 / (self.n - 1) as f64 }
    }

    /// Standard error of the mean.
    pub fn se(&self) -> f64 {
        (self.variance() / self.n as f64).sqrt()
    }

    /// Tests the mean against `expected`.
    pub fn z_test(&self, expected: f64) -> ZTest {
        z_test(self.mean, self.se(), expected)
    }
}

impl Extend<f64> for Welford {
    fn extend<I: IntoIterator<Item = f64>>(&mut self, values: I) {
        values.into_iter().for_each(|x| self.add(x));
    }
}

impl FromIterator<f64> for Welford {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        let mut w = Self::default();
        w.extend(values);
        w
    }
}

/// A mean compared with its expectation.
#[derive(Clone, Copy, Debug)]
#[must_use]
pub struct ZTest {
    /// `(mean - expected) / se`.
    pub z: f64,
    /// Two-sided p-value.
    pub p: f64,
}

impl ZTest {
    /// Panics when the null hypothesis falls at [`ALPHA`], shared over a family of `tests`.
    #[track_caller]
    pub fn assert_ok(self, name: &str, tests: usize) {
        let level = sidak(ALPHA, tests);
        assert!(self.p > level, "{name}: z = {:.2}, p = {:.3e} <= {level:.1e}", self.z, self.p);
    }
}

/// Two-sided z-test of a mean with standard error `se`. A zero error demands equality.
pub fn z_test(mean: f64, se: f64, expected: f64) -> ZTest {
    let difference = mean - expected;
    let z = if difference == 0.0 { 0.0 } else { difference / se };
    ZTest { z, p: if z.is_nan() { 0.0 } else { normal_two_sided(z) } }
}

/// The greatest |z| that passes at [`ALPHA`] in a family of `tests`.
pub fn z_max(tests: usize) -> f64 {
    -normal_quantile(0.5 * sidak(ALPHA, tests))
}

/// Panics unless the mean of `samples` lies within `z_max` standard errors of `expected`.
///
/// The error is the samples' own, so there must be enough of them for the normal law (some thousands for mild tails).
#[track_caller]
pub fn assert_mean(name: &str, samples: impl IntoIterator<Item = f64>, expected: f64, z_max: f64) {
    let w: Welford = samples.into_iter().collect();
    assert!(w.n() > 1, "{name}: expected at least two samples, got {}", w.n());
    let z = w.z_test(expected).z;
    assert!(
        z.abs() <= z_max,
        "{name}: mean {} +- {} (n = {}) against {expected}: z = {z:.2}, allowed {z_max:.2}",
        w.mean(),
        w.se(),
        w.n()
    );
}
