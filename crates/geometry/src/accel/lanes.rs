//! Eight and four `f32` in step: one operation graph, several instruction sets.
//!
//! A value of a [`Lanes`] type is the permission to use its instructions, so its methods are safe to call. Minimum and
//! maximum return the second operand when the comparison is false, as SSE does; multiply-add rounds once. The
//! kernels are generic over this trait, so that every implementation gives the same bits.

/// Arithmetic on 8 and 4 lanes.
pub(crate) trait Lanes: Copy {
    type F8: Copy;
    type F4: Copy;

    fn splat8(self, x: f32) -> Self::F8;
    fn load8(self, x: &[f32; 8]) -> Self::F8;
    fn store8(self, x: Self::F8) -> [f32; 8];
    fn sub8(self, a: Self::F8, b: Self::F8) -> Self::F8;
    fn mul8(self, a: Self::F8, b: Self::F8) -> Self::F8;
    fn min8(self, a: Self::F8, b: Self::F8) -> Self::F8;
    fn max8(self, a: Self::F8, b: Self::F8) -> Self::F8;
    /// Bit i: `a[i] <= b[i]`.
    fn le8(self, a: Self::F8, b: Self::F8) -> u32;

    fn splat4(self, x: f32) -> Self::F4;
    fn load4(self, x: &[f32; 4]) -> Self::F4;
    fn store4(self, x: Self::F4) -> [f32; 4];
    fn add4(self, a: Self::F4, b: Self::F4) -> Self::F4;
    fn sub4(self, a: Self::F4, b: Self::F4) -> Self::F4;
    fn mul4(self, a: Self::F4, b: Self::F4) -> Self::F4;
    fn min4(self, a: Self::F4, b: Self::F4) -> Self::F4;
    fn max4(self, a: Self::F4, b: Self::F4) -> Self::F4;
    /// `c - a b`, rounded once.
    fn fnmadd4(self, a: Self::F4, b: Self::F4, c: Self::F4) -> Self::F4;
    /// Bit i: `a[i] <= b[i]`.
    fn le4(self, a: Self::F4, b: Self::F4) -> u32;

    /// Asks for the cache line at `p`; `p` need not be valid.
    fn prefetch<T>(self, p: *const T);
}

/// Plain arrays: every machine can do it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Portable;

#[inline(always)]
fn zip<const N: usize>(a: [f32; N], b: [f32; N], f: impl Fn(f32, f32) -> f32) -> [f32; N] {
    std::array::from_fn(|i| f(a[i], b[i]))
}

#[inline(always)]
fn le<const N: usize>(a: [f32; N], b: [f32; N]) -> u32 {
    (0..N).fold(0, |m, i| m | (u32::from(a[i] <= b[i]) << i))
}

#[inline(always)]
fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline(always)]
fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

impl Lanes for Portable {
    type F8 = [f32; 8];
    type F4 = [f32; 4];

    #[inline(always)]
    fn splat8(self, x: f32) -> [f32; 8] {
        [x; 8]
    }
    #[inline(always)]
    fn load8(self, x: &[f32; 8]) -> [f32; 8] {
        *x
    }
    #[inline(always)]
    fn store8(self, x: [f32; 8]) -> [f32; 8] {
        x
    }
    #[inline(always)]
    fn sub8(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        zip(a, b, |a, b| a - b)
    }
    #[inline(always)]
    fn mul8(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        zip(a, b, |a, b| a * b)
    }
    #[inline(always)]
    fn min8(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        zip(a, b, lesser)
    }
    #[inline(always)]
    fn max8(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        zip(a, b, greater)
    }
    #[inline(always)]
    fn le8(self, a: [f32; 8], b: [f32; 8]) -> u32 {
        le(a, b)
    }
    #[inline(always)]
    fn splat4(self, x: f32) -> [f32; 4] {
        [x; 4]
    }
    #[inline(always)]
    fn load4(self, x: &[f32; 4]) -> [f32; 4] {
        *x
    }
    #[inline(always)]
    fn store4(self, x: [f32; 4]) -> [f32; 4] {
        x
    }
    #[inline(always)]
    fn add4(self, a: [f32; 4], b: [f32; 4]) -> [f32; 4] {
        zip(a, b, |a, b| a + b)
    }
    #[inline(always)]
    fn sub4(self, a: [f32; 4], b: [f32; 4]) -> [f32; 4] {
        zip(a, b, |a, b| a - b)
    }
    #[inline(always)]
    fn mul4(self, a: [f32; 4], b: [f32; 4]) -> [f32; 4] {
        zip(a, b, |a, b| a * b)
    }
    #[inline(always)]
    fn min4(self, a: [f32; 4], b: [f32; 4]) -> [f32; 4] {
        zip(a, b, lesser)
    }
    #[inline(always)]
    fn max4(self, a: [f32; 4], b: [f32; 4]) -> [f32; 4] {
        zip(a, b, greater)
    }
    #[inline(always)]
    fn fnmadd4(self, a: [f32; 4], b: [f32; 4], c: [f32; 4]) -> [f32; 4] {
        std::array::from_fn(|i| (-a[i]).mul_add(b[i], c[i]))
    }
    #[inline(always)]
    fn le4(self, a: [f32; 4], b: [f32; 4]) -> u32 {
        le(a, b)
    }
    #[inline(always)]
    fn prefetch<T>(self, _p: *const T) {}
}
