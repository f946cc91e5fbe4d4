//! Eight and four `f32`, and four `f64`, in step: one operation graph, several instruction sets.
//!
//! A value of a [`Lanes`] type is the permission to use its instructions, so its methods are safe to call. Minimum and
//! maximum return the second operand when the comparison is false, as SSE does; multiply-add rounds once. The
//! kernels are generic over this trait, so that every implementation gives the same bits.

/// Arithmetic on 8 and 4 lanes.
pub(crate) trait Lanes: Copy {
    type F8: Copy;
    type F4: Copy;
    type D4: Copy;

    fn splat8(self, x: f32) -> Self::F8;
    fn load8(self, x: &[f32; 8]) -> Self::F8;
    fn store8(self, x: Self::F8) -> [f32; 8];
    fn sub8(self, a: Self::F8, b: Self::F8) -> Self::F8;
    fn mul8(self, a: Self::F8, b: Self::F8) -> Self::F8;
    fn min8(self, a: Self::F8, b: Self::F8) -> Self::F8;
    fn max8(self, a: Self::F8, b: Self::F8) -> Self::F8;
    /// Bit i: `a[i] <= b[i]`.
    fn le8(self, a: Self::F8, b: Self::F8) -> u32;
    fn add8(self, a: Self::F8, b: Self::F8) -> Self::F8;
    fn div8(self, a: Self::F8, b: Self::F8) -> Self::F8;
    fn abs8(self, a: Self::F8) -> Self::F8;
    /// `|a|` with the sign of `b`.
    fn copysign8(self, a: Self::F8, b: Self::F8) -> Self::F8;
    /// `c - a b`, rounded once.
    fn fnmadd8(self, a: Self::F8, b: Self::F8, c: Self::F8) -> Self::F8;
    /// `a b - c`, rounded once or twice, whichever is faster: for what may differ in its last bits.
    fn product_minus8(self, a: Self::F8, b: Self::F8, c: Self::F8) -> Self::F8;
    /// `b` in lanes where `sign` has its sign bit set, else `a`.
    fn blend8(self, sign: Self::F8, a: Self::F8, b: Self::F8) -> Self::F8;
    /// Bit i: the sign bit of `a[i]`.
    fn signs8(self, a: Self::F8) -> u32;
    /// The least and the greatest lane, numbers all.
    fn range8(self, a: Self::F8) -> (f32, f32);
    /// Lanes 0 to 3, or 4 to 7.
    fn half8(self, a: Self::F8, high: bool) -> Self::F4;

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

    fn splat4d(self, x: f64) -> Self::D4;
    /// The same numbers in `f64`.
    fn widen4(self, a: Self::F4) -> Self::D4;
    fn add4d(self, a: Self::D4, b: Self::D4) -> Self::D4;
    fn sub4d(self, a: Self::D4, b: Self::D4) -> Self::D4;
    fn mul4d(self, a: Self::D4, b: Self::D4) -> Self::D4;
    fn div4d(self, a: Self::D4, b: Self::D4) -> Self::D4;
    fn abs4d(self, a: Self::D4) -> Self::D4;
    /// Bit i: `a[i] <= b[i]`.
    fn le4d(self, a: Self::D4, b: Self::D4) -> u32;
    /// Bit i: `a[i] < b[i]`.
    fn lt4d(self, a: Self::D4, b: Self::D4) -> u32;

    /// Asks for the cache line at `p`; `p` need not be valid.
    fn prefetch<T>(self, p: *const T);
}

/// Plain arrays: every machine can do it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Portable;

#[inline(always)]
fn zip<T: Copy, const N: usize>(a: [T; N], b: [T; N], f: impl Fn(T, T) -> T) -> [T; N] {
    std::array::from_fn(|i| f(a[i], b[i]))
}

#[inline(always)]
fn le<T: PartialOrd, const N: usize>(a: [T; N], b: [T; N]) -> u32 {
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
    type D4 = [f64; 4];

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
    fn add8(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        zip(a, b, |a, b| a + b)
    }
    #[inline(always)]
    fn div8(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        zip(a, b, |a, b| a / b)
    }
    #[inline(always)]
    fn abs8(self, a: [f32; 8]) -> [f32; 8] {
        a.map(f32::abs)
    }
    #[inline(always)]
    fn copysign8(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        zip(a, b, f32::copysign)
    }
    #[inline(always)]
    fn fnmadd8(self, a: [f32; 8], b: [f32; 8], c: [f32; 8]) -> [f32; 8] {
        std::array::from_fn(|i| (-a[i]).mul_add(b[i], c[i]))
    }
    #[inline(always)]
    fn product_minus8(self, a: [f32; 8], b: [f32; 8], c: [f32; 8]) -> [f32; 8] {
        zip(zip(a, b, |a, b| a * b), c, |ab, c| ab - c)
    }
    #[inline(always)]
    fn blend8(self, sign: [f32; 8], a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        std::array::from_fn(|i| if sign[i].is_sign_negative() { b[i] } else { a[i] })
    }
    #[inline(always)]
    fn signs8(self, a: [f32; 8]) -> u32 {
        (0..8).fold(0, |m, i| m | (u32::from(a[i].is_sign_negative()) << i))
    }
    #[inline(always)]
    fn range8(self, a: [f32; 8]) -> (f32, f32) {
        a.iter().fold((a[0], a[0]), |(lo, hi), &x| (lesser(lo, x), greater(hi, x)))
    }
    #[inline(always)]
    fn half8(self, a: [f32; 8], high: bool) -> [f32; 4] {
        std::array::from_fn(|i| a[i + 4 * usize::from(high)])
    }
    #[inline(always)]
    fn splat4d(self, x: f64) -> [f64; 4] {
        [x; 4]
    }
    #[inline(always)]
    fn widen4(self, a: [f32; 4]) -> [f64; 4] {
        a.map(f64::from)
    }
    #[inline(always)]
    fn add4d(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
        zip(a, b, |a, b| a + b)
    }
    #[inline(always)]
    fn sub4d(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
        zip(a, b, |a, b| a - b)
    }
    #[inline(always)]
    fn mul4d(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
        zip(a, b, |a, b| a * b)
    }
    #[inline(always)]
    fn div4d(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
        zip(a, b, |a, b| a / b)
    }
    #[inline(always)]
    fn abs4d(self, a: [f64; 4]) -> [f64; 4] {
        a.map(f64::abs)
    }
    #[inline(always)]
    fn le4d(self, a: [f64; 4], b: [f64; 4]) -> u32 {
        le(a, b)
    }
    #[inline(always)]
    fn lt4d(self, a: [f64; 4], b: [f64; 4]) -> u32 {
        (0..4).fold(0, |m, i| m | (u32::from(a[i] < b[i]) << i))
    }
    #[inline(always)]
    fn prefetch<T>(self, _p: *const T) {}
}
