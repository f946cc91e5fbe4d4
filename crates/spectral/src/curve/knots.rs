//! Ascending wavelengths with a lookup in constant time.

use crate::error::SpectralError;

/// Ascending wavelengths \[nm\] and, per bucket of equal width, the last knot before the bucket.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Knots {
    lambda: Vec<f32>,
    buckets_per_nm: f32,
    before: Vec<u32>,
}

impl Knots {
    /// At least two finite, strictly ascending, non-negative wavelengths.
    pub(crate) fn new(lambda: &[f32]) -> Result<Self, SpectralError> {
        check_ascending(lambda)?;
        let first = lambda[0];
        let width = lambda[lambda.len() - 1] - first;
        let count = (2 * lambda.len()).clamp(16, 8192).max((width as usize).min(4096));
        let buckets_per_nm = count as f32 / width;
        let bucket = |l: f32| bucket(l - first, buckets_per_nm);
        let before = (0..=count + 1)
            .map(|b| lambda.partition_point(|&k| bucket(k) < b).saturating_sub(1) as u32)
            .collect();
        Ok(Self { lambda: lambda.to_vec(), buckets_per_nm, before })
    }

    #[inline(always)]
    pub(crate) fn first(&self) -> f32 {
        self.lambda[0]
    }

    #[inline(always)]
    pub(crate) fn last(&self) -> f32 {
        self.lambda[self.lambda.len() - 1]
    }

    pub(crate) fn lambda(&self) -> &[f32] {
        &self.lambda
    }

    /// The interval `i` with `lambda[i] <= l < lambda[i + 1]` (the last one at the end), for `first <= l <= last`.
    #[inline(always)]
    pub(crate) fn interval(&self, l: f32) -> usize {
        let bucket = bucket(l - self.lambda[0], self.buckets_per_nm).min(self.before.len() - 2);
        let (mut low, mut high) = (self.before[bucket] as usize, self.before[bucket + 1] as usize);
        while high - low > 4 {
            let middle = (low + high) / 2;
            if self.lambda[middle] <= l {
                low = middle;
            } else {
                high = middle;
            }
        }
        while low + 2 < self.lambda.len() && self.lambda[low + 1] <= l {
            low += 1;
        }
        low
    }
}

/// The bucket of a point `x` nm after the first (`as i32` is one instruction where `as usize` is many).
#[inline(always)]
fn bucket(x: f32, per_nm: f32) -> usize {
    (x * per_nm) as i32 as u32 as usize
}

fn check_ascending(lambda: &[f32]) -> Result<(), SpectralError> {
    if lambda.len() < 2 {
        return Err(SpectralError::TooFew { what: "wavelengths of a table", needed: 2, got: lambda.len() });
    }
    for &l in lambda {
        if !(l.is_finite() && l >= 0.0) {
            let expected = "finite and >= 0";
            return Err(SpectralError::Value { what: "wavelength [nm]", expected, got: f64::from(l) });
        }
    }
    match (1..lambda.len()).find(|&i| lambda[i] <= lambda[i - 1]) {
        Some(index) => {
            Err(SpectralError::Unsorted { index, previous: lambda[index - 1], got: lambda[index] })
        }
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn brute(lambda: &[f32], l: f32) -> usize {
        lambda.partition_point(|&k| k <= l).saturating_sub(1).min(lambda.len() - 2)
    }

    #[test]
    fn interval_agrees_with_a_search_on_uneven_knots() {
        let mut lambda = vec![200.0f32, 300.0, 300.001, 300.002, 555.5, 9000.0];
        lambda.extend((0..3000).map(|i| 9001.0 + i as f32 * 1e-2));
        lambda.push(20000.0);
        let knots = Knots::new(&lambda).unwrap();
        for &k in &lambda {
            for l in [k, k.next_up(), k.next_down()] {
                if (200.0..=20000.0).contains(&l) {
                    assert_eq!(knots.interval(l), brute(&lambda, l), "at {l}");
                }
            }
        }
        for i in 0..20000 {
            let l = 200.0 + 0.99 * i as f32;
            assert_eq!(knots.interval(l), brute(&lambda, l), "at {l}");
        }
    }

    #[test]
    fn bad_lists_are_refused() {
        assert!(matches!(Knots::new(&[400.0]), Err(SpectralError::TooFew { .. })));
        assert!(matches!(Knots::new(&[400.0, 400.0]), Err(SpectralError::Unsorted { index: 1, .. })));
        assert!(matches!(Knots::new(&[400.0, f32::NAN]), Err(SpectralError::Value { .. })));
        assert!(matches!(Knots::new(&[-1.0, 400.0]), Err(SpectralError::Value { .. })));
    }
}
