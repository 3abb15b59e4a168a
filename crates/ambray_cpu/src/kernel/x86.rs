//! AVX2 and AVX-512 lanes.
//!
//! The types are only ever named by kernels that run inside `#[target_feature]` functions, which [`Isa`](crate::Isa)
//! lets run only where the features were detected; that is the SAFETY condition of every intrinsic here.

use std::arch::x86_64::*;

use ambray_core::trace::Ray;

use super::lanes::{Lanes, Rays};
use super::triangle::Plane;

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
    type Eight = Self;
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
    fn mul_sub(self, factor: Self, less: Self) -> Self {
        // SAFETY: AVX2 and FMA are enabled, see the module.
        Self(unsafe { _mm256_fmsub_ps(self.0, factor.0, less.0) })
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
    fn where_le(a: Self, b: Self, x: Self, y: Self) -> Self {
        // SAFETY: AVX2 is enabled, see the module.
        Self(unsafe { _mm256_blendv_ps(y.0, x.0, _mm256_cmp_ps::<_CMP_LE_OQ>(a.0, b.0)) })
    }
    #[inline(always)]
    fn put(self, mask: u32, into: &mut [f32; 8]) {
        *into = Self::select(mask, self, Self::load(into)).to_array();
    }
    #[inline(always)]
    fn signs(self) -> u32 {
        // SAFETY: AVX2 is enabled, see the module.
        unsafe { _mm256_movemask_ps(self.0).cast_unsigned() }
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
    type Eight = Avx2x8;
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
    fn mul_sub(self, factor: Self, less: Self) -> Self {
        Self(self.0.mul_sub(factor.0, less.0), self.1.mul_sub(factor.1, less.1))
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
    fn where_le(a: Self, b: Self, x: Self, y: Self) -> Self {
        Self(Avx2x8::where_le(a.0, b.0, x.0, y.0), Avx2x8::where_le(a.1, b.1, x.1, y.1))
    }
    #[inline(always)]
    fn put(self, mask: u32, into: &mut [f32; 16]) {
        *into = Self::select(mask, self, Self::load(into)).to_array();
    }
    #[inline(always)]
    fn signs(self) -> u32 {
        self.0.signs() | self.1.signs() << 8
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
    type Eight = Avx2x8;
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
    fn mul_sub(self, factor: Self, less: Self) -> Self {
        // SAFETY: AVX-512 is enabled, see the module.
        Self(unsafe { _mm512_fmsub_ps(self.0, factor.0, less.0) })
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
    fn where_le(a: Self, b: Self, x: Self, y: Self) -> Self {
        // SAFETY: AVX-512 is enabled, see the module.
        Self(unsafe { _mm512_mask_blend_ps(_mm512_cmp_ps_mask::<_CMP_LE_OQ>(a.0, b.0), y.0, x.0) })
    }
    #[inline(always)]
    fn put(self, mask: u32, into: &mut [f32; 16]) {
        // SAFETY: AVX-512 is enabled, see the module; the array holds 16 values.
        unsafe { _mm512_mask_storeu_ps(into.as_mut_ptr(), mask as __mmask16, self.0) };
    }
    #[inline(always)]
    fn signs(self) -> u32 {
        // SAFETY: AVX-512 is enabled, see the module.
        u32::from(unsafe { _mm512_movepi32_mask(_mm512_castps_si512(self.0)) })
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

impl Rays for Avx2x16 {
    #[inline(always)]
    fn transposed(rays: &[Ray; 16]) -> [Self; 8] {
        let (low, high) = rays.as_chunks::<8>().0.split_at(1);
        let (low, high) = (Avx2x8::transposed(&low[0]), Avx2x8::transposed(&high[0]));
        let [a, b, c, d, e, f, g, h] = low;
        let [i, j, k, l, m, n, o, p] = high;
        [Self(a, i), Self(b, j), Self(c, k), Self(d, l), Self(e, m), Self(f, n), Self(g, o), Self(h, p)]
    }
    #[inline(always)]
    fn plane_distances(plane: &Plane, [ox, oy, oz]: [Self; 3], [sx, sy, sz]: [Self; 3]) -> Self {
        Self(
            Avx2x8::distances(plane, [ox.0, oy.0, oz.0], [sx.0, sy.0, sz.0]),
            Avx2x8::distances(plane, [ox.1, oy.1, oz.1], [sx.1, sy.1, sz.1]),
        )
    }
}

impl Avx2x8 {
    /// The numbers of eight rays as structure of arrays.
    #[inline(always)]
    fn transposed(rays: &[Ray; 8]) -> [Self; 8] {
        let rows: &[[f32; 8]; 8] = bytemuck::cast_ref(rays);
        // SAFETY: AVX2 is enabled, see the module.
        unsafe {
            let [a, b, c, d] = [
                Self::load(&rows[0]).0,
                Self::load(&rows[1]).0,
                Self::load(&rows[2]).0,
                Self::load(&rows[3]).0,
            ];
            let [e, f, g, h] = [
                Self::load(&rows[4]).0,
                Self::load(&rows[5]).0,
                Self::load(&rows[6]).0,
                Self::load(&rows[7]).0,
            ];
            // Pairs of rows, then fours, then halves.
            let (ab_low, ab_high) = (_mm256_unpacklo_ps(a, b), _mm256_unpackhi_ps(a, b));
            let (cd_low, cd_high) = (_mm256_unpacklo_ps(c, d), _mm256_unpackhi_ps(c, d));
            let (ef_low, ef_high) = (_mm256_unpacklo_ps(e, f), _mm256_unpackhi_ps(e, f));
            let (gh_low, gh_high) = (_mm256_unpacklo_ps(g, h), _mm256_unpackhi_ps(g, h));
            let first = [
                _mm256_shuffle_ps::<0x44>(ab_low, cd_low),
                _mm256_shuffle_ps::<0xee>(ab_low, cd_low),
                _mm256_shuffle_ps::<0x44>(ab_high, cd_high),
                _mm256_shuffle_ps::<0xee>(ab_high, cd_high),
            ];
            let last = [
                _mm256_shuffle_ps::<0x44>(ef_low, gh_low),
                _mm256_shuffle_ps::<0xee>(ef_low, gh_low),
                _mm256_shuffle_ps::<0x44>(ef_high, gh_high),
                _mm256_shuffle_ps::<0xee>(ef_high, gh_high),
            ];
            [
                Self(_mm256_permute2f128_ps::<0x20>(first[0], last[0])),
                Self(_mm256_permute2f128_ps::<0x20>(first[1], last[1])),
                Self(_mm256_permute2f128_ps::<0x20>(first[2], last[2])),
                Self(_mm256_permute2f128_ps::<0x20>(first[3], last[3])),
                Self(_mm256_permute2f128_ps::<0x31>(first[0], last[0])),
                Self(_mm256_permute2f128_ps::<0x31>(first[1], last[1])),
                Self(_mm256_permute2f128_ps::<0x31>(first[2], last[2])),
                Self(_mm256_permute2f128_ps::<0x31>(first[3], last[3])),
            ]
        }
    }

    #[inline(always)]
    fn distances(plane: &Plane, [ox, oy, oz]: [Self; 3], [sx, sy, sz]: [Self; 3]) -> Self {
        // SAFETY: AVX2 is enabled, see the module.
        unsafe {
            let low = Self::four(
                plane,
                [_mm256_castps256_ps128(ox.0), _mm256_castps256_ps128(oy.0), _mm256_castps256_ps128(oz.0)],
                [_mm256_castps256_ps128(sx.0), _mm256_castps256_ps128(sy.0), _mm256_castps256_ps128(sz.0)],
            );
            let high = Self::four(
                plane,
                [
                    _mm256_extractf128_ps::<1>(ox.0),
                    _mm256_extractf128_ps::<1>(oy.0),
                    _mm256_extractf128_ps::<1>(oz.0),
                ],
                [
                    _mm256_extractf128_ps::<1>(sx.0),
                    _mm256_extractf128_ps::<1>(sy.0),
                    _mm256_extractf128_ps::<1>(sz.0),
                ],
            );
            Self(_mm256_set_m128(high, low))
        }
    }

    /// [`Plane::distance`] of four rays.
    #[inline(always)]
    fn four(plane: &Plane, [ox, oy, oz]: [__m128; 3], [sx, sy, per_depth]: [__m128; 3]) -> __m128 {
        // SAFETY: AVX2 is enabled, see the module.
        unsafe {
            let [x, y, z] = [
                _mm256_set1_pd(plane.normal[0]),
                _mm256_set1_pd(plane.normal[1]),
                _mm256_set1_pd(plane.normal[2]),
            ];
            let ax = _mm256_sub_pd(_mm256_set1_pd(plane.corner[0]), _mm256_cvtps_pd(ox));
            let ay = _mm256_sub_pd(_mm256_set1_pd(plane.corner[1]), _mm256_cvtps_pd(oy));
            let az = _mm256_sub_pd(_mm256_set1_pd(plane.corner[2]), _mm256_cvtps_pd(oz));
            let above = _mm256_add_pd(_mm256_mul_pd(x, ax), _mm256_mul_pd(y, ay));
            let above = _mm256_add_pd(above, _mm256_mul_pd(z, az));
            let below = _mm256_mul_pd(x, _mm256_cvtps_pd(sx));
            let below = _mm256_add_pd(below, _mm256_mul_pd(y, _mm256_cvtps_pd(sy)));
            let depth = _mm256_div_pd(above, _mm256_add_pd(below, z));
            _mm256_cvtpd_ps(_mm256_mul_pd(depth, _mm256_cvtps_pd(per_depth)))
        }
    }
}

impl Rays for Avx512x16 {
    #[inline(always)]
    fn transposed(rays: &[Ray; 16]) -> [Self; 8] {
        let [a, b, c, d, e, f, g, h] = Avx2x16::transposed(rays);
        [
            Self::joined(a),
            Self::joined(b),
            Self::joined(c),
            Self::joined(d),
            Self::joined(e),
            Self::joined(f),
            Self::joined(g),
            Self::joined(h),
        ]
    }
    #[inline(always)]
    fn plane_distances(plane: &Plane, [ox, oy, oz]: [Self; 3], [sx, sy, sz]: [Self; 3]) -> Self {
        // SAFETY: AVX-512 is enabled, see the module.
        unsafe {
            let low = Self::eight(
                plane,
                [_mm512_castps512_ps256(ox.0), _mm512_castps512_ps256(oy.0), _mm512_castps512_ps256(oz.0)],
                [_mm512_castps512_ps256(sx.0), _mm512_castps512_ps256(sy.0), _mm512_castps512_ps256(sz.0)],
            );
            let high = Self::eight(
                plane,
                [
                    _mm512_extractf32x8_ps::<1>(ox.0),
                    _mm512_extractf32x8_ps::<1>(oy.0),
                    _mm512_extractf32x8_ps::<1>(oz.0),
                ],
                [
                    _mm512_extractf32x8_ps::<1>(sx.0),
                    _mm512_extractf32x8_ps::<1>(sy.0),
                    _mm512_extractf32x8_ps::<1>(sz.0),
                ],
            );
            Self(_mm512_insertf32x8::<1>(_mm512_castps256_ps512(low), high))
        }
    }
}

impl Avx512x16 {
    #[inline(always)]
    fn joined(halves: Avx2x16) -> Self {
        let (low, high) = (halves.0.0, halves.1.0);
        // SAFETY: AVX-512 is enabled, see the module.
        Self(unsafe { _mm512_insertf32x8::<1>(_mm512_castps256_ps512(low), high) })
    }

    /// [`Plane::distance`] of eight rays.
    #[inline(always)]
    fn eight(plane: &Plane, [ox, oy, oz]: [__m256; 3], [sx, sy, per_depth]: [__m256; 3]) -> __m256 {
        // SAFETY: AVX-512 is enabled, see the module.
        unsafe {
            let [x, y, z] = [
                _mm512_set1_pd(plane.normal[0]),
                _mm512_set1_pd(plane.normal[1]),
                _mm512_set1_pd(plane.normal[2]),
            ];
            let ax = _mm512_sub_pd(_mm512_set1_pd(plane.corner[0]), _mm512_cvtps_pd(ox));
            let ay = _mm512_sub_pd(_mm512_set1_pd(plane.corner[1]), _mm512_cvtps_pd(oy));
            let az = _mm512_sub_pd(_mm512_set1_pd(plane.corner[2]), _mm512_cvtps_pd(oz));
            let above = _mm512_add_pd(_mm512_mul_pd(x, ax), _mm512_mul_pd(y, ay));
            let above = _mm512_add_pd(above, _mm512_mul_pd(z, az));
            let below = _mm512_mul_pd(x, _mm512_cvtps_pd(sx));
            let below = _mm512_add_pd(below, _mm512_mul_pd(y, _mm512_cvtps_pd(sy)));
            let depth = _mm512_div_pd(above, _mm512_add_pd(below, z));
            _mm512_cvtpd_ps(_mm512_mul_pd(depth, _mm512_cvtps_pd(per_depth)))
        }
    }
}
