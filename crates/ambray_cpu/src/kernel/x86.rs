//! AVX2 and AVX-512 lanes.
//!
//! The types are only ever named by kernels that run inside `#[target_feature]` functions, which [`Isa`](crate::Isa)
//! lets run only where the features were detected; that is the SAFETY condition of every intrinsic here.

use std::arch::x86_64::*;

use super::lanes::Lanes;

/// 8 lanes in one AVX register.
#[derive(Clone, Copy)]
pub(crate) struct Avx2x8(__m256);

/// 16 lanes in two AVX registers.
#[derive(Clone, Copy)]
pub(crate) struct Avx2x16(Avx2x8, Avx2x8);

/// 16 lanes in one AVX-512 register.
#[derive(Clone, Copy)]
pub(crate) struct Avx512x16(__m512);

impl Lanes<8> for Avx2x8 {
    #[inline(always)]
    fn splat(x: f32) -> Self {
        // SAFETY: AVX2 is enabled, see the module.
        Self(unsafe { _mm256_set1_ps(x) })
    }
    #[inline(always)]
    fn load(x: &[f32; 8]) -> Self {
        // SAFETY: AVX2 is enabled, see the module; the array holds 8 values.
        Self(unsafe { _mm256_loadu_ps(x.as_ptr()) })
    }
    #[inline(always)]
    fn to_array(self) -> [f32; 8] {
        let mut out = [0.0; 8];
        // SAFETY: AVX2 is enabled, see the module; the array holds 8 values.
        unsafe { _mm256_storeu_ps(out.as_mut_ptr(), self.0) };
        out
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        // SAFETY: AVX2 is enabled, see the module.
        Self(unsafe { _mm256_add_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        // SAFETY: AVX2 is enabled, see the module.
        Self(unsafe { _mm256_sub_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        // SAFETY: AVX2 is enabled, see the module.
        Self(unsafe { _mm256_mul_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        // SAFETY: AVX2 is enabled, see the module.
        Self(unsafe { _mm256_div_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: AVX2 is enabled, see the module.
        Self(unsafe { _mm256_min_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: AVX2 is enabled, see the module.
        Self(unsafe { _mm256_max_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn le(self, other: Self) -> u32 {
        // SAFETY: AVX2 is enabled, see the module.
        unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(self.0, other.0)).cast_unsigned() }
    }
    #[inline(always)]
    fn lt(self, other: Self) -> u32 {
        // SAFETY: AVX2 is enabled, see the module.
        unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0)).cast_unsigned() }
    }
    #[inline(always)]
    fn select(mask: u32, a: Self, b: Self) -> Self {
        // SAFETY: AVX2 is enabled, see the module.
        unsafe {
            let bits = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
            let chosen =
                _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(mask.cast_signed()), bits), bits);
            Self(_mm256_blendv_ps(b.0, a.0, _mm256_castsi256_ps(chosen)))
        }
    }
    #[inline(always)]
    fn smallest(self) -> f32 {
        // SAFETY: AVX2 is enabled, see the module.
        unsafe {
            let x = _mm_min_ps(_mm256_castps256_ps128(self.0), _mm256_extractf128_ps::<1>(self.0));
            let x = _mm_min_ps(x, _mm_movehl_ps(x, x));
            _mm_cvtss_f32(_mm_min_ss(x, _mm_movehdup_ps(x)))
        }
    }
    #[inline(always)]
    fn largest(self) -> f32 {
        // SAFETY: AVX2 is enabled, see the module.
        unsafe {
            let x = _mm_max_ps(_mm256_castps256_ps128(self.0), _mm256_extractf128_ps::<1>(self.0));
            let x = _mm_max_ps(x, _mm_movehl_ps(x, x));
            _mm_cvtss_f32(_mm_max_ss(x, _mm_movehdup_ps(x)))
        }
    }
}

impl Lanes<16> for Avx2x16 {
    #[inline(always)]
    fn splat(x: f32) -> Self {
        let half = Avx2x8::splat(x);
        Self(half, half)
    }
    #[inline(always)]
    fn load(x: &[f32; 16]) -> Self {
        let (low, high) = x.as_chunks::<8>().0.split_at(1);
        Self(Avx2x8::load(&low[0]), Avx2x8::load(&high[0]))
    }
    #[inline(always)]
    fn to_array(self) -> [f32; 16] {
        let mut out = [0.0; 16];
        out[..8].copy_from_slice(&self.0.to_array());
        out[8..].copy_from_slice(&self.1.to_array());
        out
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(self.0.add(other.0), self.1.add(other.1))
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(self.0.sub(other.0), self.1.sub(other.1))
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self(self.0.mul(other.0), self.1.mul(other.1))
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        Self(self.0.div(other.0), self.1.div(other.1))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(self.0.min(other.0), self.1.min(other.1))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0), self.1.max(other.1))
    }
    #[inline(always)]
    fn le(self, other: Self) -> u32 {
        self.0.le(other.0) | self.1.le(other.1) << 8
    }
    #[inline(always)]
    fn lt(self, other: Self) -> u32 {
        self.0.lt(other.0) | self.1.lt(other.1) << 8
    }
    #[inline(always)]
    fn select(mask: u32, a: Self, b: Self) -> Self {
        Self(Avx2x8::select(mask, a.0, b.0), Avx2x8::select(mask >> 8, a.1, b.1))
    }
    #[inline(always)]
    fn smallest(self) -> f32 {
        self.0.min(self.1).smallest()
    }
    #[inline(always)]
    fn largest(self) -> f32 {
        self.0.max(self.1).largest()
    }
}

impl Lanes<16> for Avx512x16 {
    #[inline(always)]
    fn splat(x: f32) -> Self {
        // SAFETY: AVX-512 is enabled, see the module.
        Self(unsafe { _mm512_set1_ps(x) })
    }
    #[inline(always)]
    fn load(x: &[f32; 16]) -> Self {
        // SAFETY: AVX-512 is enabled, see the module; the array holds 16 values.
        Self(unsafe { _mm512_loadu_ps(x.as_ptr()) })
    }
    #[inline(always)]
    fn to_array(self) -> [f32; 16] {
        let mut out = [0.0; 16];
        // SAFETY: AVX-512 is enabled, see the module; the array holds 16 values.
        unsafe { _mm512_storeu_ps(out.as_mut_ptr(), self.0) };
        out
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        // SAFETY: AVX-512 is enabled, see the module.
        Self(unsafe { _mm512_add_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        // SAFETY: AVX-512 is enabled, see the module.
        Self(unsafe { _mm512_sub_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        // SAFETY: AVX-512 is enabled, see the module.
        Self(unsafe { _mm512_mul_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        // SAFETY: AVX-512 is enabled, see the module.
        Self(unsafe { _mm512_div_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: AVX-512 is enabled, see the module.
        Self(unsafe { _mm512_min_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: AVX-512 is enabled, see the module.
        Self(unsafe { _mm512_max_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn le(self, other: Self) -> u32 {
        // SAFETY: AVX-512 is enabled, see the module.
        u32::from(unsafe { _mm512_cmp_ps_mask::<_CMP_LE_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn lt(self, other: Self) -> u32 {
        // SAFETY: AVX-512 is enabled, see the module.
        u32::from(unsafe { _mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn select(mask: u32, a: Self, b: Self) -> Self {
        // SAFETY: AVX-512 is enabled, see the module.
        Self(unsafe { _mm512_mask_blend_ps(mask as __mmask16, b.0, a.0) })
    }
    #[inline(always)]
    fn smallest(self) -> f32 {
        // SAFETY: AVX-512 is enabled, see the module.
        unsafe { _mm512_reduce_min_ps(self.0) }
    }
    #[inline(always)]
    fn largest(self) -> f32 {
        // SAFETY: AVX-512 is enabled, see the module.
        unsafe { _mm512_reduce_max_ps(self.0) }
    }
}
