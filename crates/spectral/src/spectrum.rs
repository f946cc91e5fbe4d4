//! Values at the wavelengths of one path.

use std::ops::{Add, AddAssign, Div, DivAssign, Index, IndexMut, Mul, MulAssign, Neg, Sub};

/// `N` values, one per wavelength of the path; lane 0 is the hero. The unit is that of the quantity held.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(16))]
pub struct Spectrum<const N: usize>(pub [f32; N]);

impl<const N: usize> Spectrum<N> {
    /// All lanes zero.
    pub const ZERO: Self = Self([0.0; N]);
    /// All lanes one.
    pub const ONE: Self = Self([1.0; N]);

    /// All lanes `v`.
    #[inline(always)]
    pub const fn splat(v: f32) -> Self {
        Self([v; N])
    }

    /// Lane `k` is `f(k)`.
    #[inline(always)]
    pub fn from_fn(mut f: impl FnMut(usize) -> f32) -> Self {
        // a plain loop: `std::array::from_fn` is not inlined into functions compiled for other instruction sets
        let mut v = [0.0; N];
        for k in 0..N {
            v[k] = f(k);
        }
        Self(v)
    }

    /// Lane-wise `f`.
    #[inline(always)]
    pub fn map(self, mut f: impl FnMut(f32) -> f32) -> Self {
        Self::from_fn(|k| f(self.0[k]))
    }

    /// The hero's value.
    #[inline(always)]
    pub fn hero(&self) -> f32 {
        self.0[0]
    }

    /// Sum over lanes by a fixed tree, so that every instruction set gives the same bits.
    #[inline(always)]
    pub fn sum(&self) -> f32 {
        let mut v = self.0;
        let mut n = N;
        while n > 1 {
            let half = n / 2;
            for k in 0..half {
                v[k] += v[k + half];
            }
            if n % 2 == 1 {
                v[0] += v[n - 1];
            }
            n = half;
        }
        v[0]
    }

    /// Mean over lanes.
    #[inline(always)]
    pub fn mean(&self) -> f32 {
        self.sum() * (1.0 / N as f32)
    }

    /// The greatest lane.
    #[inline(always)]
    pub fn max_lane(&self) -> f32 {
        self.0.iter().fold(f32::NEG_INFINITY, |a, &b| if b > a { b } else { a })
    }

    /// The least lane.
    #[inline(always)]
    pub fn min_lane(&self) -> f32 {
        self.0.iter().fold(f32::INFINITY, |a, &b| if b < a { b } else { a })
    }

    /// True when every lane is zero.
    #[inline(always)]
    pub fn is_zero(&self) -> bool {
        self.0.iter().all(|&v| v == 0.0)
    }

    /// True when no lane is infinite or NaN.
    #[inline(always)]
    pub fn is_finite(&self) -> bool {
        self.0.iter().all(|v| v.is_finite())
    }

    /// Lane-wise maximum with `v`.
    #[inline(always)]
    pub fn max(self, v: f32) -> Self {
        self.map(|a| if a > v { a } else { v })
    }

    /// Lane-wise quotient, 0 where the divisor is 0.
    #[inline(always)]
    pub fn safe_div(self, b: Self) -> Self {
        Self::from_fn(|k| if b.0[k] != 0.0 { self.0[k] / b.0[k] } else { 0.0 })
    }

    /// Lane-wise square root.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        self.map(f32::sqrt)
    }
}

impl<const N: usize> Default for Spectrum<N> {
    fn default() -> Self {
        Self::ZERO
    }
}

impl<const N: usize> Index<usize> for Spectrum<N> {
    type Output = f32;
    #[inline(always)]
    fn index(&self, lane: usize) -> &f32 {
        &self.0[lane]
    }
}

impl<const N: usize> IndexMut<usize> for Spectrum<N> {
    #[inline(always)]
    fn index_mut(&mut self, lane: usize) -> &mut f32 {
        &mut self.0[lane]
    }
}

macro_rules! lanewise {
    ($($op:ident :: $f:ident, $sym:tt);+) => {$(
        impl<const N: usize> $op for Spectrum<N> {
            type Output = Self;
            #[inline(always)]
            fn $f(self, b: Self) -> Self {
                Self::from_fn(|k| self.0[k] $sym b.0[k])
            }
        }
        impl<const N: usize> $op<f32> for Spectrum<N> {
            type Output = Self;
            #[inline(always)]
            fn $f(self, b: f32) -> Self {
                Self::from_fn(|k| self.0[k] $sym b)
            }
        }
    )+};
}
lanewise!(Add::add, +; Sub::sub, -; Mul::mul, *; Div::div, /);

impl<const N: usize> Mul<Spectrum<N>> for f32 {
    type Output = Spectrum<N>;
    #[inline(always)]
    fn mul(self, s: Spectrum<N>) -> Spectrum<N> {
        s * self
    }
}

impl<const N: usize> Neg for Spectrum<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|v| -v)
    }
}

impl<const N: usize> AddAssign for Spectrum<N> {
    #[inline(always)]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}

impl<const N: usize> MulAssign for Spectrum<N> {
    #[inline(always)]
    fn mul_assign(&mut self, b: Self) {
        *self = *self * b;
    }
}

impl<const N: usize> MulAssign<f32> for Spectrum<N> {
    #[inline(always)]
    fn mul_assign(&mut self, b: f32) {
        *self = *self * b;
    }
}

impl<const N: usize> DivAssign<f32> for Spectrum<N> {
    #[inline(always)]
    fn div_assign(&mut self, b: f32) {
        *self = *self / b;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sum_counts_every_lane_once() {
        assert_eq!(Spectrum::<1>([3.0]).sum(), 3.0);
        assert_eq!(Spectrum::<8>(std::array::from_fn(|k| (1 << k) as f32)).sum(), 255.0);
        assert_eq!(Spectrum::<5>(std::array::from_fn(|k| (1 << k) as f32)).sum(), 31.0);
    }

    #[test]
    fn safe_div_gives_zero_over_zero() {
        assert_eq!(Spectrum([0.0, 2.0]).safe_div(Spectrum([0.0, 4.0])).0, [0.0, 0.5]);
    }
}
