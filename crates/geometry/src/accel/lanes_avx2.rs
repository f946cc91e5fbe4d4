//! The lanes on AVX2 and FMA, with the registers of AVX-512 where there are any.

use super::lanes::Lanes;
use std::arch::x86_64::*;

/// Proof that this processor has AVX, AVX2, FMA, BMI1, BMI2, LZCNT and POPCNT; `WIDE`: and AVX-512 F, VL, DQ, BW and CD,
/// whose twice as many registers hold all that a walk needs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx2<const WIDE: bool>(());

impl Avx2<false> {
    /// Asks the processor.
    pub(crate) fn detect() -> Option<Self> {
        let all = is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("fma")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("bmi2")
            && is_x86_feature_detected!("lzcnt")
            && is_x86_feature_detected!("popcnt");
        all.then_some(Self(()))
    }

    /// The same with AVX-512.
    pub(crate) fn wide(self) -> Option<Avx2<true>> {
        let all = is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512vl")
            && is_x86_feature_detected!("avx512dq")
            && is_x86_feature_detected!("avx512bw")
            && is_x86_feature_detected!("avx512cd");
        all.then_some(Avx2(()))
    }
}

impl Avx2<true> {
    /// Without AVX-512.
    pub(crate) fn narrow(self) -> Avx2<false> {
        Avx2(())
    }
}

/// Each body: SAFETY: a value of `Avx2` exists only where [`Avx2::detect`] found the instructions.
macro_rules! lanes {
    ($($name:ident($($arg:ident: $t:ty),*) -> $r:ty { $e:expr })+) => {
        $(#[inline(always)]
        fn $name(self, $($arg: $t),*) -> $r {
            // SAFETY: the token proves the instruction set; loads are from references to whole arrays.
            unsafe { $e }
        })+
    };
}

impl<const WIDE: bool> Lanes for Avx2<WIDE> {
    type F8 = __m256;
    type F4 = __m128;
    type D4 = __m256d;

    lanes! {
        splat8(x: f32) -> __m256 { _mm256_set1_ps(x) }
        load8(x: &[f32; 8]) -> __m256 { _mm256_loadu_ps(x.as_ptr()) }
        store8(x: __m256) -> [f32; 8] { std::mem::transmute::<__m256, [f32; 8]>(x) }
        sub8(a: __m256, b: __m256) -> __m256 { _mm256_sub_ps(a, b) }
        mul8(a: __m256, b: __m256) -> __m256 { _mm256_mul_ps(a, b) }
        min8(a: __m256, b: __m256) -> __m256 { _mm256_min_ps(a, b) }
        max8(a: __m256, b: __m256) -> __m256 { _mm256_max_ps(a, b) }
        le8(a: __m256, b: __m256) -> u32 { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(a, b)) as u32 }
        add8(a: __m256, b: __m256) -> __m256 { _mm256_add_ps(a, b) }
        div8(a: __m256, b: __m256) -> __m256 { _mm256_div_ps(a, b) }
        abs8(a: __m256) -> __m256 { _mm256_andnot_ps(_mm256_set1_ps(-0.0), a) }
        copysign8(a: __m256, b: __m256) -> __m256 { {
            let sign = _mm256_set1_ps(-0.0);
            _mm256_or_ps(_mm256_andnot_ps(sign, a), _mm256_and_ps(sign, b))
        } }
        fnmadd8(a: __m256, b: __m256, c: __m256) -> __m256 { _mm256_fnmadd_ps(a, b, c) }
        product_minus8(a: __m256, b: __m256, c: __m256) -> __m256 { _mm256_fmsub_ps(a, b, c) }
        blend8(sign: __m256, a: __m256, b: __m256) -> __m256 { _mm256_blendv_ps(a, b, sign) }
        signs8(a: __m256) -> u32 { _mm256_movemask_ps(a) as u32 }
        range8(a: __m256) -> (f32, f32) { {
            let (p, q) = (_mm256_castps256_ps128(a), _mm256_extractf128_ps::<1>(a));
            let (lo, hi) = (_mm_min_ps(p, q), _mm_max_ps(p, q));
            let (lo, hi) = (_mm_min_ps(lo, _mm_movehl_ps(lo, lo)), _mm_max_ps(hi, _mm_movehl_ps(hi, hi)));
            let (lo, hi) = (_mm_min_ss(lo, _mm_movehdup_ps(lo)), _mm_max_ss(hi, _mm_movehdup_ps(hi)));
            (_mm_cvtss_f32(lo), _mm_cvtss_f32(hi))
        } }
        half8(a: __m256, high: bool) -> __m128 {
            if high { _mm256_extractf128_ps::<1>(a) } else { _mm256_castps256_ps128(a) }
        }
        splat4(x: f32) -> __m128 { _mm_set1_ps(x) }
        load4(x: &[f32; 4]) -> __m128 { _mm_loadu_ps(x.as_ptr()) }
        store4(x: __m128) -> [f32; 4] { std::mem::transmute::<__m128, [f32; 4]>(x) }
        add4(a: __m128, b: __m128) -> __m128 { _mm_add_ps(a, b) }
        sub4(a: __m128, b: __m128) -> __m128 { _mm_sub_ps(a, b) }
        mul4(a: __m128, b: __m128) -> __m128 { _mm_mul_ps(a, b) }
        min4(a: __m128, b: __m128) -> __m128 { _mm_min_ps(a, b) }
        max4(a: __m128, b: __m128) -> __m128 { _mm_max_ps(a, b) }
        fnmadd4(a: __m128, b: __m128, c: __m128) -> __m128 { _mm_fnmadd_ps(a, b, c) }
        le4(a: __m128, b: __m128) -> u32 { _mm_movemask_ps(_mm_cmple_ps(a, b)) as u32 }
        splat4d(x: f64) -> __m256d { _mm256_set1_pd(x) }
        widen4(a: __m128) -> __m256d { _mm256_cvtps_pd(a) }
        add4d(a: __m256d, b: __m256d) -> __m256d { _mm256_add_pd(a, b) }
        sub4d(a: __m256d, b: __m256d) -> __m256d { _mm256_sub_pd(a, b) }
        mul4d(a: __m256d, b: __m256d) -> __m256d { _mm256_mul_pd(a, b) }
        div4d(a: __m256d, b: __m256d) -> __m256d { _mm256_div_pd(a, b) }
        abs4d(a: __m256d) -> __m256d { _mm256_andnot_pd(_mm256_set1_pd(-0.0), a) }
        le4d(a: __m256d, b: __m256d) -> u32 { _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LE_OQ>(a, b)) as u32 }
        lt4d(a: __m256d, b: __m256d) -> u32 { _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LT_OQ>(a, b)) as u32 }
    }

    #[inline(always)]
    fn prefetch<T>(self, p: *const T) {
        // SAFETY: a prefetch of any address is harmless.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(p.cast()) }
    }
}
